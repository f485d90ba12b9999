// What a ray of a traced scene asks of a relief: the normal of its patches, and light between them.
#pragma once

#include "reference/scene_truths.hpp"
#include "reference/traced_samples.hpp"

namespace nacre {

/// Normal of the patch at a point [texels]; +z where there is none.
Vec3 patchNormal(const HeightMap& map, const Vec2& p);

/// Light of irradiance 1 on the plane that faces it, reflected 1 … bounces times before the point: mean over paths.
/// \param at  [texels] \param starts, random  of the paths' first directions, and of all others
Rgb bounced(const ReliefTruth& relief, const SceneRelief& options, const Vec2& at, const Vec3& normal,
            const Vec3& light, int paths, PixelSequence starts, PixelRandom random);

}  // namespace nacre
