// nacre_view: scenes in a window. `nacre view` starts it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "core/error.hpp"
#include "demos/viewer/app.hpp"
#include "demos/viewer/transfer_app.hpp"
#include "transfer/transfer_file.hpp"

namespace {

/// "800x600"
void takeSize(const std::string& text, nacre::ViewerOptions& options) {
    int used = 0;
    const int found = std::sscanf(text.c_str(), "%dx%d%n", &options.width, &options.height, &used);
    if (found != 2 || used != static_cast<int>(text.size()) || options.width < 16 || options.height < 16 ||
        options.width > 8192 || options.height > 8192)
        throw CLI::ValidationError("--size", "expected WxH, 16 to 8192 pixels, found '" + text + "'");
}

std::string oneLine(std::string text) {
    for (char& c : text)
        if (c == '\n' || c == '\r') c = ' ';
    return text;
}

int run(int argc, char** argv) {
    nacre::ViewerOptions options;
    CLI::App cli(
        "Shows a scene, or a mesh, in a window: orbit, change materials and lights, compare with the reference.",
        "nacre view");
    cli.footer(
        "F1 in the window lists keys and mouse. Exit code: 0 closed, 1 no display, no OpenGL 3.3, or a scene that "
        "can't be read, 2 wrong usage.");
    std::string size;
    double white = 0, targetMs = 0;
    bool noPanel = false;
    cli.add_option("file", options.file,
                   "Scene (.json, .gltf, .glb), mesh (.obj, .ply, .off, ...), or what nacre transfer wrote")
        ->required();
    cli.add_option("--size", size, "Of the picture, beside the panel (default 800x600)")->type_name("WxH");
    cli.add_option("--samples", options.samples, "Samples a pixel (default 1)")->check(CLI::Range(1, 16));
    cli.add_option("--white", white, "Radiance shown as white (default: fitted to the first picture)")
        ->check(CLI::PositiveNumber);
    cli.add_flag("--transfer", options.liveTransfer,
                 "Self-shadows of a moving mesh (a file, or cloth, chess), computed for each frame shown");
    cli.add_option("--env", options.environments,
                   "Radiance maps that light a transfer file or --transfer (default: white); several blend")
        ->type_name("FILE")
        ->allow_extra_args(false);
    cli.add_option("--assets", options.assetFolders, "More folders whose baked assets are offered")->type_name("DIR");
    cli.add_option("--screenshots", options.screenshots, "Folder for screenshots (default: the current one)")
        ->type_name("DIR");
    cli.add_option("--reference-passes", options.referencePasses, "Samples a pixel of the reference (default 16)")
        ->check(CLI::Range(1, 65536));
    cli.add_option("--reference-scale", options.referenceScale,
                   "The reference has 1/N of the picture's edges (default 2)")
        ->check(CLI::Range(1, 16));
    cli.add_option("--target-ms", targetMs,
                   "Of a frame while the picture moves: quality gives way, and comes back at rest (default: none)")
        ->check(CLI::Range(0.1, 1e5) & CLI::Validator(
                                           [](const std::string& text) {
                                               const bool number = std::isfinite(std::strtod(text.c_str(), nullptr));
                                               return number ? std::string() : "expected a time, found " + text;
                                           },
                                           "FINITE"));
    cli.add_flag("--no-panel", noPanel, "Without the panel (Tab brings it)");
    cli.add_option("--benchmark", options.benchmark, "Draw N frames, print their times as JSON, and close")
        ->check(CLI::Range(1, 100000));
    cli.add_option("--lose-context", options.loseContextAfter, "After N frames, once: for tests")
        ->check(CLI::Range(1, 100000))
        ->group("");  // not in the help
    cli.add_flag("--trace", options.trace, "One JSON line on standard output for each frame shown");
    cli.parse(argc, argv);
    if (!size.empty()) takeSize(size, options);
    if (white > 0) options.white = white;
    options.target = targetMs * 1e-3;
    options.panel = !noPanel;
    const bool transfer = options.liveTransfer || nacre::isTransferFile(options.file);
    if (!transfer && !options.environments.empty())
        throw CLI::ValidationError(
            "--env", "expected a file that nacre transfer wrote, or --transfer, found " + options.file.string());
    if (options.liveTransfer && nacre::isTransferFile(options.file))
        throw CLI::ValidationError("--transfer", "expected a mesh, found the transfer file " + options.file.string());
    if (transfer) {
        nacre::runTransferViewer(options);
        return 0;
    }
    // One core stays with the window.
    const unsigned cores = std::thread::hardware_concurrency();
    nacre::runViewer(options, nacre::sceneTracer(cores > 1 ? cores - 1 : 1));
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const CLI::Success& help) {
        return CLI::App().exit(help);
    } catch (const CLI::ParseError& error) {
        std::fprintf(stderr, "nacre view: %s (see nacre view --help)\n", oneLine(error.what()).c_str());
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "nacre: %s\n", oneLine(error.what()).c_str());
        return 1;
    }
}
