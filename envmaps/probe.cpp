#include "envmaps/probe.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {

Vec3 probeDirection(ProbeKind kind, double u, double v) {
    const double r = std::min(1.0, std::hypot(u, v));
    if (r == 0) return {0, 0, 1};
    const double phi = kind == ProbeKind::Angular ? kPi * r : 2 * std::asin(r);
    return {std::sin(phi) * u / r, std::sin(phi) * v / r, std::cos(phi)};
}

glm::dvec2 probePoint(ProbeKind kind, const Vec3& direction) {
    const double across = std::hypot(direction.x, direction.y), phi = std::atan2(across, direction.z);
    const double r = kind == ProbeKind::Angular ? phi / kPi : std::sin(phi / 2);
    if (across == 0) return {direction.z < 0 ? 1 : 0, 0};
    return glm::dvec2(direction.x, direction.y) * (r / across);
}

std::vector<double> probeSolidAngles(ProbeKind kind, int size) {
    const double area = sqr(2.0 / size);
    std::vector<double> out(static_cast<std::size_t>(size) * size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double r = std::hypot((2 * x + 1.0) / size - 1, (2 * y + 1.0) / size - 1);
            double density = 4;  // MirrorBall: sinφ dφ = 4 r dr
            if (kind == ProbeKind::Angular) density = r > 0 ? kPi * std::sin(kPi * r) / r : kPi * kPi;
            out[static_cast<std::size_t>(y) * size + x] = r < 1 ? area * density : 0;
        }
    return out;
}

static Rgb meanOver(const Image& probe, ProbeKind kind, int size, int x, int y) {
    static constexpr int kPoints = 8;
    const int edge = probe.width();
    Rgb sum(0);
    for (int b = 0; b < kPoints; ++b)
        for (int a = 0; a < kPoints; ++a) {
            const Vec3 d = envDirection(EnvLayout::Cube, size, x + (a + 0.5) / kPoints, y + (b + 0.5) / kPoints);
            const glm::dvec2 p = probePoint(kind, d);
            const int i = std::clamp(static_cast<int>((p.x + 1) / 2 * edge), 0, edge - 1),
                      j = std::clamp(static_cast<int>((1 - p.y) / 2 * edge), 0, edge - 1);
            sum += probe.rgb(i, j);
        }
    return sum / static_cast<double>(kPoints * kPoints);
}

EnvMap cubeFromProbe(const Image& probe, ProbeKind kind, unsigned threads) {
    require(probe.channels() == 3 && probe.width() == probe.height(), "cubeFromProbe: expected a square RGB image");
    EnvMap out(EnvLayout::Cube, std::max(1, probe.width() / 2));
    parallelFor(out.image.height(), threads, [&](std::size_t y) {
        for (int x = 0; x < out.image.width(); ++x)
            out.image.setRgb(x, static_cast<int>(y), meanOver(probe, kind, out.size(), x, static_cast<int>(y)));
    });
    return out;
}

}  // namespace nacre
