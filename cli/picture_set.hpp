// Pictures that belong together: all appear, or none.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/image.hpp"
#include "core/temporary_files.hpp"

namespace nacre::cli {

/// Each is written beside its name; finish() renames all. What isn't finished goes.
class PictureSet {
public:
    /// \param output  ends in .exr or .png \param white  as writePicture. \throws nacre::Error
    void add(const Image& image, const std::string& output, double white);
    void finish();

private:
    struct Picture {
        std::string output;
        std::unique_ptr<TemporaryFile> file;
    };
    std::vector<Picture> pictures_;
};

}  // namespace nacre::cli
