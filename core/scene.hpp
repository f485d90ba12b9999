// The few scene values that the rasteriser (shading/) and the ray tracer (reference/) must read in the same way.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "core/math.hpp"

namespace nacre {

/// Indexed triangles, counter-clockwise seen from outside. All attribute arrays have positions.size() elements.
struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;   ///< unit
    std::vector<glm::vec4> tangents;  ///< xyz unit, orthogonal to the normal; w = ±1: bitangent = w · cross(n, t)
    std::vector<glm::vec2> uvs;       ///< (0,0) where the mesh has none
    std::vector<glm::uvec3> triangles;
};

/// Right-handed, y up, looking along −z of its own frame. Image row 0 is the top.
struct Camera {
    glm::dvec3 eye{0, 0, 3}, target{0, 0, 0}, up{0, 1, 0};
    bool orthographic = false;
    double fovY = 0.6;  ///< full vertical angle [rad], perspective only
    double height = 2;  ///< full vertical extent [world units], orthographic only
    double near = 0.1, far = 100;

    glm::dmat4 view() const;
    /// OpenGL clip space, z in [-1, 1]. \param aspect  width / height
    glm::dmat4 projection(double aspect) const;
};

/// What a point light gives into directions at angle θ from its axis: saturate((cosθ − cos outer) / (cos inner −
/// cos outer))² of its intensity, as in glTF's KHR_lights_punctual.
struct SpotCone {
    glm::dvec3 axis{0, 0, -1};             ///< unit, where it shines
    double inner = 0, outer = 0.78539816;  ///< half angles [rad], 0 ≤ inner < outer ≤ π/2
};

/// Directional: `position` is the unit direction towards the light, radiance of a point = f · cosα · color.
/// Point: `position` in world units, irradiance color · cosα / distance².
struct Light {
    bool directional = true;
    glm::dvec3 position{0, 0, 1};
    Rgb color{1};                    ///< directional: irradiance on a facing surface [W/m²]; point: intensity [W/sr]
    std::optional<SpotCone> cone{};  ///< of a point light: a spot
};

/// \throws std::invalid_argument when a directional light has a cone, its axis isn't unit length or its angles aren't
///         as said
void checkCone(const Light& light);

/// Share of a spot's intensity, as SpotCone says. \param toLight  unit, from the lit point to the light
double coneShare(const SpotCone& cone, const glm::dvec3& toLight);

/// What `color` is multiplied by for the irradiance on a facing surface at `point`: 1, or the cone's share / distance².
double lightFalloff(const Light& light, const glm::dvec3& point);

}  // namespace nacre
