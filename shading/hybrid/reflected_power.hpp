// What each element reflects of the light that lamps bring (HYBRID section 3): item buffers from the lamps.
#pragma once

#include <span>

#include "core/draw_share.hpp"
#include "shading/hybrid/item_buffer.hpp"

namespace nacre {

struct ReflectedPowerOptions {
    int size = 256;       ///< pixels along an item buffer's edge
    int lightPoints = 4;  ///< of a light with an area, each with item buffers of its own
};

/// Reflected power [W] of each element: Σ over pixels that show it of intensity · solid angle, or irradiance · area for
/// directional lights, times the albedo. Elements that turn their back to a light reflect nothing. A spot narrower than
/// 60° about its axis is one plane, a point or wider spot six, as lights here shine alike in all directions of theirs;
/// what pixels can't resolve is lost or won as in any picture. Everything blocks light, be it marked as casting shadows
/// or not. O(lights · points · planes · (elements + size²))
using ElementPower = std::vector<Rgb>;
ElementPower reflectedPower(ProgramLoader& loader, const GpuElements& gpu, const SceneElements& elements,
                            const SceneDescription& scene, const std::vector<glm::dmat4>& nodes,
                            const ReflectedPowerOptions& options = {});

/// The same of each source: a light, or a point of one with an area. Empty for those that the share leaves.
std::vector<ElementPower> powerOfSources(ProgramLoader& loader, const GpuElements& gpu, const SceneElements& elements,
                                         const SceneDescription& scene, const std::vector<glm::dmat4>& nodes,
                                         const ReflectedPowerOptions& options, const DrawShare& share);

/// Of all sources, in order. \param elements  how many; sources that are empty give nothing
ElementPower sumOfSources(std::span<const ElementPower> sources, std::size_t elements);

}  // namespace nacre
