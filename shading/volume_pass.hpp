// Texture-based volume rendering (HSE figure 7; Westermann & Ertl 1998): the surface value = iso of a volume, lit by a
// BRDF at the normals of the field's gradient.
#pragma once

#include "shading/lit_pass.hpp"
#include "shading/multipass/specular_view.hpp"
#include "shading/volume_surface.hpp"

namespace nacre {

/// Draws into `target` as renderFactored does (lit_pass.hpp); anything else drawn there is hidden or hides as it
/// should. The BRDF's textures are bound from unit 0, the volume after those of a surrounding. Shadow maps of
/// view.shadows are looked up with the field's normal; a slice's point, up to a step inside, is looked up half a step
/// further out. view.toWorld is not used. A volume has no tangents: those of an anisotropic BRDF are any.
/// \throws std::invalid_argument as checkVolume (volume_surface.hpp) and renderFactored
void renderVolume(ProgramLoader& loader, const RenderTarget& target, const VolumeSurface& surface, const LitView& view,
                  const GpuFactoredBrdf& brdf);
void renderVolume(ProgramLoader& loader, const RenderTarget& target, const VolumeSurface& surface, const LitView& view,
                  const GpuDirectBrdf& brdf);

/// The draw alone, by a program of volume.vert.glsl that holds everything else but the view: for scenes. The volume is
/// bound where a mesh's relief is else. State as above.
void drawVolume(const Program& program, const RenderTarget& target, const VolumeSurface& surface, const Camera& camera);
/// From a virtual viewpoint, in the state that is.
void drawVolume(const Program& program, const VolumeSurface& surface, const SpecularView& view,
                const ViewLight& light = {});

}  // namespace nacre
