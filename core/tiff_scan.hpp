// What has to be known of a TIFF file before OpenImageIO reads it, which fills what a cut file lacks with anything, and
// what it leaves out.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace nacre {

/// Looks at the first directory of a TIFF or BigTIFF file of either byte order: its strips or tiles must end within the
/// file. Other bytes pass: the reader of the picture refuses them.
/// \return GDAL's tag 42113 (GDAL_NODATA): the number of texels without data, for GeoTIFF elevation models
/// \throws nacre::Error when the file is cut, or that tag holds no number
std::optional<double> scanTiff(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace nacre
