#include "shading/multipass/face_image.hpp"

#include <algorithm>

namespace nacre {

FaceImage faceImage(const std::vector<Vec3>& points, const Mesh& mesh) {
    Vec3 largest(0), a(0), e1(0), e2(0);
    Vec2 ua(0), u1(0), u2(0);
    for (const glm::uvec3& t : mesh.triangles) {
        const Vec3 n = glm::cross(points[t.y] - points[t.x], points[t.z] - points[t.x]);
        if (glm::dot(n, n) <= glm::dot(largest, largest)) continue;
        largest = n, a = points[t.x], e1 = points[t.y] - a, e2 = points[t.z] - a;
        ua = Vec2(mesh.uvs[t.x]), u1 = Vec2(mesh.uvs[t.y]) - ua, u2 = Vec2(mesh.uvs[t.z]) - ua;
    }
    // The gradients g with g·e1 = u1 and g·e2 = u2, by the dual basis of the triangle's edges.
    const double square = glm::dot(largest, largest);
    const Vec3 d1 = glm::cross(e2, largest) / square, d2 = glm::cross(largest, e1) / square;
    const Vec3 gu = u1.x * d1 + u2.x * d2, gv = u1.y * d1 + u2.y * d2;
    FaceImage out;
    out.u = Vec4(gu, ua.x - glm::dot(gu, a));
    out.v = Vec4(gv, ua.y - glm::dot(gv, a));
    for (const glm::uvec3& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const Vec4 p(points[t[k]], 1);
            const Vec2 uv = Vec2(mesh.uvs[t[k]]) - Vec2(glm::dot(out.u, p), glm::dot(out.v, p));
            out.off = std::max({out.off, std::abs(uv.x), std::abs(uv.y)});
        }
    return out;
}

std::vector<glm::vec4> faceImageRects(const SceneDescription& scene) {
    std::vector<glm::vec4> out;
    int row = 0;
    for (const SceneMaterial& m : scene.materials) {
        const Image* image = !m.specular          ? nullptr
                             : m.specular->filter ? m.specular->filter.get()
                                                  : m.specular->texture.get();
        out.push_back(image ? glm::vec4(0, row, image->width(), image->height()) : glm::vec4(0));
        if (image) row += image->height();
    }
    return out;
}

Image faceImages(const SceneDescription& scene) {
    const std::vector<glm::vec4> rects = faceImageRects(scene);
    int width = 0, height = 0;
    for (const glm::vec4& r : rects)
        width = std::max(width, static_cast<int>(r.z)), height = std::max(height, static_cast<int>(r.y + r.w));
    if (width == 0) return {};
    Image out(width, height, 4);
    for (std::size_t i = 0; i < rects.size(); ++i) {
        const auto y0 = static_cast<int>(rects[i].y);
        for (int y = 0; y < static_cast<int>(rects[i].w); ++y)
            for (int x = 0; x < static_cast<int>(rects[i].z); ++x) {
                const SceneSpecular& s = *scene.materials[i].specular;
                for (int c = 0; c < 3; ++c) out.at(x, y0 + y, c) = s.filter ? s.filter->at(x, y, c) : 1;
                out.at(x, y0 + y, 3) = s.texture ? s.texture->at(x, y, 3) : 0;
            }
    }
    return out;
}

glm::dmat4 projectionFrom(const Vec4& eye, const Plane& plane) {
    glm::dmat4 out(1);
    const double distance = glm::dot(plane, eye);
    for (int c = 0; c < 4; ++c) out[c] -= plane[c] / distance * eye;
    return out;
}

PlacedImage placedImage(const FaceImage& image, const glm::dmat4& onto) {
    PlacedImage out;
    const glm::dmat4 rows(image.u, image.v, Vec4(0, 0, 0, 1), Vec4(0));
    out.place = glm::transpose(rows) * onto;
    out.rect = image.rect;
    return out;
}

}  // namespace nacre
