#include "cli/transfer_light.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

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

LightCoefficients readLight(const TransferLight& light, int order) {
    if (light.files.empty()) {
        LightCoefficients constant(static_cast<std::size_t>((order + 1) * (order + 1)), Rgb(0));
        constant[0] = Rgb(std::sqrt(4 * kPi));
        return constant;
    }
    std::vector<LightCoefficients> lights;
    for (const std::string& file : light.files) {
        SourceOptions options;
        options.threads = light.threads;
        const Environment environment = readEnvironment(file, options);
        const TexelReport& texels = environment.report.texels;
        if (texels.negative + texels.nonFinite > 0)
            tell(
                fmt::format("{}: {} of {} texels negative: set to 0; {} not finite: replaced by their neighbours' mean",
                            file, texels.negative, texels.texels, texels.nonFinite));
        lights.push_back(projectEnvironment(environment.map, order, light.threads).coefficients);
    }
    const std::vector<double> equal(lights.size(), 1.0 / static_cast<double>(lights.size()));
    return blendedLights(lights, light.weights.empty() ? equal : light.weights);
}

std::string plyName(const std::string& pattern, int frame) {
    const std::size_t begin = pattern.find('#');
    if (begin == std::string::npos) return (fs::path(pattern) / fmt::format("frame_{:04}.ply", frame)).string();
    const std::size_t end = std::min(pattern.find_first_not_of('#', begin), pattern.size());
    return pattern.substr(0, begin) + fmt::format("{:0{}}", frame, end - begin) + pattern.substr(end);
}

void requirePlyPlace(const std::string& pattern, int frame) {
    if (fs::path(pattern).parent_path().string().find('#') != std::string::npos ||
        plyName(pattern, 0).find('#') != std::string::npos)
        throw UsageError(
            fmt::format("--ply: expected a folder, or a file's name with one row of #, found '{}'", pattern));
    // A folder that isn't there is made beside a file that could be.
    const bool file = pattern.find('#') != std::string::npos || fs::is_directory(pattern);
    const std::string place = file ? plyName(pattern, frame) : fs::path(pattern / fs::path()).parent_path().string();
    requireWritable("", place, provisionalName(place), "");
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
