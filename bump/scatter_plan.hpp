// What light scattering over a relief needs before there is a light: normals, directions of each bounce, paths. The CPU
// (scattered_light.hpp) and the GPU (shading/gpu_relief_light.hpp) follow the same plan.
#pragma once

#include <array>
#include <cstdint>
#include <glm/packing.hpp>
#include <vector>

#include "bump/scatter_map.hpp"

namespace nacre {

/// The four patches that meet at a texel's centre have these slopes there: towards −x, +x, −y, +y; 0 beside a hole.
glm::vec4 ownSlopes(const HeightMap& map, int x, int y);

/// One period of the surface: the map, or of a mirrored one the four tiles that repeat, the map's own first. In the
/// others the relief is turned over and the light is not: so they have light of their own.
HeightMap reliefPeriod(const HeightMap& map);

/// The same surface with k × k texels for each one, in their edges. k odd: the old texels' centres stay some's.
/// \throws std::invalid_argument for a bad map, k even or below 1
HeightMap refinedRelief(const HeightMap& map, int k);

/// 1 where the light is seen from the texel's centre, 0 where the relief hides it, where it is below the plane, and of
/// holes; the texel's normal doesn't count. One channel.
/// \param light  unit, towards the light. \throws std::invalid_argument as rayDistances
Image litMask(const HeightMap& map, const Vec3& light, unsigned threads = 0);

/// Points of the relief that are seen from the texels about one normal each: drawn from all directions of the map that
/// hit, as Lambert's cosine weighs them. Light that comes = share · mean of the points' + Σ own[q] · that of patch q.
struct SeenPoints {
    int count = 0;                       ///< N of each texel
    std::vector<std::uint32_t> offsets;  ///< (x, y) [texels] from texel i's centre as halves: N from element N · i on
    std::vector<float> share;            ///< of the cosine that hits away from the own patches, for each texel
    std::vector<glm::vec4> own;  ///< of the cosine that own patches hide: towards −x −y, +x −y, −x +y, +x +y
    glm::vec2 offset(std::size_t i, int n) const {
        return glm::unpackHalf2x16(offsets[i * static_cast<std::size_t>(count) + static_cast<std::size_t>(n)]);
    }
};

struct ScatterPlan {
    Image normals;                      ///< RGB
    SeenPoints viewed;                  ///< about these normals: the bounce at the viewer's end
    std::array<SeenPoints, 4> patches;  ///< about the normals of the own patches, q as in `own`: all other bounces
};

struct ScatterPlanOptions {
    int bounces = 3;       ///< B ≥ 0
    int paths = 100;       ///< P ≥ 1
    Image normals = {};    ///< of the relief's size, unit; empty: those of surfaceSlopes
    unsigned threads = 0;  ///< same bits for any
};

/// Points for Lambert's paths that meet: P·B steps (lookups a texel). Errors of the bounce that is viewed are seen as
/// they are, of those before the mean of many: so each of these has few steps, 4 n with n points for each of the four
/// patches. \throws std::invalid_argument for a bad map, option, or a scatter map of another size
ScatterPlan planScatter(const HeightMap& map, const ScatterMap& scatter, const ScatterPlanOptions& options = {});

/// Unit normals of the patches of ownSlopes: towards −x −y, +x −y, −x +y, +x +y.
std::array<Vec3, 4> ownNormals(const glm::vec4& slopes);

/// Directions of paths that are alone: element p·depth + b is the index of path p's segment b, 0 being the one at the
/// viewer's end. Segment 0 goes through all directions evenly; the others by the additive recurrence R_{depth − 1}, so
/// that pairs and triples are spread. \throws std::invalid_argument for numbers below 1
std::vector<int> scatterPaths(int directions, int paths, int depth);

/// \throws std::invalid_argument unless the scatter map has directions, and distances of the relief's size
void validateScatterMap(const HeightMap& map, const ScatterMap& scatter);

/// w ⟨n, d⟩₊/π, Lambert's weight of a direction of the map.
double lambertWeight(const Vec3& normal, const Vec3& direction, double weight);

}  // namespace nacre
