#include "cli/picture_set.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "cli/output_file.hpp"
#include "cli/picture_output.hpp"
#include "core/error.hpp"
#include "shading/image_output.hpp"

namespace nacre::cli {

void PictureSet::add(const Image& image, const std::string& output, double white) {
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
