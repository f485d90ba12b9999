#include "demos/relief.hpp"

#include <fmt/format.h>

#include "bump/read_height.hpp"
#include "core/parallel.hpp"

namespace nacre {

namespace fs = std::filesystem;

HeightMap cobbles(int size, double scale) {
    constexpr int kAcross = 6, kDown = 8;  // stones
    HeightMap map{Image(size, size, 1), Wrap::Repeat};
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double v = (y + 0.5) / size * kDown, row = std::floor(v);
            const double u = (x + 0.5) / size * kAcross + 0.5 * std::fmod(row, 2.0);
            const double a = 2 * (u - std::floor(u)) - 1, b = 2 * (v - row) - 1;
            const double r = std::sqrt(a * a * a * a + b * b * b * b);  // rounded squares
            const double stone = r < 0.9 ? std::sqrt(1 - sqr(r / 0.9)) : 0;
            const double tilt = 0.15 * std::sin(9 * row + 5 * std::fmod(std::floor(u), double(kAcross)));
            map.heights.at(x, y, 0) =
                static_cast<float>(scale * (0.85 * stone * (1 + tilt) + 0.02 * std::sin(40 * u + 31 * v)));
        }
    return map;
}

ReliefSource openRelief(const std::string& name, const fs::path& folder, double scale) {
    const fs::path file = folder / (name + ".bmp");
    ReliefSource out;
    if (!fs::is_regular_file(file)) {
        out.map = cobbles(256, scale);
        out.words = fmt::format("made-up cobbles, 256², rising by {:g} texels", scale);
        out.note = fmt::format("{} isn't there (demos/fetch.sh): made-up cobbles stand in", file.string());
        return out;
    }
    out.map = readHeight(file, {.scale = scale}).map;
    out.file = file.string();
    out.words = fmt::format("{}, {} × {} texels, rising by {:g}", name, out.map.width(), out.map.height(), scale);
    return out;
}

static Vec3 patchNormal(const HeightMap& map, const Vec2& p) {
    const Vec2 corner(std::floor(p.x - 0.5), std::floor(p.y - 0.5)), t = p - 0.5 - corner;
    const int i = static_cast<int>(corner.x), j = static_cast<int>(corner.y);
    const double h00 = map.at(i, j), h10 = map.at(i + 1, j), h01 = map.at(i, j + 1), h11 = map.at(i + 1, j + 1);
    const double dx = (1 - t.y) * (h10 - h00) + t.y * (h11 - h01), dy = (1 - t.x) * (h01 - h00) + t.x * (h11 - h10);
    return glm::normalize(Vec3(-dx, -dy, 1));
}

std::vector<Rgb> shadeRelief(const TracedSurface& traced, const HeightMap& map, const ReliefShading& shading) {
    const Relief relief(map);
    std::vector<Rgb> out(traced.points.size());
    parallelFor(out.size(), 0, [&](std::size_t k) {
        const SurfacePoint& s = traced.points[k];
        if (!TracedSurface::hit(s)) return;
        const auto local = [&](const Vec3& v) {
            return Vec3(glm::dot(v, s.tangent), glm::dot(v, s.bitangent), glm::dot(v, s.normal));
        };
        const Vec2 p = s.uv * shading.tiles * Vec2(map.width(), map.height());
        const Vec3 n = patchNormal(map, p), t = glm::normalize(Vec3(1, 0, 0) - n.x * n), b = glm::cross(n, t);
        const auto bumped = [&](const Vec3& v) { return Vec3(glm::dot(v, t), glm::dot(v, b), glm::dot(v, n)); };
        const Vec3 eye = local(s.toEye), wo = bumped(eye);
        if (shading.extra) out[k] += shading.extra(p);
        for (const Light& light : shading.lights) {
            const Vec3 l = local(light.position), wi = bumped(l);
            if (l.z <= 0 || wi.z <= 0 || wo.z <= 0 || (shading.shadows && !isLit(relief, p, l))) continue;
            out[k] += shading.brdf(wi, wo) * light.color * wi.z;
        }
    });
    return out;
}

}  // namespace nacre
