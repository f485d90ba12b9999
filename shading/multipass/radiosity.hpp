// Light that bounced between surfaces, without that which comes from lamps directly: a small progressive radiosity
// whose first bounce is dropped (MPR section 6, figure 14). Its values are vertex colours of the pass of ambient light.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/light_area.hpp"
#include "core/progress.hpp"

namespace nacre {

/// A mesh in the world, whose fronts reflect by Lambert. Its triangles are the patches: split what is large.
struct RadiositySurface {
    Mesh mesh;
    Rgb albedo{0};
};

/// Whether nothing is between two points. Called for points on surfaces, slightly above them.
using Visible = std::function<bool(const Vec3&, const Vec3&)>;

struct RadiosityOptions {
    double left = 0.01;  ///< share of the first bounce's power that may stay unshot
    int mostShots = 5000;
    Progress progress{};  ///< a shot each
};

struct IndirectLight {
    std::vector<std::vector<glm::vec3>> radiance;  ///< a surface, a vertex: leaving it, direct light not counted
    int shots = 0;
    double left = 0;  ///< share that stayed unshot
};

/// Progressive refinement (Cohen et al. 1988): the patch with the most unshot power gives it to all others and to the
/// vertices. What lamps bring is the first unshot power, and isn't counted itself. Form factors
/// are those of whole triangles at a point (Lambert), times the share of four points of the patch that are visible.
/// O(shots · 4 (triangles + vertices)) calls of `visible`.
/// \throws std::invalid_argument for an albedo outside [0, 1), a mesh without normals
IndirectLight indirectLight(std::span<const RadiositySurface> surfaces, std::span<const Light> lights,
                            const Visible& visible, const RadiosityOptions& options = {});

/// The same of a scene's meshes, as they stand at `time`: one list of radiance a node, empty for nodes without mesh.
/// Lights with an area count as 16 points. \param albedos  one a material
IndirectLight sceneIndirectLight(const SceneDescription& scene, double time, std::span<const Rgb> albedos,
                                 const Visible& visible, const RadiosityOptions& options = {});

}  // namespace nacre
