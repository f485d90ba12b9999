#include "shading/hybrid/reflected_power.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include "core/light_area.hpp"
#include "shading/hybrid/plane_factors.hpp"

namespace nacre {
namespace {

/// A picture plane before a light.
struct LightPlane {
    glm::dmat4 worldToClip;
    Mat3 frame{1};  ///< its x, y, and where it looks
    double halfWidth = 1;
};

Vec3 perpendicular(const Vec3& n) {
    return glm::normalize(glm::cross(std::abs(n.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0), n));
}

LightPlane planeAlong(const Light& light, const Vec3& axis, double halfWidth, const Bounds& scene) {
    const Vec3 x = perpendicular(axis), y = glm::cross(axis, x);
    const double size = glm::length(scene.high - scene.low), near = 1e-3 * size,
                 far = size + glm::length(light.position - 0.5 * (scene.low + scene.high));
    return {glm::frustum(-halfWidth * near, halfWidth * near, -halfWidth * near, halfWidth * near, near, far) *
                glm::lookAt(light.position, light.position + axis, y),
            Mat3(glm::cross(axis, y), y, axis), halfWidth};
}

std::vector<LightPlane> planesOf(const Light& light, const Bounds& scene) {
    static constexpr double kWidest = 1.0471975511965976;  // 60°: there a plane's corner pixels are 20 times too fine
    if (light.cone && light.cone->outer <= kWidest)
        return {planeAlong(light, light.cone->axis, std::tan(light.cone->outer), scene)};
    std::vector<LightPlane> out;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            Vec3 d(0);
            d[axis] = sign;
            out.push_back(planeAlong(light, d, 1, scene));
        }
    return out;
}

class SourcePower {
public:
    SourcePower(ProgramLoader& loader, const GpuElements& gpu, const SceneElements& elements, int size)
        : loader_(loader), gpu_(gpu), elements_(elements), buffer_(size) {}

    ElementPower of(const Light& light) {
        power_.assign(elements_.elements.size(), Rgb(0));
        light.directional ? addDirectional(light) : addPoint(light);
        return std::move(power_);
    }

private:
    void addPoint(const Light& light) {
        for (const LightPlane& plane : planesOf(light, elements_.bounds)) {
            if (factors_.empty() || plane.halfWidth != halfWidth_)
                factors_ = planeFactors(buffer_.size(), halfWidth_ = plane.halfWidth, PlaneSource::Uniform);
            const std::vector<std::uint32_t> items = buffer_.draw(loader_, gpu_, plane.worldToClip);
            for (std::size_t i = 0; i < items.size(); ++i) {
                if (items[i] == 0) continue;
                double share = factors_[i];
                if (light.cone) share *= coneShare(*light.cone, -directionOf(plane, i));
                give(items[i], light.color * share, light.position - elements_.elements[items[i] - 1].centre);
            }
        }
    }

    /// Of a pixel's middle.
    Vec3 directionOf(const LightPlane& plane, std::size_t pixel) const {
        const auto size = static_cast<std::size_t>(buffer_.size());
        const auto at = [&](std::size_t i) {
            return plane.halfWidth * (2 * (static_cast<double>(i) + 0.5) / static_cast<double>(size) - 1);
        };
        return glm::normalize(plane.frame * Vec3(at(pixel % size), at(pixel / size), 1));
    }

    void addDirectional(const Light& light) {
        const Vec3 middle = 0.5 * (elements_.bounds.low + elements_.bounds.high);
        const double radius = 0.5 * glm::length(elements_.bounds.high - elements_.bounds.low);
        const glm::dmat4 toClip =
            glm::ortho(-radius, radius, -radius, radius, 0.0, 4 * radius) *
            glm::lookAt(middle + 2 * radius * light.position, middle, perpendicular(light.position));
        const double area = sqr(2 * radius / buffer_.size());
        for (const std::uint32_t item : buffer_.draw(loader_, gpu_, toClip))
            if (item > 0) give(item, light.color * area, light.position);
    }

    void give(std::uint32_t item, const Rgb& arrives, const Vec3& toLight) {
        const SceneElement& element = elements_.elements[item - 1];
        if (glm::dot(element.normal, toLight) > 0) power_[item - 1] += arrives * element.albedo;
    }

    ProgramLoader& loader_;
    const GpuElements& gpu_;
    const SceneElements& elements_;
    ItemBuffer buffer_;
    std::vector<double> factors_;
    double halfWidth_ = 0;
    ElementPower power_;
};

}  // namespace

std::vector<ElementPower> powerOfSources(ProgramLoader& loader, const GpuElements& gpu, const SceneElements& elements,
                                         const SceneDescription& scene, const std::vector<glm::dmat4>& nodes,
                                         const ReflectedPowerOptions& options, const DrawShare& share) {
    std::vector<Light> sources;
    const std::vector<Light> lights = lightsInWorld(scene, nodes);
    const auto areas = areasInWorld(scene, nodes);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const std::vector<Light> points =
            areas[i] ? pointsOfArea(lights[i], *areas[i], options.lightPoints) : std::vector{lights[i]};
        sources.insert(sources.end(), points.begin(), points.end());
    }
    std::vector<ElementPower> out(sources.size());
    if (elements.elements.empty()) return out;
    SourcePower power(loader, gpu, elements, options.size);
    for (std::size_t i = 0; i < sources.size(); ++i)
        if (share.takes(i)) out[i] = power.of(sources[i]);
    return out;
}

ElementPower sumOfSources(std::span<const ElementPower> sources, std::size_t elements) {
    ElementPower out(elements, Rgb(0));
    for (const ElementPower& source : sources)
        for (std::size_t i = 0; i < source.size(); ++i) out[i] += source[i];
    return out;
}

ElementPower reflectedPower(ProgramLoader& loader, const GpuElements& gpu, const SceneElements& elements,
                            const SceneDescription& scene, const std::vector<glm::dmat4>& nodes,
                            const ReflectedPowerOptions& options) {
    return sumOfSources(powerOfSources(loader, gpu, elements, scene, nodes, options, {}), elements.elements.size());
}

}  // namespace nacre
