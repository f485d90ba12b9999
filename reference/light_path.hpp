// The way of a light to a surface past mirrors and panes, exactly: what specular_path.hpp is for the eye.
#pragma once

#include <functional>

#include "core/scene_description.hpp"
#include "reference/fermat_path.hpp"
#include "reference/scene_rays.hpp"

namespace nacre {

/// Light that arrives by one chain of faces.
struct LightArrival {
    Vec3 toLight;       ///< unit, from the surface to where it comes from
    Rgb irradiance{0};  ///< on a facing surface
};

/// Chains of at most `depth` faces. A face takes part when its node casts shadows and nothing scatters there
/// (scattered_light.hpp); what isn't blocked by a face isn't sent on by it. Directions and points of light are exact:
/// mirrored or, by Fermat's principle, refracted; flux is conserved, with Fresnel's shares, tints, filters, and fog,
/// the own light's share and textures' alpha taken off.
class LightPaths {
public:
    /// All outlive this. \param nodes  nodeTransforms' result
    LightPaths(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes, const SceneRays& rays, int depth);

    /// Calls `arrives` for each chain by which the light reaches the point. \param blocked  look for what is in between
    void follow(const Light& light, const Vec3& point, bool blocked,
                const std::function<void(const LightArrival&)>& arrives) const;

private:
    struct Face {
        Vec4 plane{0};  ///< to the front
        Mesh mesh;      ///< in the world
        SceneSpecular specular;
    };
    /// What a chain does at one of its faces.
    struct Bounce {
        std::size_t face = 0;
        bool refracts = false;
        double side = 1;  ///< 1: light comes from the front; −1
        double eta = 1;   ///< of the index beyond
    };
    /// Mirrors unfolded: the last face is where it is, those before are mirrored by the mirrors after them.
    struct Chain {
        std::vector<Bounce> bounces;
        std::vector<Vec4> planes;         ///< unfolded
        std::vector<glm::dmat4> toWorld;  ///< of each face's points, from unfolded
        glm::dmat4 lightToUnfolded{1};    ///< of the light itself
    };
    void extend(const Chain& chain, int left);
    void addPlane(Chain& chain) const;
    /// Whether the face has points on that side of another's plane.
    bool pointsOn(std::size_t face, std::size_t plane, double side) const;
    void followPoint(const Chain& chain, const Light& light, const Vec3& point, bool blocked,
                     const std::function<void(const LightArrival&)>& arrives) const;
    void followDirection(const Chain& chain, const Light& light, const Vec3& point, bool blocked,
                         const std::function<void(const LightArrival&)>& arrives) const;
    Rgb share(const Bounce& bounce, const Vec3& point, const Vec3& along) const;
    double clear(const Bounce& bounce, const Vec3& next) const;
    bool isBlocked(const std::vector<Vec3>& way) const;

    const SceneRays* rays_;
    std::vector<Face> faces_;
    std::vector<Chain> chains_;
};

}  // namespace nacre
