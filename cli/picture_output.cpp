#include "cli/picture_output.hpp"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>

#include "cli/verb.hpp"
#include "shading/image_output.hpp"

namespace nacre::cli {

namespace fs = std::filesystem;

std::vector<fs::path> filesOf(const SceneDescription& scene) {
    std::vector<fs::path> out{scene.file};
    for (const SceneAsset& asset : scene.assets) out.push_back(asset.file);
    for (const SceneMaterial& material : scene.materials)
        if (material.specular)
            out.insert(out.end(), material.specular->pictures.begin(), material.specular->pictures.end());
    return out;
}

std::string pictureEnding(const std::string& output) {
    std::string ending = fs::path(output).extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (ending != ".exr" && ending != ".png")
        throw UsageError(fmt::format("-o: expected a name that ends in .exr or .png, found '{}'", output));
    return ending;
}

std::string besideName(const std::string& output, const char* what, const std::string& ending) {
    const fs::path path(output);
    return (path.parent_path() / (path.stem().string() + "-" + what + ending)).string();
}

void writePicture(const Image& image, const std::string& output, double white) {
    if (pictureEnding(output) == ".exr")
        writeExr(image, output);
    else
        writePng(image, output, {white});
}

nlohmann::json differenceJson(const ImageDifference& d) {
    return {{"psnr", d.psnrSrgb},
            {"psnr_linear", d.psnrLinear},
            {"relative_rmse", d.relative},
            {"rms_over_mean", d.rmsOverMean},
            {"max_abs", d.maxAbs}};
}

}  // namespace nacre::cli
