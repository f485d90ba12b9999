#include "shading/multipass/pass_text.hpp"

#include <fmt/format.h>

namespace nacre {
namespace {

std::string rectText(const PixelRect& r) { return fmt::format("{},{} {}x{}", r.x, r.y, r.width, r.height); }

std::string nameOf(const PassSchedule& schedule, const std::vector<std::string>& names, int face) {
    const std::size_t node = schedule.faces[static_cast<std::size_t>(face)].node;
    return node < names.size() && !names[node].empty() ? names[node] : fmt::format("node {}", node);
}

const char* howText(Bounce how) { return how == Bounce::Reflected ? " reflects" : " refracts"; }

std::string addedText(const ScheduledLight& light) {
    if (!light.image) return "add where no shadow volume is";
    return fmt::format("add in {} light volume{}, not in shadows of {} stages", light.image->bounces.size(),
                       light.image->bounces.size() == 1 ? "" : "s", light.image->stages.size());
}

std::string drawnText(const PassSchedule& schedule, const Pass& pass) {
    const ScheduledView& v = schedule.views[static_cast<std::size_t>(pass.view)];
    if (pass.kind == PassKind::Surfaces)
        return fmt::format("{}{}{}", v.adds ? "add" : "replace", v.weighted ? ", times alpha" : "",
                           v.view.mirrored ? ", turned winding" : "");
    if (pass.kind == PassKind::Light) return addedText(schedule.lights[static_cast<std::size_t>(pass.light)]);
    if (pass.kind == PassKind::Mask) return "stencil + 1 where not hidden";
    if (pass.kind == PassKind::Clear) return "depth = far";
    if (pass.kind == PassKind::Weight) return "alpha = what the path keeps";
    return "stencil - 1, depth = the face's";
}

}  // namespace

const char* toString(PassKind kind) {
    static constexpr const char* kNames[] = {"surfaces", "light", "mask", "clear", "weight", "unmask"};
    return kNames[static_cast<int>(kind)];
}

std::string pathText(const PassSchedule& schedule, const std::vector<std::string>& names,
                     const std::vector<int>& path) {
    std::string out = "camera";
    for (const int step : path)
        out +=
            " > " + nameOf(schedule, names, step / 2) + howText(step % 2 == 0 ? Bounce::Reflected : Bounce::Refracted);
    return out;
}

std::string lightText(const PassSchedule& schedule, int light, const std::vector<std::string>& names,
                      const std::vector<std::string>& lightNames) {
    const ScheduledLight& l = schedule.lights[static_cast<std::size_t>(light)];
    const bool named = l.light < lightNames.size() && !lightNames[l.light].empty();
    std::string out = named ? lightNames[l.light] : fmt::format("light {}", l.light);
    if (!l.image) return out;
    for (const LightBounce& b : l.image->bounces) out += " > " + nameOf(schedule, names, b.face) + howText(b.how);
    if (l.image->shear >= 0) out += fmt::format(" {}", l.image->shear);
    return out;
}

std::string passListText(const PassSchedule& schedule, const std::vector<std::string>& names,
                         const std::vector<std::string>& lightNames) {
    std::string out = fmt::format("{} passes, {} views, {} levels; {} views left out, in which nothing is seen\n",
                                  schedule.passes.size(), schedule.views.size(), schedule.deepest, schedule.unseen);
    if (!schedule.lights.empty()) out += fmt::format("lights added in each view: {}\n", schedule.lights.size());
    out += fmt::format("{:>5}  {:<9} {:<12} {:<18} {:<34} {}\n", "", "pass", "stencil", "scissor", "what", "view");
    for (std::size_t i = 0; i < schedule.passes.size(); ++i) {
        const Pass& pass = schedule.passes[i];
        const std::string face = pass.light >= 0 ? lightText(schedule, pass.light, names, lightNames) + ": "
                                 : pass.face < 0 ? ""
                                                 : nameOf(schedule, names, pass.face) + ": ";
        out += fmt::format("{:>5}  {:<9} {:<12} {:<18} {:<34} {}\n", i, toString(pass.kind),
                           fmt::format("= {}", pass.stencil), rectText(pass.scissor), face + drawnText(schedule, pass),
                           pathText(schedule, names, pathOf(schedule, pass.view)));
    }
    return out;
}

}  // namespace nacre
