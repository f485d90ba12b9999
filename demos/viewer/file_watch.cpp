#include "demos/viewer/file_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.hpp"
#include "shading/scene_manifest.hpp"

namespace nacre {

namespace fs = std::filesystem;

static std::string stampOf(const fs::path& file) {
    std::error_code failure;
    const auto time = fs::last_write_time(file, failure);
    if (failure) return {};
    const auto size = fs::is_regular_file(file, failure) ? fs::file_size(file, failure) : 0;
    return failure ? std::string() : fmt::format("{} {}", time.time_since_epoch().count(), size);
}

void FileWatch::watch(const std::vector<fs::path>& files) {
    std::map<fs::path, std::string> stamps;
    for (const fs::path& file : files) {
        const auto known = stamps_.find(file);
        stamps[file] = known != stamps_.end() ? known->second : stampOf(file);
    }
    stamps_ = std::move(stamps);
}

std::vector<fs::path> FileWatch::changed() {
    std::vector<fs::path> out;
    for (auto& [file, stamp] : stamps_) {
        std::string now = stampOf(file);
        if (now == stamp) continue;
        stamp = std::move(now);
        out.push_back(file);
    }
    return out;
}

std::vector<fs::path> filesUnder(const fs::path& folder) {
    std::vector<fs::path> out;
    std::error_code failure;
    for (fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, failure), end;
         !failure && at != end; at.increment(failure)) {
        std::error_code ignored;
        if (at->is_regular_file(ignored)) out.push_back(at->path());
    }
    std::sort(out.begin(), out.end());
    return out;
}

static void addNamed(const fs::path& file, std::set<fs::path>& out);

static void addTexts(const nlohmann::json& value, const fs::path& folder, std::set<fs::path>& out) {
    if (value.is_structured()) {
        for (const auto& inner : value) addTexts(inner, folder, out);
        return;
    }
    constexpr std::size_t kLongestName = 4096;  // a glTF may hold its data as text
    if (!value.is_string() || value.get_ref<const std::string&>().size() > kLongestName) return;
    std::error_code ignored;
    const fs::path named = scenePath(folder, value.get<std::string>());
    if (fs::is_regular_file(named, ignored)) addNamed(named, out);
}

static void addNamed(const fs::path& file, std::set<fs::path>& out) {
    if (!out.insert(file).second) return;
    if (file.extension() != ".json" && file.extension() != ".gltf") return;
    try {
        addTexts(readSceneJson(file), file.parent_path(), out);
    } catch (const Error&) {  // watched for the moment when it is right again
    }
}

std::vector<fs::path> filesNamedIn(const fs::path& file) {
    std::set<fs::path> out;
    addNamed(file, out);
    return {out.begin(), out.end()};
}

}  // namespace nacre
