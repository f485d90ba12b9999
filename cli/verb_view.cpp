// nacre view: starts nacre_view, the viewer. A program of its own, so that this one needs no window library.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include "cli/terminal.hpp"
#include "cli/verb.hpp"
#include "core/error.hpp"

namespace nacre::cli {
namespace {

namespace fs = std::filesystem;

/// Beside this program, installed; or where the build leaves it.
fs::path viewerProgram() {
    std::error_code ignored;
    const fs::path folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    std::string tried;
    for (const char* place : {"nacre_view", "../demos/viewer/nacre_view"}) {
        const fs::path candidate = (folder / place).lexically_normal();
        if (fs::is_regular_file(candidate, ignored)) return candidate;
        tried += (tried.empty() ? "" : ", ") + candidate.string();
    }
    throw Error(
        fmt::format("view: expected the viewer nacre_view, found none: ./dev view builds it; tried: {}", tried));
}

void runViewer(std::vector<std::string> words, const std::string& file) {
    words.emplace_back("--");  // whatever the name starts with
    words.push_back(file);
    const fs::path program = viewerProgram();
    std::vector<char*> argv = {const_cast<char*>(program.c_str())};
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    flushData();
    ::execv(program.c_str(), argv.data());
    throw Error(fmt::format("{}: {}", program.string(), std::strerror(errno)));
}

}  // namespace

Verb viewVerb(Context&) {
    const auto words = std::make_shared<std::vector<std::string>>();
    const auto file = std::make_shared<std::string>();
    const auto pass = [words](const char* flag) {
        return [words, flag](const std::string& text) {
            words->emplace_back(flag);
            words->push_back(text);
        };
    };
    const auto passFlag = [words](const char* flag) {
        return [words, flag](const std::string&) { words->emplace_back(flag); };
    };
    Verb verb{"view", "Show a scene, a mesh or a transfer file in a window", {}, {}, {}};
    verb.details =
        "Drag to orbit, wheel to zoom, F1 for all keys. The panel changes materials, lights and methods, and compares\n"
        "with the ray-traced reference. Scenes, shaders and baked assets are read again when their files change.\n"
        "A moving mesh with its light transfer plays: Ctrl + drag turns the light, the panel blends environments. "
        "With\n"
        "--transfer the vertices that face the viewer are computed for each frame, and nothing twice.";
    verb.options = {
        {"file", "FILE", "Scene (.json, .gltf, .glb), mesh (.obj, .ply, .off), or what nacre transfer wrote",
         into(*file), true},
        {"--size", "WxH", "Of the picture, beside the panel (default 800x600)", pass("--size")},
        {"--samples", "N", "Samples a pixel, 1 to 16 (default 1)", pass("--samples")},
        {"--white", "L", "Radiance shown as white (default: fitted to the first picture)", pass("--white")},
        {"--transfer", "", "Self-shadows of a moving mesh (a file, or cloth, chess), computed for each frame shown",
         passFlag("--transfer")},
        {"--env",
         "FILE",
         "Radiance map that lights a transfer file or --transfer (default: white); several blend",
         pass("--env"),
         false,
         {},
         true},
        {"--assets", "DIR", "Another folder whose baked assets are offered", pass("--assets")},
        {"--screenshots", "DIR", "Folder for screenshots (default: the current one)", pass("--screenshots")},
        {"--reference-passes", "N", "Samples a pixel of the reference (default 16)", pass("--reference-passes")},
        {"--reference-scale", "N", "The reference has 1/N of the picture's edges (default 2)",
         pass("--reference-scale")},
        {"--target-ms", "MS", "Of a frame while the picture moves: quality gives way, and comes back at rest",
         pass("--target-ms")},
        {"--no-panel", "", "Without the panel (Tab brings it)", passFlag("--no-panel")},
        {"--benchmark", "N", "Draw N frames, print their times as JSON, and close", pass("--benchmark")},
        {"--trace", "", "One JSON line on standard output for each frame shown", passFlag("--trace")}};
    verb.run = [words, file] { runViewer(*words, *file); };
    return verb;
}

}  // namespace nacre::cli
