#include "reference/light_path.hpp"

#include <limits>

#include "reference/specular_path.hpp"

namespace nacre {
namespace {

double height(const Vec4& plane, const Vec3& p) { return glm::dot(plane, Vec4(p, 1)); }

Vec3 moved(const glm::dmat4& m, const Vec3& p) { return Vec3(m * Vec4(p, 1)); }

glm::dmat4 mirrorOf(const Vec4& plane) {
    glm::dmat4 out(1);
    for (int c = 0; c < 4; ++c) out[c] -= 2 * plane[c] * Vec4(Vec3(plane), 0);
    return out;
}

/// Of the largest triangle; 0 where none has an area.
Vec4 planeOf(const Mesh& mesh) {
    Vec3 largest(0), corner(0);
    for (const glm::uvec3& t : mesh.triangles) {
        const Vec3 a(mesh.positions[t.x]);
        const Vec3 n = glm::cross(Vec3(mesh.positions[t.y]) - a, Vec3(mesh.positions[t.z]) - a);
        if (glm::dot(n, n) > glm::dot(largest, largest)) largest = n, corner = a;
    }
    if (!(glm::length(largest) > 0)) return Vec4(0);
    const Vec3 n = glm::normalize(largest);
    return {n, -glm::dot(n, corner)};
}

/// Of a point of the mesh's plane, where a triangle covers it.
std::optional<Vec2> uvAt(const Mesh& mesh, const Vec3& n, const Vec3& p) {
    for (const glm::uvec3& t : mesh.triangles) {
        const Vec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        const double all = glm::dot(n, glm::cross(b - a, c - a));
        if (all == 0) continue;
        const double u = glm::dot(n, glm::cross(p - a, c - a)) / all, v = glm::dot(n, glm::cross(b - a, p - a)) / all;
        if (u < 0 || v < 0 || u + v > 1) continue;
        return (1 - u - v) * Vec2(mesh.uvs[t.x]) + u * Vec2(mesh.uvs[t.y]) + v * Vec2(mesh.uvs[t.z]);
    }
    return {};
}

}  // namespace

LightPaths::LightPaths(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes, const SceneRays& rays,
                       int depth)
    : rays_(&rays) {
    if (depth == 0) return;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const SceneNode& node = scene.nodes[i];
        if (node.mesh < 0 || !node.castsShadow) continue;
        const auto& specular = scene.materials.at(static_cast<std::size_t>(node.material)).specular;
        if (!specular || specular->scatters()) continue;
        Mesh mesh = transformed(scene.meshes.at(static_cast<std::size_t>(node.mesh)).mesh, nodes[i]);
        const Vec4 plane = planeOf(mesh);
        if (plane != Vec4(0)) faces_.push_back({plane, std::move(mesh), *specular});
    }
    extend({}, depth);
}

bool LightPaths::pointsOn(std::size_t face, std::size_t plane, double side) const {
    for (const glm::vec3& p : faces_[face].mesh.positions)
        if (side * height(faces_[plane].plane, Vec3(p)) > 1e-7 * (1 + glm::length(Vec3(p)))) return true;
    return false;
}

void LightPaths::extend(const Chain& chain, int left) {
    if (!chain.bounces.empty()) chains_.push_back(chain);
    if (left == 0) return;
    for (std::size_t f = 0; f < faces_.size(); ++f)
        for (const double side : {1.0, -1.0}) {
            if (!chain.bounces.empty()) {
                const Bounce& last = chain.bounces.back();
                if (f == last.face || !pointsOn(f, last.face, last.refracts ? -last.side : last.side) ||
                    !pointsOn(last.face, f, side))
                    continue;
            }
            const SceneSpecular& s = faces_[f].specular;
            const double eta = !s.ior ? 1 : side > 0 ? *s.ior : 1 / *s.ior;
            for (const bool refracts : {false, true}) {
                if (refracts ? !s.ior || s.transmission == Rgb(0) : s.reflection == Rgb(0)) continue;
                if (!refracts && s.ior && eta == 1) continue;
                Chain next = chain;
                next.bounces.push_back({f, refracts, side, eta});
                addPlane(next);
                extend(next, left - 1);
            }
        }
}

void LightPaths::addPlane(Chain& chain) const {
    const Vec4& plane = faces_[chain.bounces.back().face].plane;
    if (!chain.bounces.back().refracts) {
        const glm::dmat4 mirror = mirrorOf(plane);
        for (Vec4& before : chain.planes) before = before * mirror;
        for (glm::dmat4& toWorld : chain.toWorld) toWorld = toWorld * mirror;
        chain.lightToUnfolded = mirror * chain.lightToUnfolded;
    }
    chain.planes.push_back(plane);
    chain.toWorld.emplace_back(1);
}

/// What of the light goes on, but for what the beam's width does. 0 beside the face. along: unit, of the light.
Rgb LightPaths::share(const Bounce& bounce, const Vec3& point, const Vec3& along) const {
    const Face& face = faces_[bounce.face];
    const SceneSpecular& s = face.specular;
    const std::optional<Vec2> uv = uvAt(face.mesh, Vec3(face.plane), point);
    if (!uv) return Rgb(0);
    const double alpha = s.texture ? sampleBilinear(*s.texture, float(uv->x), float(uv->y)).a : 1;
    Rgb factor = (1 - s.surface * alpha) * (bounce.refracts ? s.transmission : s.reflection);
    if (s.filter && (bounce.refracts || !s.ior)) factor *= Rgb(sampleBilinear(*s.filter, float(uv->x), float(uv->y)));
    if (!s.ior) return factor;
    const double cosine = std::abs(glm::dot(along, Vec3(face.plane)));
    const double cos2 = 1 - (1 - cosine * cosine) / sqr(bounce.eta);  // beyond
    double reflects = cos2 > 0 ? 0 : 1;
    if (cos2 > 0 && s.partial && bounce.eta != 1) reflects = fresnelReflectance(cosine, std::sqrt(cos2), bounce.eta);
    return (bounce.refracts ? 1 - reflects : reflects) * factor;
}

