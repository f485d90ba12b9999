// Pictures as `nacre render` writes them.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/image.hpp"
#include "core/scene_description.hpp"
#include "reference/image_compare.hpp"

namespace nacre::cli {

/// Of a scene that was read: what a picture might replace, itself, its assets and pictures on its faces.
std::vector<std::filesystem::path> filesOf(const SceneDescription& scene);

/// ".exr" or ".png", as `output` ends. \throws UsageError
std::string pictureEnding(const std::string& output);

/// NAME.exr -> NAME-reference.exr
std::string besideName(const std::string& output, const char* what, const std::string& ending);

/// Linear radiance as EXR, or sRGB of radiance over `white` as PNG, by the name's ending.
void writePicture(const Image& image, const std::string& output, double white);

/// psnr, psnr_linear, relative_rmse, max_abs
nlohmann::json differenceJson(const ImageDifference& d);

}  // namespace nacre::cli
