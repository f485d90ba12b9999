#include "shadow_meshes.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include "core/scene_description.hpp"
#include "shading/primitives.hpp"

namespace nacre::test {

Mesh together(Mesh a, const Mesh& b) {
    const auto first = static_cast<unsigned>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    a.normals.insert(a.normals.end(), b.normals.begin(), b.normals.end());
    a.tangents.insert(a.tangents.end(), b.tangents.begin(), b.tangents.end());
    a.uvs.insert(a.uvs.end(), b.uvs.begin(), b.uvs.end());
    for (const glm::uvec3& t : b.triangles) a.triangles.push_back(t + first);
    return a;
}

Mesh fromCorners(const std::vector<Vec3>& corners) {
    Mesh out;
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        const Vec3 e = corners[i + 1] - corners[i], n = glm::cross(e, corners[i + 2] - corners[i]);
        for (std::size_t c = 0; c < 3; ++c) {
            out.positions.emplace_back(corners[i + c]);
            out.normals.emplace_back(glm::length(n) > 0 ? glm::normalize(n) : Vec3(0, 0, 1));
            out.tangents.emplace_back(glm::length(e) > 0 ? glm::normalize(e) : Vec3(1, 0, 0), 1);
            out.uvs.emplace_back(0);
        }
        const auto k = static_cast<unsigned>(i);
        out.triangles.emplace_back(k, k + 1, k + 2);
    }
    return out;
}

static void addSquare(std::vector<Vec3>& out, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    out.insert(out.end(), {a, b, c, a, c, d});
}

Mesh box(const Vec3& l, const Vec3& h) {
    std::vector<Vec3> c;
    addSquare(c, {l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z});
    addSquare(c, {h.x, l.y, l.z}, {l.x, l.y, l.z}, {l.x, h.y, l.z}, {h.x, h.y, l.z});
    addSquare(c, {h.x, l.y, h.z}, {h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z});
    addSquare(c, {l.x, l.y, l.z}, {l.x, l.y, h.z}, {l.x, h.y, h.z}, {l.x, h.y, l.z});
    addSquare(c, {l.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, l.z}, {l.x, h.y, l.z});
    addSquare(c, {l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z});
    return fromCorners(c);
}

Mesh insideOut(Mesh mesh) {
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
    for (glm::vec3& n : mesh.normals) n = -n;
    return mesh;
}

Mesh fan() {
    std::vector<Vec3> c;
    for (const double angle : {0.3, 2.2, 4.5}) {
        const Vec3 d(std::cos(angle), 0, std::sin(angle));
        addSquare(c, {0, -0.8, 0}, d + Vec3(0, -0.8, 0), d + Vec3(0, 0.8, 0), {0, 0.8, 0});
    }
    return fromCorners(c);
}

Mesh moebius() {
    std::vector<Vec3> c;
    constexpr int kSteps = 40;
    const auto at = [](int i, double side) {
        const double a = 2 * kPi * (i % kSteps) / kSteps, half = (i == kSteps ? -1 : 1) * side;
        const double r = 0.8 + half * 0.3 * std::cos(a / 2);
        return Vec3(r * std::cos(a), half * 0.3 * std::sin(a / 2), r * std::sin(a));
    };
    for (int i = 0; i < kSteps; ++i) addSquare(c, at(i, -1), at(i + 1, -1), at(i + 1, 1), at(i, 1));
    return fromCorners(c);
}

std::vector<NamedMesh> hardMeshes() {
    const Mesh ball = makeSphere(0.6f, 24, 12);
    const auto movedBall = [&](double x) { return transformed(ball, glm::translate(glm::dmat4(1), Vec3(x, 0, 0))); };
    const Mesh square = makeQuad(1.6f, 3);
    const Vec3 apex(0, 0.9, 0);
    std::vector<Vec3> broken{{-1, 0, -1}, {1, 0, -1}, {0, 0, 1}, {0, 0, 0},   {0, 0, 0}, {1, 1, 1},
                             {-1, 0, 0},  {0, 0, 0},  {1, 0, 0}, {-1, 0, -1}, {0, 0, 1}, apex};
    return {{"ball", ball, true},
            {"torus", makeTorus(0.8f, 0.3f, 24, 12), true},
            {"box", box(Vec3(-0.7), Vec3(0.7)), true},
            {"balls that cross", together(movedBall(-0.3), movedBall(0.3)), true},
            {"square", square},
            {"square and its back", together(square, insideOut(square))},
            {"disk", makeDisk(0.9f, 24, 2)},
            {"ball inside out", insideOut(ball)},
            {"ball in ball inside out", together(makeSphere(1.0f, 24, 12), insideOut(ball))},
            {"ball twice", together(ball, ball), true},
            {"fan of three", fan()},
            {"Moebius band", moebius()},
            {"degenerate triangles", fromCorners(broken)}};
}

}  // namespace nacre::test
