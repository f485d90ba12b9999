// The stages of a hybrid picture (HYBRID figure 10), each as rays see it: what shading/hybrid/ is compared with.
#pragma once

#include "reference/scene_trace.hpp"

namespace nacre {

/// direct + indirect + traced = blended, up to each one's own noise.
struct SceneComponents {
    Image direct;      ///< of surfaces that aren't specular: lamps with shadows, ambient light, surrounding, background
    Image unshadowed;  ///< the same without shadows
    Image indirect;    ///< what one other surface reflected of the lamps' light, on surfaces that aren't specular
    Image traced;      ///< rays whose first surface is specular: where they end, all of the above
    Image blended;
    Image tagged;  ///< one channel: share of a pixel's rays that meet a specular surface first
};

/// traceScene with one bounce between surfaces, or none: all of `indirect` is then black. \param options
/// interreflectionBounces doesn't matter
SceneComponents traceComponents(const SceneDescription& scene, const Camera& camera, const SceneTruths& truths,
                                const SceneTraceOptions& options = {}, bool bounce = true);

}  // namespace nacre
