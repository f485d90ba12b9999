#include "reference/scattered_light.hpp"

#include <algorithm>
#include <limits>

#include "reference/specular_path.hpp"

namespace nacre {
namespace {

/// Smith's Λ of Beckmann's distribution.
double hidden(double cosine, double alpha) {
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    if (sine < 1e-9) return 0;
    const double a = std::abs(cosine) / (alpha * sine);
    return 0.5 * (std::erf(a) - 1) + std::exp(-a * a) / (2 * a * std::sqrt(kPi));
}

/// What goes from a ray along `along` into a solid angle about `out`, both unit; slopes against n off by a Gaussian.
Rgb spreadDensity(const SceneSpecular& s, const Vec3& along, const Vec3& n, const Vec3& out) {
    Rgb sum(0);
    const double ahead = glm::dot(out, n);
    for (const SpecularRay& ray : specularRays(s, along, n)) {
        const double towards = glm::dot(ray.direction, n);
        if (towards * ahead <= 0) continue;
        const Vec3 off = out / std::abs(ahead) - ray.direction / std::abs(towards);
        const double cosine = std::abs(ahead);
        sum += ray.share * std::exp(-glm::dot(off, off) / (2 * sqr(s.spread))) /
               (2 * kPi * sqr(s.spread) * cosine * cosine * cosine);
    }
    return sum;
}

/// The same by facets.
Rgb facetDensity(const SceneSpecular& s, const Vec3& along, const Vec3& front, const Vec3& out) {
    const Vec3 n = glm::dot(along, front) > 0 ? -front : front, in = -along;
    SceneSpecular flat = s;  // as the facet is: seen from its front
    if (flat.ior && n != front) flat.ior = 1 / *flat.ior;
    const bool reflects = glm::dot(out, n) > 0;
    if (!reflects && !flat.ior) return Rgb(0);
    const double eta = flat.ior.value_or(1);
    // Half vectors, and how much of their solid angle one of `out` is (Walter's equations 13, 14, 16 and 17).
    Vec3 m = reflects ? glm::normalize(in + out) : glm::normalize(in + eta * out);
    if (glm::dot(m, n) < 0) m = -m;
    const double inM = glm::dot(in, m), outM = glm::dot(out, m);
    if (inM <= 0 || (outM > 0) != reflects) return Rgb(0);
    const double jacobian = reflects ? 1 / (4 * outM) : sqr(eta) * -outM / sqr(inM + eta * outM);
    const double cosM = glm::dot(m, n), alpha = s.roughness;
    const double tan2 = 1 / (cosM * cosM) - 1, a2 = alpha * alpha;
    const double d = std::exp(-tan2 / a2) / (kPi * a2 * sqr(cosM * cosM));
    const double cosine = glm::dot(in, n), ahead = glm::dot(out, n);
    const double shadowing = 1 / ((1 + hidden(cosine, alpha)) * (1 + hidden(ahead, alpha)));
    Rgb share(0);
    for (const SpecularRay& ray : specularRays(flat, along, m))
        if ((glm::dot(ray.direction, m) > 0) == reflects) share += ray.share;
    return share * d * jacobian * inM * shadowing / cosine;
}

}  // namespace

ScatteredLight::ScatteredLight(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes,
                               const SceneRays& rays)
    : rays_(&rays) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const SceneNode& node = scene.nodes[i];
        if (node.mesh < 0 || !node.castsShadow) continue;
        const auto& specular = scene.materials.at(static_cast<std::size_t>(node.material)).specular;
        if (!specular || !specular->scatters()) continue;
        Face face;
        face.specular = *specular;
        face.mesh = transformed(scene.meshes.at(static_cast<std::size_t>(node.mesh)).mesh, nodes[i]);
        Vec3 largest(0);
        double sum = 0;
        for (const glm::uvec3& t : face.mesh.triangles) {
            const Vec3 a(face.mesh.positions[t.x]);
            const Vec3 n = glm::cross(Vec3(face.mesh.positions[t.y]) - a, Vec3(face.mesh.positions[t.z]) - a);
            if (glm::length(n) > glm::length(largest)) largest = n;
            face.areas.push_back(sum += 0.5 * glm::length(n));
        }
        if (sum == 0) continue;
        face.normal = glm::normalize(largest);
        faces_.push_back(std::move(face));
    }
}

/// Evenly over the face; the first number also chooses the triangle.
ScatteredLight::FacePoint ScatteredLight::pointOf(const Face& face, const Vec2& u) {
    const double at = u.x * face.areas.back();
    const std::size_t i = std::min<std::size_t>(
        static_cast<std::size_t>(std::upper_bound(face.areas.begin(), face.areas.end(), at) - face.areas.begin()),
        face.areas.size() - 1);
    const double before = i == 0 ? 0 : face.areas[i - 1], root = std::sqrt((at - before) / (face.areas[i] - before));
    const Vec3 weights(1 - root, root * (1 - u.y), root * u.y);
    const glm::uvec3& t = face.mesh.triangles[i];
    Vec2 uv(0);
    FacePoint out{Vec3(0), face.specular};
    for (int k = 0; k < 3; ++k) {
        out.position += weights[k] * Vec3(face.mesh.positions[t[k]]);
        uv += weights[k] * Vec2(face.mesh.uvs[t[k]]);
    }
    SceneSpecular& s = out.specular;
    if (s.texture) s.surface *= sampleBilinear(*s.texture, float(uv.x), float(uv.y)).a;
    if (s.filter) (s.ior ? s.transmission : s.reflection) *= Rgb(sampleBilinear(*s.filter, float(uv.x), float(uv.y)));
    return out;
}

void ScatteredLight::follow(const Light& light, const Vec3& point, bool blocked, int count,
                            const std::function<Vec2()>& next,
                            const std::function<void(const LightArrival&)>& arrives) const {
    for (const Face& face : faces_)
        for (int i = 0; i < count; ++i) {
            const FacePoint at = pointOf(face, next());
            const Vec3 offset = light.directional ? light.position : light.position - at.position;
            const double distance = glm::length(offset);
            const Vec3 in = offset / distance, way = point - at.position;
            const double length = glm::length(way), height = std::abs(glm::dot(way, face.normal));
            if (!(height > 1e-9)) continue;
            const Rgb flux = light.color * lightFalloff(light, at.position) * std::abs(glm::dot(in, face.normal));
            const SceneSpecular& s = at.specular;
            const Rgb density = s.roughness > 0 ? facetDensity(s, -in, face.normal, way / length)
                                                : spreadDensity(s, -in, face.normal, way / length);
            const double clear = s.fogDistance > 0 ? 1 - std::min(1.0, height / s.fogDistance) : 1;
            const Rgb all = flux * density * (clear * face.areas.back() / (count * length * length));
            if (all == Rgb(0)) continue;
            const double far = light.directional ? std::numeric_limits<double>::infinity() : distance;
            if (blocked && (rays_->shadowed(at.position, in, far) || rays_->shadowed(point, -way / length, length)))
                continue;
            arrives({-way / length, all});
        }
}

}  // namespace nacre
