// Inter-Quake models, version 2: a skinned mesh, its joints, and clips of poses frame by frame.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "shading/rig.hpp"

namespace nacre {

/// Whether the bytes begin as an IQM file does.
bool isIqm(std::span<const std::uint8_t> bytes);

/// All meshes as one part. The file's z is up and its triangles run clockwise: they are turned, so that y is up.
/// Positions and texture coordinates are float, bone numbers 8-bit, weights 8-bit or float; other vertex arrays are
/// left out, for nothing here needs them. A file of animation alone has no triangle.
/// \param name  for messages
/// \throws nacre::Error naming the file, expected and found: another version, parts beyond its end, parents after their
///         children, poses for other than the file's joints, more than 4 million poses
Rig parseIqm(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace nacre
