// Texture-based volume rendering (HSE figure 7; Westermann & Ertl 1998): the surface value = iso of a volume, lit by a
// BRDF at the normals of the field's gradient.
#pragma once

#include "shading/gpu_volume.hpp"
#include "shading/lit_pass.hpp"

namespace nacre {

/// Slices: polygons across the volume, facing the camera, nearest first; fragments outside the surface are discarded,
/// which is the paper's alpha test, and the depth test keeps the first. A surface point is up to half a step off along
/// the line of sight. March: one fragment a pixel follows its line of sight and finds the crossing within the step.
enum class VolumeMethod { Slices, March };

struct VolumeSurface {
    const GpuVolume* volume = nullptr;
    double iso = 0;         ///< in the file's units: where value ≥ iso is inside
    glm::dmat4 toWorld{1};  ///< of the volume's own space (core/volume.hpp)
    VolumeMethod method = VolumeMethod::March;
    double step = 0.5;  ///< between slices or of the march [texels, along their shortest edge], > 0
};

/// Draws into `target` as renderFactored does (lit_pass.hpp); anything else drawn there is hidden or hides as it
/// should. The BRDF's textures are bound from unit 0, the volume after them.
/// \throws std::invalid_argument: no volume, an iso or step that isn't finite, step ≤ 0, more than 4096 steps across
///         the volume; as renderFactored
void renderVolume(ProgramLoader& loader, const RenderTarget& target, const VolumeSurface& surface, const LitView& view,
                  const GpuFactoredBrdf& brdf);
void renderVolume(ProgramLoader& loader, const RenderTarget& target, const VolumeSurface& surface, const LitView& view,
                  const GpuDirectBrdf& brdf);

/// The polygons of VolumeMethod::Slices as triangles [world]: planes `step` apart [world units] across the box of
/// texture coordinates [0, 1]³ under `toWorld`, perpendicular to `axis` (unit), the first half a step in; in the
/// axis's direction.
std::vector<glm::vec3> volumeSlices(const glm::dmat4& toWorld, const Vec3& axis, double step);

}  // namespace nacre
