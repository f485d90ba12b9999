#include "shading/multipass/virtual_light.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "shading/multipass/rough_face.hpp"

namespace nacre {
namespace {

Vec4 homogeneousOf(const Light& light) { return {light.position, light.directional ? 0 : 1}; }

/// The light as an eye.
SpecularView viewFrom(const Vec4& source) {
    SpecularView out;
    out.eye = source;
    return out;
}

/// The faces' middles as the mean of a polygon's area.
Vec3 middleOf(const std::vector<Vec3>& p) {
    Vec3 sum(0);
    double weight = 0;
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
        const double area = glm::length(glm::cross(p[i] - p[0], p[i + 1] - p[0]));
        sum += area * (p[0] + p[i] + p[i + 1]) / 3.0;
        weight += area;
    }
    return weight > 0 ? sum / weight : p.front();
}

double areaOf(const std::vector<Vec3>& p) {
    Vec3 sum(0);
    for (std::size_t i = 1; i + 1 < p.size(); ++i) sum += glm::cross(p[i] - p[0], p[i + 1] - p[0]);
    return glm::length(sum);
}

/// A light on the way: what is left of its beam on the face that it left last.
struct Beam {
    VirtualLight light;
    std::vector<Vec3> outline;
    double side = 0;  ///< of that face's plane, where the light goes on
};

class Finder {
public:
    Finder(const std::vector<SpecularFace>& faces, const std::vector<bool>& sending, const SpecularOptions& options)
        : faces_(faces), sending_(sending), options_(options) {}

    void follow(const Beam& beam, int left) {
        if (left == 0) return;
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            if (!sending_[f] || (!beam.light.bounces.empty() && beam.light.bounces.back().face == int(f))) continue;
            const SceneSpecular& specular = faces_[f].specular;
            if (specular.scatters() && !beam.light.bounces.empty()) continue;
            const Vec4 source = beam.light.stages.back().source;
            const int side = sideOf(viewFrom(source), faces_[f].plane);
            if (side == 0) continue;
            const std::vector<Vec3> lit = litOf(beam, faces_[f]);
            if (lit.empty()) continue;
            for (const Bounce how : {Bounce::Reflected, Bounce::Refracted}) {
                for (int i = 0; i < (specular.scatters() ? options_.shears : 1); ++i) {
                    Beam next = beam;
                    next.outline = lit;
                    next.side = how == Bounce::Reflected ? side : -side;
                    if (specular.scatters()) next.light.shear = i;
                    if (!bounce(next.light, int(f), how, side, middleOf(lit))) continue;
                    if (found.size() == options_.most)
                        throw Error(fmt::format("light paths: expected at most {}, found more", options_.most));
                    found.push_back(next.light);
                    placeImages(found.back());
                    if (!specular.scatters()) follow(next, left - 1);
                }
            }
        }
    }

    std::vector<VirtualLight> found;

private:
    /// From what is lit back to the lamp: each face's point is the next one's, or what is lit, seen from the stage.
    void placeImages(VirtualLight& light) const {
        glm::dmat4 onto(1);
        bool any = false;
        for (std::size_t k = light.bounces.size(); k-- > 0;) {
            const SpecularFace& face = faces_[static_cast<std::size_t>(light.bounces[k].face)];
            const LightStage& after = light.stages[k + 1];
            const SceneSpecular& s = face.specular;
            const Vec4 height = s.fogDistance > 0 ? after.within.front() / s.fogDistance * onto : Vec4(0);
            onto = projectionFrom(after.source, face.plane) * onto;
            PlacedImage image = placedImage(face.image, onto);
            for (int c = 0; c < 4; ++c) image.place[c][3] = height[c];
            image.filters = s.filter && filtersLight(s, light.bounces[k].how);
            image.surface = s.texture ? s.surface : 0;
            any = any || image.filters || image.surface > 0 || s.fogDistance > 0;
            light.images.push_back(image);
        }
        if (!any) light.images.clear();
    }

    /// What the beam lights of a face: its outline, cut by the planes through the source and the beam's edges.
    static std::vector<Vec3> litOf(const Beam& beam, const SpecularFace& face) {
        std::vector<Vec3> lit = face.outline;
        if (beam.outline.empty()) return lit;
        const LightStage& stage = beam.light.stages.back();
        const double whole = areaOf(lit);
        lit = clipped(lit, [&](const Vec3& p) { return glm::dot(stage.within.front(), Vec4(p, 1)); });
        const Vec3 inside = middleOf(beam.outline);
        for (std::size_t i = 0; i < beam.outline.size() && !lit.empty(); ++i) {
            const Vec3 a = beam.outline[i], b = beam.outline[(i + 1) % beam.outline.size()];
            Vec3 n = glm::cross(b - a, Vec3(stage.source) - stage.source.w * a);
            if (glm::dot(n, inside - a) < 0) n = -n;
            lit = clipped(lit, [&](const Vec3& p) { return glm::dot(n, p - a); });
        }
        return lit.empty() || areaOf(lit) < 1e-9 * whole ? std::vector<Vec3>() : lit;
    }

