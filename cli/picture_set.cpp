#include "cli/picture_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cli/output_file.hpp"
#include "cli/picture_output.hpp"
#include "core/error.hpp"
#include "shading/image_output.hpp"

namespace nacre::cli {

void PictureSet::add(const Image& image, const std::string& output, double white) {
    const auto& data = image.data();
    const auto bad = std::find_if(data.begin(), data.end(), [](float v) { return !std::isfinite(v); });
    if (bad != data.end()) {
        const auto pixel = static_cast<int>((bad - data.begin()) / image.channels());
        throw Error(fmt::format("{}: expected finite radiance, found none at pixel ({}, {})", output,
                                pixel % image.width(), pixel / image.width()));
    }
    const std::filesystem::path beside = provisionalName(output);
    pictures_.push_back({output, std::make_unique<TemporaryFile>(beside)});
    if (pictureEnding(output) == ".exr")
        writeExr(image, beside);
    else
        writePng(image, beside, {white});
}

void PictureSet::finish() {
    for (const Picture& picture : pictures_) {
        std::error_code failure;
        std::filesystem::rename(provisionalName(picture.output), picture.output, failure);
        if (failure) throw Error(fmt::format("{}: can't write: {}", picture.output, failure.message()));
    }
    pictures_.clear();
}

}  // namespace nacre::cli
