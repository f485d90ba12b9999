// Adds the light of many virtual lights to a picture, all that fit into a program's uniforms at once.
#pragma once

#include "shading/hybrid/geometry_buffer.hpp"
#include "shading/hybrid/virtual_shadows.hpp"
#include "shading/render_target.hpp"

namespace nacre {

/// Adds to colour what each pixel of `geometry` reflects of the lights, and to alpha the luminance that points would
/// have more. albedo/π · Σ power/π · virtualLightGeometry a pixel. The target has the buffer's size; its depth isn't
/// used. Leaves depth test and write on, blending off. \param shadows  of these lights; null: nothing blocks, as in the
/// paper. O(pixels · lights)
void addVirtualLights(ProgramLoader& loader, const RenderTarget& target, const GeometryBuffer& geometry,
                      std::span<const VirtualPointLight> lights, const VirtualShadows* shadows,
                      NearLight near = NearLight::Rectangle);

}  // namespace nacre
