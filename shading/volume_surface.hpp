// The surface value = iso of a volume, placed in the world: what volume_pass.hpp draws and shadow_map.hpp casts.
#pragma once

#include <vector>

#include "shading/gpu_volume.hpp"
#include "shading/program.hpp"

namespace nacre {

struct VolumeSurface {
    const GpuVolume* volume = nullptr;
    double iso = 0;         ///< the surface; greater values are inside
    glm::dmat4 toWorld{1};  ///< of the volume's own space (core/volume.hpp)
    VolumeMethod method = VolumeMethod::March;
    double step = 0.5;  ///< between slices or of the march [texels, along their shortest edge], > 0
};

/// \throws std::invalid_argument: no volume, an iso or step that isn't finite, step ≤ 0, more than 4096 steps across
///         the volume
void checkVolume(const VolumeSurface& surface);

glm::dmat4 volumeBox(const VolumeSurface& surface);  ///< texture coordinates [0, 1]³ to the world
double volumeStep(const VolumeSurface& surface);     ///< [world units]

/// Binds the volume to `unit` and sets the uniforms of bind/volume.glsl for positions that `toSpace`, a rigid motion,
/// brought from the world into the space that the shader works in. Leaves `program` in use.
void bindVolume(const Program& program, const VolumeSurface& surface, int unit,
                const glm::dmat4& toSpace = glm::dmat4(1));

/// The polygons of VolumeMethod::Slices as triangles [world]: planes `step` apart [world units] across the box of
/// texture coordinates [0, 1]³ under `toWorld`, perpendicular to `axis` (unit), the first half a step in; in the
/// axis's direction.
std::vector<glm::vec3> volumeSlices(const glm::dmat4& toWorld, const Vec3& axis, double step);

/// Draws them with their positions as attribute 0. Leaves no vertex array bound.
void drawSlices(const std::vector<glm::vec3>& triangles);

}  // namespace nacre
