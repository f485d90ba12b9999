// What light scattering over a relief needs before there is a light: normals, directions of each bounce, paths. The CPU
// (scattered_light.hpp) and the GPU (shading/gpu_relief_light.hpp) follow the same plan.
#pragma once

#include <vector>

#include "bump/scatter_map.hpp"

namespace nacre {

/// Unit normal of texel (x, y) by central differences; beside a hole one-sided, between two 0 (a hole's own: +z).
Vec3 reliefNormal(const HeightMap& map, int x, int y);

/// The four patches that meet at a texel's centre have these slopes there: towards −x, +x, −y, +y; 0 beside a hole.
glm::vec4 ownSlopes(const HeightMap& map, int x, int y);

/// The same surface with k × k texels for each one, in their edges. k odd: the old texels' centres stay some's.
/// \throws std::invalid_argument for a bad map, k even or below 1
HeightMap refinedRelief(const HeightMap& map, int k);

/// 1 where the light is seen from the texel's centre, 0 where the relief hides it, where it is below the plane, and of
/// holes; the texel's normal doesn't count. One channel.
/// \param light  unit, towards the light. \throws std::invalid_argument as rayDistances
Image litMask(const HeightMap& map, const Vec3& light, unsigned threads = 0);

struct ScatterBounce {
    std::vector<int> directions;  ///< of the scatter map
    std::vector<double> weights;  ///< [sr]: of all the map's directions that any texel hits, those nearest to each
};

struct ScatterPlan {
    Image normals;                       ///< RGB
    Image hits;                          ///< one channel: share of Lambert's cosine that hits, by all directions
    std::vector<ScatterBounce> bounces;  ///< the one at the viewer's end first
};

struct ScatterPlanOptions {
    int bounces = 3;       ///< B ≥ 0
    int paths = 100;       ///< P ≥ 1
    Image normals = {};    ///< of the relief's size, unit; empty: reliefNormal
    unsigned threads = 0;  ///< same bits for any
};

/// Directions for Lambert's paths that meet. P·B steps are shared by the bounces in halves, as each bounce is averaged
/// by those before: of 100 paths with 3 bounces, 171, 86 and 43. A bounce's directions are chosen among the map's
/// evenly in proportion to the light that they could bring (the cosine of all texels that hit something there), so that
/// none is spent on the sky; never more than all. \throws std::invalid_argument for a bad map, option, or a scatter map
/// of another size
ScatterPlan planScatter(const HeightMap& map, const ScatterMap& scatter, const ScatterPlanOptions& options = {});

/// Directions of paths that are alone: element p·depth + b is the index of path p's segment b, 0 being the one at the
/// viewer's end. Segment 0 goes through all directions evenly; the others by the additive recurrence R_{depth − 1}, so
/// that pairs and triples are spread. \throws std::invalid_argument for numbers below 1
std::vector<int> scatterPaths(int directions, int paths, int depth);

/// \throws std::invalid_argument unless the scatter map has directions, and distances of the relief's size
void validateScatterMap(const HeightMap& map, const ScatterMap& scatter);

/// w ⟨n, d⟩₊/π, Lambert's weight of a direction of the map.
double lambertWeight(const Vec3& normal, const Vec3& direction, double weight);

}  // namespace nacre
