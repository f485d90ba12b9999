#include "shading/multipass/pass_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace nacre {
namespace {

std::string rectText(const PixelRect& r) { return fmt::format("{},{} {}x{}", r.x, r.y, r.width, r.height); }

std::string nameOf(const PassSchedule& schedule, const std::vector<std::string>& names, int face) {
    const std::size_t node = schedule.faces[static_cast<std::size_t>(face)].node;
    return node < names.size() && !names[node].empty() ? names[node] : fmt::format("node {}", node);
}

/// Of a frosted or glossy face.
std::string sampleText(int shear) { return shear < 0 ? "" : fmt::format(", sample {}", shear + 1); }

const char* howText(Bounce how) { return how == Bounce::Reflected ? " reflects" : " refracts"; }

std::string addedText(const ScheduledLight& light) {
    if (!light.image) return "add where no shadow volume is";
    return fmt::format("add in {} light volume{}, not in shadows of {} parts of the path", light.image->bounces.size(),
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

bool addsLamps(const PassSchedule& schedule) {
    return std::any_of(schedule.lights.begin(), schedule.lights.end(),
                       [](const ScheduledLight& light) { return !light.image; });
}

std::string lightCountsText(const PassSchedule& schedule) {
    const auto lamps = std::count_if(schedule.lights.begin(), schedule.lights.end(),
                                     [](const ScheduledLight& light) { return !light.image; });
    const auto images = static_cast<std::ptrdiff_t>(schedule.lights.size()) - lamps;
    return fmt::format(
        "light passes in each view, at most: {} of lamps, each with all its points, {} of points' images "
        "in faces\n",
        lamps, images);
}

std::string meaningOf(PassKind kind, const PassSchedule& schedule) {
    switch (kind) {
        case PassKind::Surfaces:
            return std::string("what the view sees, times the tints and filters of its path's faces; ") +
                   (addsLamps(schedule) ? "the light of lamps with shadows comes after it"
                                        : "the lamps' own light is in it, shadows by maps");
        case PassKind::Light:
            return "a lamp, or its image in faces; its shadow and light volumes (MPR figure 5) are drawn and counted "
                   "within the row";
        case PassKind::Mask:
            return "the face, where it is seen: from here on the stencil says that the view behind it is seen there";
        case PassKind::Clear:
            return "the face again: depth starts anew behind it";
        case PassKind::Weight:
            return "the path's faces, into alpha: the product of Fresnel's shares, of what textures leave clear and of "
                   "what fog lets through";
        default:
            return "the face again: back to the view before it";
    }
}

std::string legend(const PassSchedule& schedule) {
    std::string out = "\n";
    for (const PassKind kind :
         {PassKind::Surfaces, PassKind::Light, PassKind::Mask, PassKind::Clear, PassKind::Weight, PassKind::Unmask})
        if (std::any_of(schedule.passes.begin(), schedule.passes.end(),
                        [&](const Pass& pass) { return pass.kind == kind; }))
            out += fmt::format("{:<9} {}\n", toString(kind), meaningOf(kind, schedule));
    return out +
           fmt::format("{:<9} a pass draws where the buffer has this value: so many faces have been passed\n",
                       "stencil") +
           fmt::format("{:<9} x,y width x height of the face's box, from the lower left, in samples, not pixels\n",
                       "scissor");
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
    if (l.points > 1)
        out += l.image ? fmt::format(", point {} of {}", l.image->point + 1, l.points)
                       : fmt::format(", {} points", l.points);
    if (!l.image) return out;
    for (const LightBounce& b : l.image->bounces) out += " > " + nameOf(schedule, names, b.face) + howText(b.how);
    return out + sampleText(l.image->shear);
}

std::string passListText(const PassSchedule& schedule, const std::vector<std::string>& names,
                         const std::vector<std::string>& lightNames) {
    std::string out = fmt::format("{} passes, {} views, {} levels; {} views left out, in which nothing is seen\n",
                                  schedule.passes.size(), schedule.views.size(), schedule.deepest, schedule.unseen);
    if (!schedule.lights.empty()) out += lightCountsText(schedule);
    std::vector<std::string> what;
    std::size_t width = 0;
    for (const Pass& pass : schedule.passes) {
        const std::string subject = pass.light >= 0 ? lightText(schedule, pass.light, names, lightNames) + ": "
                                    : pass.face < 0 ? ""
                                                    : nameOf(schedule, names, pass.face) + ": ";
        what.push_back(subject + drawnText(schedule, pass));
        width = std::max(width, what.back().size());
    }
    const auto row = [&](const auto& number, const char* kind, const std::string& stencil, const std::string& scissor,
                         const std::string& drawn, const std::string& view) {
        out +=
            fmt::format("{:>5}  {:<9} {:<8} {:<20} {:<{}}  {}\n", number, kind, stencil, scissor, drawn, width, view);
    };
    row("", "pass", "stencil", "scissor", "what", "view");
    for (std::size_t i = 0; i < schedule.passes.size(); ++i) {
        const Pass& pass = schedule.passes[i];
        row(i, toString(pass.kind), fmt::format("= {}", pass.stencil), rectText(pass.scissor), what[i],
            pathText(schedule, names, pathOf(schedule, pass.view)) +
                sampleText(schedule.views[static_cast<std::size_t>(pass.view)].shear));
    }
    return out + legend(schedule);
}

}  // namespace nacre
