// Height fields in: which numbers of which picture are heights, in which unit.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "bump/height_map.hpp"
#include "core/image_file.hpp"

namespace nacre {

struct HeightOptions {
    /// Height = scale · value. Value: unsigned 8- and 16-bit codes count as code / largest code, 0 to 1; signed and
    /// 32-bit integers (elevation models) and floats as they are. Finite, not 0; negative turns the relief upside down.
    double scale = 1;
    double texelSize = 1;  ///< edge of a texel in the unit of the heights, > 0
    Wrap wrap = Wrap::Repeat;
    std::optional<double> nodata{};  ///< texels of this number, as the file holds it, are holes; NaN allowed
    std::string channel = "auto";    ///< r, g, b, a, y (luminance); auto: the only one, or R where R = G = B
};

/// What was found and what was done.
struct HeightReport {
    std::string path, hash, format, sampleType, channel;
    int width = 0, height = 0;
    double unit = 1;     ///< value = unit · the file's number: 1/255, 1/65535 or 1
    HeightRange file{};  ///< of the file's numbers, holes left out
    double scale = 1, texelSize = 1;
    std::size_t holes = 0;
    std::optional<double> nodata{};      ///< HeightOptions::nodata
    std::optional<double> fileNodata{};  ///< the GeoTIFF's own, which makes holes too
};
nlohmann::json toJson(const HeightReport& report);
/// How a file was read, from what toJson wrote of it. \throws nlohmann::json::exception when something is missing
HeightOptions heightOptionsFrom(const nlohmann::json& report, Wrap wrap);

struct HeightField {
    HeightMap map;  ///< heights over the texel size; row 0 is the file's first row
    HeightReport report;
};

/// Heights are no light: nothing is sRGB-decoded, 16 bits stay 16 bits.
/// \throws nacre::Error naming file, expected and found: unreadable, colours without a channel chosen, a channel that
/// isn't there, NaN that no nodata explains, infinity, holes only, heights that overflow;
///         std::invalid_argument for bad options
HeightField readHeight(const std::filesystem::path& path, const HeightOptions& options = {});

/// readHeight of a picture that is read already, with Samples::Codes.
HeightField heightFromImage(const ImageFile& file, const std::string& name, const HeightOptions& options = {});

}  // namespace nacre
