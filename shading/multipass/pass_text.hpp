// A PassSchedule as text, for people who know the papers.
#pragma once

#include <string>
#include <vector>

#include "shading/multipass/pass_schedule.hpp"

namespace nacre {

/// A line a pass, and what the kinds of passes that occur do. \param names  of the scene's nodes, and of its lights
std::string passListText(const PassSchedule& schedule, const std::vector<std::string>& names,
                         const std::vector<std::string>& lightNames = {});

/// "lamp > mirror reflects", "lamp, 16 points", "lamp, point 3 of 16 > mirror reflects"; a frosted face's sample at the
/// end
std::string lightText(const PassSchedule& schedule, int light, const std::vector<std::string>& names,
                      const std::vector<std::string>& lightNames);

const char* toString(PassKind kind);

/// "camera > mirror reflects > pane refracts". \param names  of the scene's nodes
std::string pathText(const PassSchedule& schedule, const std::vector<std::string>& names, const std::vector<int>& path);

}  // namespace nacre