/// What fog behind the face leaves of light that goes on to a point: as the eye sees it, of the distance to the plane.
double LightPaths::clear(const Bounce& bounce, const Vec3& next) const {
    const Face& face = faces_[bounce.face];
    if (face.specular.fogDistance == 0) return 1;
    return 1 - std::min(1.0, std::abs(height(face.plane, next)) / face.specular.fogDistance);
}

/// \param way  the light, points of the faces, the point
bool LightPaths::isBlocked(const std::vector<Vec3>& way) const {
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
        const Vec3 back = way[i] - way[i + 1];
        const double length = glm::length(back);
        if (rays_->shadowed(way[i + 1], back / length, length)) return true;
    }
    return false;
}

void LightPaths::follow(const Light& light, const Vec3& point, bool blocked,
                        const std::function<void(const LightArrival&)>& arrives) const {
    for (const Chain& chain : chains_) {
        const Bounce &first = chain.bounces.front(), &last = chain.bounces.back();
        const double leaves = last.refracts ? -last.side : last.side;
        if (!(leaves * height(faces_[last.face].plane, point) > 0)) continue;
        const Vec4 source(light.position, light.directional ? 0 : 1);
        if (!(first.side * glm::dot(faces_[first.face].plane, source) > 0)) continue;
        (light.directional ? followDirection(chain, light, point, blocked, arrives)
                           : followPoint(chain, light, point, blocked, arrives));
    }
}

void LightPaths::followPoint(const Chain& chain, const Light& light, const Vec3& point, bool blocked,
                             const std::function<void(const LightArrival&)>& arrives) const {
    const std::size_t count = chain.bounces.size();
    std::vector<RefractingPlane> planes;
    for (std::size_t j = 0; j < count; ++j)
        if (chain.bounces[j].refracts) planes.push_back({chain.planes[j], chain.bounces[j].eta});
    const Vec3 from = moved(chain.lightToUnfolded, light.position);
    const std::optional<FermatPath> path = fermatPath(from, point, planes);
    if (!path) return;
    std::vector<Vec3> unfolded{from};
    std::size_t refracted = 0;
    for (std::size_t j = 0; j < count; ++j) {
        if (chain.bounces[j].refracts) {
            unfolded.push_back(path->points[refracted++]);
            continue;
        }
        const Vec3& next = refracted < path->points.size() ? path->points[refracted] : point;
        const double a = height(chain.planes[j], unfolded.back()), b = height(chain.planes[j], next);
        if (!(a * b < 0)) return;
        unfolded.push_back(glm::mix(unfolded.back(), next, a / (a - b)));
    }
    unfolded.push_back(point);
    std::vector<Vec3> way{light.position};
    Rgb all = light.color * path->spread;
    for (std::size_t j = 0; j < count; ++j) {
        const Bounce& bounce = chain.bounces[j];
        const double leaves = bounce.refracts ? -bounce.side : bounce.side;
        if (!(leaves * height(chain.planes[j], unfolded[j]) < 0) ||
            !(leaves * height(chain.planes[j], unfolded[j + 2]) > 0))
            return;
        way.push_back(moved(chain.toWorld[j], unfolded[j + 1]));
        all *= share(bounce, way.back(), glm::normalize(way[j + 1] - way[j]));
        if (all == Rgb(0)) return;
    }
    way.push_back(point);
    for (std::size_t j = 0; j < count; ++j) all *= clear(chain.bounces[j], way[j + 2]);
    if (light.cone) all *= coneShare(*light.cone, glm::normalize(light.position - way[1]));
    if (all == Rgb(0) || (blocked && isBlocked(way))) return;
    arrives({glm::normalize(way[count] - point), all});
}

void LightPaths::followDirection(const Chain& chain, const Light& light, const Vec3& point, bool blocked,
                                 const std::function<void(const LightArrival&)>& arrives) const {
    std::vector<Vec3> along{-light.position};
    double narrows = 1;  // a beam's width before over that beyond
    for (const Bounce& bounce : chain.bounces) {
        const Vec3 n = bounce.side * Vec3(faces_[bounce.face].plane), d = along.back();
        const double cosine = -glm::dot(n, d);
        if (!(cosine > 0)) return;
        if (!bounce.refracts) {
            along.push_back(d + 2 * cosine * n);
            continue;
        }
        const double cos2 = 1 - (1 - cosine * cosine) / sqr(bounce.eta);
        if (!(cos2 > 0)) return;
        along.push_back((d + cosine * n) / bounce.eta - std::sqrt(cos2) * n);
        narrows *= cosine / std::sqrt(cos2);
    }
    Rgb all = light.color * narrows;
    Vec3 at = point;
    for (std::size_t j = chain.bounces.size(); j-- > 0;) {
        const Vec4& plane = faces_[chain.bounces[j].face].plane;
        const double t = height(plane, at) / glm::dot(Vec3(plane), along[j + 1]);
        if (!(t > 0)) return;
        const Vec3 before = at - t * along[j + 1];
        all *= share(chain.bounces[j], before, along[j]) * clear(chain.bounces[j], at);
        if (all == Rgb(0) || (blocked && rays_->shadowed(at, -along[j + 1], t))) return;
        at = before;
    }
    if (blocked && rays_->shadowed(at, light.position, std::numeric_limits<double>::infinity())) return;
    arrives({-along.back(), all});
}

}  // namespace nacre
