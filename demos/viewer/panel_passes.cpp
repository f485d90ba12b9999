#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstring>

#include "demos/viewer/panel_parts.hpp"
#include "shading/multipass/pass_text.hpp"

namespace nacre {

void passesSection(ViewerSession& session, PanelState& state) {
    const PassSchedule& schedule = session.renderer().schedule();
    std::vector<std::string> names;
    for (const SceneNode& node : session.scene().nodes) names.push_back(node.name);
    std::vector<std::vector<int>>& hidden = session.switches.specular.hidden;
    std::vector<std::vector<int>> paths = hidden;
    for (std::size_t v = 1; v < schedule.views.size(); ++v) paths.push_back(pathOf(schedule, static_cast<int>(v)));
    std::sort(paths.begin(), paths.end());
    paths.erase(std::unique(paths.begin(), paths.end()), paths.end());
    for (const std::vector<int>& path : paths) {
        const auto at = std::find(hidden.begin(), hidden.end(), path);
        bool drawn = at == hidden.end();
        const std::string name = pathText(schedule, names, path);
        ImGui::PushID(fmt::format("{}", fmt::join(path, " ")).c_str());
        if (ImGui::Checkbox(name.substr(std::strlen("camera > ")).c_str(), &drawn)) {
            if (drawn)
                hidden.erase(at);
            else
                hidden.push_back(path);
            session.touch();
        }
        ImGui::PopID();
        notePlace(state, name);
    }
    if (!ImGui::TreeNode("list", "%d passes", static_cast<int>(schedule.passes.size()))) return;
    for (std::size_t i = 0; i < schedule.passes.size(); ++i) {
        const Pass& pass = schedule.passes[i];
        ImGui::TextUnformatted(fmt::format("{:3} {:<8} = {:<3} {}", i, toString(pass.kind), pass.stencil,
                                           pathText(schedule, names, pathOf(schedule, pass.view)))
                                   .c_str());
    }
    ImGui::TreePop();
}

void qualitySection(ViewerSession& session) {
    bool keeps = session.quality.has_value();
    auto milliseconds = static_cast<float>(1e3 * (keeps ? session.quality->target() : 0.05));
    const bool switched = ImGui::Checkbox("keep frame time", &keeps);
    if (!keeps) {
        if (switched) session.quality.reset(), session.touch();
        return;
    }
    ImGui::SameLine(150);
    ImGui::SetNextItemWidth(100);
    const bool moved = ImGui::SliderFloat("##target", &milliseconds, 5, 1000, "%.0f ms", ImGuiSliderFlags_Logarithmic);
    if (switched || moved) session.quality.emplace(1e-3 * milliseconds), session.touch();
    ImGui::Text("quality: %s", qualityName(session.quality->level()));
}

}  // namespace nacre
