#include "bump/bump_lookup.hpp"

#include "core/error.hpp"

namespace nacre {

namespace {

/// The two texels about coordinate c and the second one's share. The period's fraction in double, the rest as a
/// sampler.
struct Taps {
    int first = 0, second = 0;
    float share = 0;
};

Taps tapsOf(double c, int size, Wrap wrap) {
    const double period = wrap == Wrap::Mirror ? 2 : 1;
    const double inside = wrap == Wrap::Clamp ? clamp01(c) : c - period * std::floor(c / period);
    const float t = static_cast<float>(inside * size) - 0.5f;
    const float low = std::floor(t);
    const int i = static_cast<int>(low);
    return {wrapIndex(i, size, wrap), wrapIndex(i + 1, size, wrap), t - low};
}

int nearestIndex(double c, int size, Wrap wrap) {
    const double period = wrap == Wrap::Mirror ? 2 : 1;
    const double inside = wrap == Wrap::Clamp ? clamp01(c) : c - period * std::floor(c / period);
    return wrapIndex(std::min(static_cast<int>(inside * size), static_cast<int>(period) * size - 1), size, wrap);
}

/// d of the surface as the relief of the tile at (u, v) has it, and the other way. Twin: nacre_bump_mirror.
Vec3 turnedOver(const Vec3& d, double u, double v, Wrap wrap) {
    if (wrap != Wrap::Mirror) return d;
    const auto side = [](double c) { return std::floor(c) - 2 * std::floor(std::floor(c) / 2) == 0 ? 1.0 : -1.0; };
    return {d.x * side(u) + 0.0, d.y * side(v) + 0.0, d.z};  // no −0: straight up has azimuth 0, as in the shader
}

float horizonAt(const HorizonMap& map, double u, double v, Wrap wrap, double azimuth) {
    const int count = map.azimuths();
    const double turns = azimuth / (2 * kPi);
    const auto place = static_cast<float>((turns - std::floor(turns)) * count);
    const int k = static_cast<int>(place) % count;
    const float share = place - std::floor(place);
    const auto layer = [&](int i) { return sampleWrapped(map.elevation[static_cast<std::size_t>(i)], u, v, wrap)[0]; };
    const float first = layer(k);
    return first + share * (layer((k + 1) % count) - first);
}

}  // namespace

std::array<float, 4> sampleWrapped(const Image& image, double u, double v, Wrap wrap) {
    const Taps x = tapsOf(u, image.width(), wrap), y = tapsOf(v, image.height(), wrap);
    std::array<float, 4> out{};
    for (int c = 0; c < image.channels(); ++c) {
        const auto row = [&](int j) {
            const float a = image.at(x.first, j, c);
            return a + x.share * (image.at(x.second, j, c) - a);
        };
        const float top = row(y.first);
        out[static_cast<std::size_t>(c)] = top + y.share * (row(y.second) - top);
    }
    return out;
}

double litMargin(const BumpMaps& maps, double u, double v, const Vec3& towards) {
    require(maps.ellipses || maps.horizons, "litMargin: expected ellipses or horizons, found neither");
    const Vec3 light = turnedOver(towards, u, v, maps.wrap);
    if (light.z < 0) return -1;
    if (maps.ellipses) {
        const auto m = sampleWrapped(maps.ellipses->shape, u, v, maps.wrap);
        const auto o = sampleWrapped(maps.ellipses->offset, u, v, maps.wrap);
        return ellipseValue({m[0], m[1], m[2], o[0], o[1]}, light);
    }
    const double across = std::hypot(light.x, light.y);
    return std::atan2(light.z, across) - horizonAt(*maps.horizons, u, v, maps.wrap, std::atan2(light.y, light.x));
}

std::size_t nearestDirection(const ScatterMap& map, const Vec3& direction) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < map.directions.size(); ++k)
        if (glm::dot(direction, map.directions[k]) > glm::dot(direction, map.directions[best])) best = k;
    return best;
}

Seen seenFrom(const BumpMaps& maps, double u, double v, const Vec3& direction) {
    require(maps.scatter && maps.scatter->count() > 0, "seenFrom: expected a scatter map, found none");
    const ScatterMap& scatter = *maps.scatter;
    Seen out;
    out.direction = nearestDirection(scatter, turnedOver(direction, u, v, maps.wrap));
    const int x = nearestIndex(u, maps.width, maps.wrap), y = nearestIndex(v, maps.height, maps.wrap);
    const double distance = scatter.distance[out.direction].at(x, y, 0);
    out.hit = distance >= 0;
    if (out.hit) out.uv = seenPoint(x, y, scatter.directions[out.direction], distance) / Vec2(maps.width, maps.height);
    return out;
}

Vec3 normalAt(const BumpMaps& maps, double u, double v) {
    require(maps.normals.has_value(), "normalAt: expected normals, found none");
    const auto n = sampleWrapped(maps.normals->levels[0], u, v, maps.wrap);
    const Vec3 sum(n[0], n[1], n[2]);
    return glm::length(sum) > 0 ? turnedOver(glm::normalize(sum), u, v, maps.wrap) : Vec3(0, 0, 1);
}

}  // namespace nacre