    /// False where no light goes that way. side: of the face that the light comes from.
    bool bounce(VirtualLight& light, int face, Bounce how, int side, const Vec3& middle) const {
        const SpecularFace& f = faces_[static_cast<std::size_t>(face)];
        const SceneSpecular& s = f.specular;
        const bool reflects = how == Bounce::Reflected;
        const double rest = s.texture ? 1 : 1 - s.surface, eta = !s.ior ? 1 : side > 0 ? *s.ior : 1 / *s.ior;
        const Rgb factor = rest * (reflects ? s.reflection : s.transmission);
        if (factor == Rgb(0) || (!s.ior && !reflects)) return false;
        const Vec4 source = light.stages.back().source;
        const std::optional<Vec4> refractedSource =
            s.ior ? refractedEye(viewFrom(source), f.plane, middle, eta, RefractedEye::OnNormal) : std::nullopt;
        const bool weighed = s.ior && s.partial && eta != 1;
        if (s.ior && (reflects ? !weighed && refractedSource.has_value() : !refractedSource)) return false;

        FacetShear shear{{0, 0}, 1, Vec3(f.plane)};
        if (light.shear >= 0) {
            shear = shearOf(light, f, reflects ? std::nullopt : std::optional(eta), middle);
            light.seen.color *= shear.weight / options_.shears;
            if (shear.weight == 0) return false;
        }
        LightStage after;
        glm::dmat4 through(1);
        if (reflects && light.shear < 0) {
            through = mirrorOf(f.plane);
            after.source = through * source;
        } else {
            after.source = shearedEye(reflects ? mirrorOf(f.plane) * source : *refractedSource, f.plane, shear.slope);
            const Vec4 slope = (after.source - source) / glm::dot(f.plane, source);
            for (int c = 0; c < 4; ++c) through[c] += f.plane[c] * slope;
            light.seen.color *= std::abs(glm::dot(f.plane, source) / glm::dot(f.plane, after.source));
        }
        light.seen.color *= factor;
        LightStage& before = light.stages.back();
        before.within.push_back(double(side) * f.plane);
        before.planeFaces.push_back(face);
        for (LightStage& stage : light.stages) stage.toLast = through * stage.toLast;
        after.within = {double(reflects ? side : -side) * f.plane};
        after.planeFaces = {face};
        const Mat3 back = glm::inverse(Mat3(through));
        for (WeighedBounce& w : light.weighed) w.turn = w.turn * back;
        light.toLamp = light.toLamp * back;
        if (weighed) light.weighed.push_back({back, shear.facet, reflects ? -eta : eta});
        light.stages.push_back(after);
        light.bounces.push_back({face, how});
        light.seen.position = Vec3(after.source);
        return true;
    }

    /// As the light's ray to the middle of what it lights is turned, all of its rays are.
    FacetShear shearOf(const VirtualLight& light, const SpecularFace& face, const std::optional<double>& eta,
                       const Vec3& middle) const {
        const Vec2 sample = facetSample(light.shear, options_.sampling);
        const SceneSpecular& s = face.specular;
        if (s.roughness == 0) return {s.spread * sample, 1, Vec3(face.plane)};
        return facetShear(towardsEye(viewFrom(light.stages.back().source), middle), face.plane, eta, s.roughness,
                          sample);
    }

    static glm::dmat4 mirrorOf(const Plane& plane) {
        glm::dmat4 out(1);
        for (int c = 0; c < 4; ++c) out[c] -= 2 * plane[c] * Vec4(Vec3(plane), 0);
        return out;
    }

    const std::vector<SpecularFace>& faces_;
    const std::vector<bool>& sending_;
    const SpecularOptions& options_;
};

}  // namespace

bool isRefracted(const VirtualLight& light) {
    return std::any_of(light.bounces.begin(), light.bounces.end(),
                       [](const LightBounce& bounce) { return bounce.how == Bounce::Refracted; });
}

std::vector<bool> sendingFaces(const SceneDescription& scene, const std::vector<SpecularFace>& faces) {
    std::vector<bool> out;
    for (const SpecularFace& face : faces) out.push_back(scene.nodes[face.node].castsShadow);
    return out;
}

std::vector<VirtualLight> virtualLights(const std::vector<SpecularFace>& faces, const std::vector<bool>& sending,
                                        const Light& light, const SpecularOptions& options) {
    const int depth = options.lightDepth;
    require(depth >= 0 && depth <= kMostLightBounces && sending.size() == faces.size() && options.shears >= 1,
            fmt::format("light paths: expected a depth of 0 to {}", kMostLightBounces));
    Beam lamp;
    lamp.light.seen = light;
    lamp.light.stages.resize(1);
    lamp.light.stages[0].source = homogeneousOf(light);
    Finder finder(faces, sending, options);
    finder.follow(lamp, depth);
    return std::move(finder.found);
}

}  // namespace nacre
