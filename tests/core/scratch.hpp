// A folder that lives as long as a test, and the message of an expected exception.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

namespace nacre::tests {

class Scratch {
public:
    Scratch() {
        std::string pattern = (std::filesystem::temp_directory_path() / "nacre_test_XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
    }
    ~Scratch() {
        std::error_code ignored;
        std::filesystem::permissions(folder_, std::filesystem::perms::owner_all, ignored);
        std::filesystem::remove_all(folder_, ignored);
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    const std::filesystem::path& folder() const { return folder_; }
    std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
    std::size_t fileCount() const {
        std::size_t count = 0;
        for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_)) ++count;
        return count;
    }

private:
    std::filesystem::path folder_;
};

/// what() of the E that `call` throws; "nothing was thrown" when it returns. Other exceptions pass through.
template <typename E, typename F>
std::string messageOf(F&& call) {
    try {
        call();
    } catch (const E& error) {
        return error.what();
    }
    return "nothing was thrown";
}

}  // namespace nacre::tests
