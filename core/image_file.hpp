// Pictures of any kind into Image, in linear light: OpenEXR and Radiance by readers of our own that are bounded and
// fuzzed, everything else by OpenImageIO, which is loaded only when such a file comes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "core/image.hpp"

namespace nacre {

struct ImageFile {
    Image image;                        ///< linear, or codes; 1 = Y, 2 = Y and alpha, 3 = RGB, 4 = RGBA
    std::string format;                 ///< openexr, radiance, or OpenImageIO's name of it
    std::string sampleType;             ///< of the file: half, float, uint, rgbe, uint8, …
    std::string hash;                   ///< contentHash of the file
    bool srgbDecoded = false;           ///< the file held sRGB codes, or integers without a word on what they mean
    double exposure = 1;                ///< what Radiance's EXPOSURE lines say the values were multiplied by; undone
    std::optional<std::string> envmap;  ///< OpenEXR's attribute: latlong or cube
    std::optional<double> nodata{};     ///< TIFF's tag GDAL_NODATA: the code of texels without data
    std::optional<std::string> asset;   ///< the JSON of a nacre asset
};

/// What the numbers of a file are taken for.
enum class Samples {
    Light,  ///< linear light: integers are codes of it
    Codes  ///< no light but data, as heights are: the numbers that the file holds, integers 0…255, 0…65535 or signed as
           ///< they are, alpha not multiplied in; of OpenEXR also a part with one channel of any name
};

/// Reads by content, not by the name's ending. OpenEXR: all compressions, half, float and uint, scanlines and tiles,
/// the first part with R, G, B (A) or Y (A); its data window becomes the image. Radiance: RGBE, flat or run-length
/// coded; mantissas count as m · 2^(e − 136), as in OpenImageIO. Others: the first image, its first 4 channels;
/// integers are sRGB-decoded unless the file says linear or Samples::Codes is asked for. NaN and infinity are passed
/// on. \throws nacre::Error, one line with path, expected and found; also when edges or values exceed
/// core/asset_exr.hpp's
ImageFile readImageFile(const std::filesystem::path& path, Samples samples = Samples::Light);

/// The readers on bytes.
/// \param name  what messages call the file
ImageFile parseExrImage(std::span<const std::uint8_t> bytes, const std::string& name, Samples samples = Samples::Light);
ImageFile parseRadianceImage(std::span<const std::uint8_t> bytes, const std::string& name);

/// IEC 61966-2-1: code in [0, 1] to linear light; continued oddly below 0 and as it is above 1.
double srgbToLinear(double code);

}  // namespace nacre
