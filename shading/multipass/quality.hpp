// Levels of quality for scenes with specular faces and soft shadows (MPR section 8), and what moves among them to keep
// a frame's time.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "shading/scene_programs.hpp"

namespace nacre {

/// From the best on: what is asked for; then in the order in which MPR's tables 2 and 3 give things up: depth of the
/// paths, weak reflections, samples.
inline constexpr int kQualityLevels = 5;
const char* qualityName(int level);  ///< full, high, medium, low, least
/// \throws std::invalid_argument that lists the names
int qualityFromString(const std::string& name);

/// Nothing gets better than it is in `best`; level 0 is that.
SceneSwitches atQuality(SceneSwitches best, int level);

/// While the picture moves, the best level whose frames take no longer than the target; when it rests, one level better
/// a frame until all is there. What a level takes is known from its last frame; a better one that has not been drawn
/// yet is tried where the time is below half the target.
class QualityControl {
public:
    /// \throws std::invalid_argument unless target > 0 [s]
    explicit QualityControl(double target);

    /// The level to draw next. \param moves  whether it shows something else than the last frame
    int next(bool moves);
    /// What that took [s].
    void took(double seconds);
    double target() const { return target_; }
    int level() const { return level_; }
    /// Whether a picture at rest has something to gain.
    bool refines() const { return level_ > 0; }

private:
    int movingLevel() const;

    double target_;
    int level_ = 0, moving_ = 0;  ///< drawn last; … while it moved
    bool moves_ = false;
    std::array<std::optional<double>, kQualityLevels> seconds_{};
};

}  // namespace nacre
