// Light of lamps that a frosted, glossy or rough face scatters on, by points of the face: what light_path.hpp is for
// clear ones. Nothing of shading/.
#pragma once

#include "reference/light_path.hpp"

namespace nacre {

/// Ways of one face alone, whose node casts shadows. Of each of `count` points of the face the lamp's flux there goes
/// on as specular_path.hpp's random rays do, by their density: slopes off by a Gaussian, or facets of Beckmann's
/// distribution with Smith's shadowing and Fresnel (Walter et al. 2007). Filters, textures, tints and fog as there.
class ScatteredLight {
public:
    /// All outlive this. \param nodes  nodeTransforms' result
    ScatteredLight(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes, const SceneRays& rays);

    bool empty() const { return faces_.empty(); }
    /// \param next  independent points of the unit square \param blocked  look for what is in between
    void follow(const Light& light, const Vec3& point, bool blocked, int count, const std::function<Vec2()>& next,
                const std::function<void(const LightArrival&)>& arrives) const;

private:
    struct Face {
        Vec3 normal{0};             ///< of the front
        Mesh mesh;                  ///< in the world
        std::vector<double> areas;  ///< of triangles, summed
        SceneSpecular specular;
    };
    struct FacePoint {
        Vec3 position{0};
        SceneSpecular specular;  ///< with its pictures' texels
    };
    static FacePoint pointOf(const Face& face, const Vec2& u);
    const SceneRays* rays_;
    std::vector<Face> faces_;
};

}  // namespace nacre
