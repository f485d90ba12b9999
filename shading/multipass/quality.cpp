#include "shading/multipass/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace nacre {
namespace {

struct Level {
    const char* name;
    int depth, lightDepth, shears, lightPoints;  ///< at most
    bool partial;
};
// Two surfaces along a path are a pane seen through; three a pane in a mirror.
constexpr Level kLevels[kQualityLevels] = {{"full", 1000, kMostLightBounces, 1 << 20, 63, true},
                                           {"high", 3, 2, 16, 8, true},
                                           {"medium", 3, 1, 8, 4, false},
                                           {"low", 2, 1, 8, 2, false},
                                           {"least", 2, 0, 2, 1, false}};

}  // namespace

const char* qualityName(int level) { return kLevels[level].name; }

int qualityFromString(const std::string& name) {
    for (int i = 0; i < kQualityLevels; ++i)
        if (name == kLevels[i].name) return i;
    throw std::invalid_argument(fmt::format("expected full, high, medium, low or least, found '{}'", name));
}

SceneSwitches atQuality(SceneSwitches best, int level) {
    const Level& l = kLevels[level];
    best.specular.depth = std::min(best.specular.depth, l.depth);
    best.specular.lightDepth = std::min(best.specular.lightDepth, l.lightDepth);
    best.specular.shears = std::min(best.specular.shears, l.shears);
    best.specular.partial = best.specular.partial && l.partial;
    best.lightPoints = std::min(best.lightPoints, l.lightPoints);
    return best;
}

QualityControl::QualityControl(double target) : target_(target) {
    require(std::isfinite(target) && target > 0, "quality: expected a frame time above 0");
}

int QualityControl::movingLevel() const {
    const std::optional<double>& now = seconds_[static_cast<std::size_t>(moving_)];
    if (now && *now > target_) return std::min(moving_ + 1, kQualityLevels - 1);
    if (moving_ == 0 || !now) return moving_;
    const std::optional<double>& better = seconds_[static_cast<std::size_t>(moving_ - 1)];
    return (better ? *better < 0.9 * target_ : *now < 0.5 * target_) ? moving_ - 1 : moving_;
}

int QualityControl::next(bool moves) {
    moves_ = moves;
    if (moves)
        level_ = moving_ = movingLevel();
    else
        level_ = std::max(level_ - 1, 0);
    return level_;
}

void QualityControl::took(double seconds) {
    std::optional<double>& known = seconds_[static_cast<std::size_t>(level_)];
    // What changed for one level changed for the others: another view, another scene.
    const double change = moves_ && known && *known > 0 ? seconds / *known : 1;
    for (std::optional<double>& other : seconds_)
        if (other) *other *= change;
    known = seconds;
}

}  // namespace nacre
