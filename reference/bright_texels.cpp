#include "reference/bright_texels.hpp"

#include <algorithm>

#include "core/error.hpp"

namespace nacre {

BrightTexels::BrightTexels(EnvMap map) : map_(std::move(map)) {
    require(map_.layout == EnvLayout::LatLong, "BrightTexels: expected a latitude-longitude map");
    const std::vector<double> solidAngles = envSolidAngles(map_.layout, map_.size(), 1);
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < solidAngles.size(); ++i) {
        const auto x = static_cast<int>(i) % map_.image.width(), y = static_cast<int>(i) / map_.image.width();
        sum += std::max(0.0, maxComponent(map_.image.rgb(x, y))) * solidAngles[i];
        all += solidAngles[i];
        upTo_.push_back(sum);
        density_.push_back(std::max(0.0, maxComponent(map_.image.rgb(x, y))));
    }
    for (double& d : density_) d = sum > 0 ? d / sum : 1 / all;
    for (std::size_t i = 0; sum == 0 && i < upTo_.size(); ++i) upTo_[i] = solidAngles[i] + (i > 0 ? upTo_[i - 1] : 0);
    for (double& u : upTo_) u /= upTo_.back() > 0 ? (sum > 0 ? sum : all) : 1;
}

Vec3 BrightTexels::draw(const Vec2& square) const {
    const auto at = std::upper_bound(upTo_.begin(), upTo_.end() - 1, square.x);
    const auto i = static_cast<std::size_t>(at - upTo_.begin());
    const double before = i > 0 ? upTo_[i - 1] : 0, along = (square.x - before) / std::max(1e-300, upTo_[i] - before);
    const int x = static_cast<int>(i) % map_.image.width(), y = static_cast<int>(i) / map_.image.width();
    // even in solid angle: the sine of latitude is linear
    const double top = std::sin(kPi * (0.5 - double(y) / map_.size()));
    const double bottom = std::sin(kPi * (0.5 - (y + 1.0) / map_.size()));
    const double row = map_.size() * (0.5 - std::asin(std::clamp(top + square.y * (bottom - top), -1.0, 1.0)) / kPi);
    return envDirection(map_.layout, map_.size(), x + std::clamp(along, 0.0, 1.0), row);
}

std::size_t BrightTexels::texelOf(const Vec3& direction) const {
    const glm::dvec2 p = envPosition(map_.layout, map_.size(), direction);
    const int x = std::clamp(static_cast<int>(p.x), 0, map_.image.width() - 1);
    const int y = std::clamp(static_cast<int>(p.y), 0, map_.image.height() - 1);
    return static_cast<std::size_t>(y) * map_.image.width() + x;
}

double BrightTexels::density(const Vec3& direction) const { return density_[texelOf(direction)]; }

Rgb BrightTexels::radiance(const Vec3& direction) const {
    const auto i = static_cast<int>(texelOf(direction));
    return map_.image.rgb(i % map_.image.width(), i / map_.image.width());
}

}  // namespace nacre
