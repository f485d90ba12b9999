// Scene files for tests: a folder, and what reading a text in it says.
#pragma once

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/file.hpp"
#include "shading/scene_file.hpp"
#include "tests/core/scratch.hpp"

namespace nacre::tests {

class SceneFiles : public ::testing::Test {
protected:
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        writeFile(scratch_ / name, text);
        return scratch_ / name;
    }
    SceneDescription read(const std::string& text, const std::string& name = "scene.json") {
        notes_.clear();
        return readScene(write(name, text), {true, [this](const std::string& note) { notes_.push_back(note); }});
    }
    std::string errorOf(const std::string& text, const std::string& name = "scene.json") {
        return messageOf<Error>([&] { read(text, name); });
    }
    /// A scene file with these sections.
    static std::string sceneText(const std::string& sections) { return R"({"nacre_scene": 1, )" + sections + "}"; }

    Scratch scratch_;
    std::vector<std::string> notes_;
};

inline std::string fileText(const std::filesystem::path& path) {
    const std::vector<std::uint8_t> bytes = readFile(path, 1 << 20);
    return {bytes.begin(), bytes.end()};
}

inline constexpr const char* kTriangleObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

}  // namespace nacre::tests
