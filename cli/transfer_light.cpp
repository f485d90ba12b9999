#include "cli/transfer_light.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cli/frame_range.hpp"
#include "cli/numbers.hpp"
#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "cli/verb.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "envmaps/source.hpp"
#include "envmaps/spherical_harmonics.hpp"
#include "reference/image_compare.hpp"
#include "shading/image_output.hpp"
#include "transfer/colored_ply.hpp"

namespace nacre::cli {

namespace fs = std::filesystem;

void takeWeights(TransferLight& light, const std::string& text) {
    if (text.empty()) return;
    light.weights.resize(light.files.size());
    bool good = parseNumbers(text, light.weights) && !light.files.empty();
    for (const double w : light.weights) good = good && std::isfinite(w) && w >= 0;
    if (!good)
        throw UsageError(
            fmt::format("--weights: expected a number >= 0 for each of {} --env, separated by commas, found '{}'",
                        light.files.size(), text));
}

PlayedLight readLights(const TransferLight& light, int order) {
    if (light.files.empty()) return {{whiteLight(order)}, {1}};
    PlayedLight out;
    for (const std::string& file : light.files) {
        SourceOptions options;
        options.threads = light.threads;
        const Environment environment = readEnvironment(file, options);
        const TexelReport& texels = environment.report.texels;
        if (texels.negative + texels.nonFinite > 0)
            tell(
                fmt::format("{}: {} of {} texels negative: set to 0; {} not finite: replaced by their neighbours' mean",
                            file, texels.negative, texels.texels, texels.nonFinite));
        out.environments.push_back(projectEnvironment(environment.map, order, light.threads).coefficients);
    }
    out.weights = light.weights;
    if (out.weights.empty()) out.weights.assign(light.files.size(), 1.0 / static_cast<double>(light.files.size()));
    return out;
}

LightCoefficients readLight(const TransferLight& light, int order) {
    const PlayedLight read = readLights(light, order);
    return blendedLights(read.environments, read.weights);
}

std::string plyName(const std::string& pattern, int frame) {
    if (pattern.find('#') != std::string::npos) return numberedName(pattern, frame);
    return (fs::path(pattern) / fmt::format("frame_{:04}.ply", frame)).string();
}

void requirePlyPlace(const std::string& pattern, int frame) {
    if (fs::path(pattern).parent_path().string().find('#') != std::string::npos ||
        plyName(pattern, 0).find('#') != std::string::npos)
        throw UsageError(
            fmt::format("--ply: expected a folder, or a file's name with one row of #, found '{}'", pattern));
    // One file for all frames, or what is a file already.
    if (pattern.find('#') == std::string::npos && !fs::is_directory(pattern) &&
        (fs::exists(pattern) || pattern.ends_with(".ply")))
        throw UsageError(fmt::format(
            "--ply: expected a folder, or a file's name with one row of # for the frame, found '{}'", pattern));
    // A folder that isn't there is made beside a file that could be.
    const bool file = pattern.find('#') != std::string::npos || fs::is_directory(pattern);
    const std::string place = file ? plyName(pattern, frame) : fs::path(pattern / fs::path()).parent_path().string();
    requireWritable({}, place, provisionalName(place), "");
}

static Image asImage(const std::vector<glm::vec3>& colors) {
    Image image(static_cast<int>(colors.size()), 1, 3);
    for (std::size_t v = 0; v < colors.size(); ++v) image.setRgb(static_cast<int>(v), 0, Rgb(colors[v]));
    return image;
}

double writePlyFrames(const TransferRecording& recording, const LightCoefficients& coefficients,
                      const TransferLight& light, const std::string& pattern, const Progress& progress) {
    if (pattern.find('#') == std::string::npos) fs::create_directory(pattern);
    const HarmonicRotation rotation(recording.order);
    double white = light.white;
    for (const TransferRecording::Frame& frame : recording.frames) {
        report(progress, "colours",
               static_cast<double>(&frame - recording.frames.data()) / static_cast<double>(recording.frames.size()));
        const double turned = light.turnDeg * kPi / 180 * frame.number / recording.framesPerSecond;
        const TransferRecording::Block& block = recording.blocks[static_cast<std::size_t>(frame.block)];
        const Image picture = asImage(exitantRadiance(
            block.coefficients, turned == 0 ? coefficients : turnedLight(rotation, coefficients, {0, 1, 0}, turned),
            Rgb(1), light.threads));
        if (white == 0) white = pictureWhite(picture);
        writeFile(plyName(pattern, frame.number),
                  coloredPly(recording.triangles, block.positions, toneMap(picture, {white}),
                             fmt::format("sRGB of radiance / {:.9g}", white)));
    }
    return white;
}

}  // namespace nacre::cli
