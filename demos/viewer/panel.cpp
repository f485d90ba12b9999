#include "demos/viewer/panel.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "demos/viewer/key_map.hpp"
#include "demos/viewer/light_drag.hpp"
#include "demos/viewer/orbit.hpp"
#include "demos/viewer/panel_parts.hpp"

namespace nacre {
namespace {

void status(const ViewerSession& session, const PanelState& state) {
    ImGui::TextUnformatted(session.scene().file.filename().c_str());
    const double frame = state.frameSeconds;
    ImGui::Text("%d x %d  %.1f ms a frame, %.0f frames/s", session.width(), session.height(), 1e3 * frame,
                frame > 0 ? 1 / frame : 0.0);
    for (const auto& [about, text] : session.problems()) {
        ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1, 0.45f, 0.4f, 1));
        ImGui::TextWrapped("%s: %s", about.c_str(), text.c_str());
        ImGui::PopStyleColor();
    }
    if (!state.note.empty()) ImGui::TextWrapped("%s", state.note.c_str());
}

void viewSection(ViewerSession& session, Comparison& comparison, PanelState& state) {
    if (ImGui::Button("Help (F1)")) state.help = !state.help;
    ImGui::SameLine();
    if (ImGui::Button("Screenshot (S)")) state.wantsScreenshot = true;
    if (ImGui::Button("Reset camera")) session.resetCamera();
    ImGui::SameLine();
    if (ImGui::Button("Copy camera")) state.wantsCopy = cameraText(session.camera);
    float stops = static_cast<float>(-std::log2(state.white));
    ImGui::SetNextItemWidth(170);
    if (ImGui::SliderFloat("exposure", &stops, -10, 10, "%.2f stops")) state.white = std::exp2(-stops);
    ImGui::SameLine();
    if (ImGui::Button("Fit")) state.wantsAutoExposure = true;
    int shown = static_cast<int>(comparison.shown);
    ImGui::RadioButton("picture", &shown, 0);
    ImGui::SameLine();
    ImGui::RadioButton("reference", &shown, 1);
    ImGui::SameLine();
    ImGui::RadioButton("difference", &shown, 2);
    comparison.shown = static_cast<Shown>(shown);
    if (shown != 0) comparisonStatus(comparison);
}

/// How shadows are found. Levels aren't in what mirrors show.
bool shadowChoice(SceneSwitches& on, bool mirrors) {
    int method = static_cast<int>(on.shadowMethod);
    bool changed = ImGui::Combo(
        "by", &method, mirrors ? "a map a light\0volumes\0" : "a map a light\0volumes\0a map a point, smoothed\0");
    on.shadowMethod = static_cast<ShadowMethod>(method);
    if (on.shadowMethod != ShadowMethod::Maps) changed |= ImGui::SliderInt("points of areas", &on.lightPoints, 1, 63);
    return changed;
}

void methodSection(ViewerSession& session) {
    SceneSwitches& on = session.switches;
    int method = static_cast<int>(on.reflectance);
    bool changed = ImGui::Combo("method", &method, "factored, per pixel\0direct evaluation\0fast Phong, per vertex\0");
    on.reflectance = static_cast<SceneReflectance>(method);
    const auto box = [&](const char* label, bool& value, bool sameLine) {
        if (sameLine) ImGui::SameLine(150);
        changed |= ImGui::Checkbox(label, &value);
    };
    box("lights", on.lamps, false);
    box("shadows", on.shadows, true);
    if (on.shadows) changed |= shadowChoice(on, hasSpecular(session.scene()));
    box("bump maps", on.relief, false);
    box("indirect in bumps", on.indirect, true);
    box("surrounding", on.surrounding, false);
    box("background", on.sky, true);
    box("ambient", on.ambient, false);
    if (changed) session.touch();
    if (hasSpecular(session.scene()) || on.shadowMethod == ShadowMethod::Volumes) qualitySection(session);
}

void animationSection(ViewerSession& session) {
    if (ImGui::Button(session.playing ? "Pause" : "Play")) session.playing = !session.playing;
    ImGui::SameLine();
    auto time = static_cast<float>(session.time);
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat("##time", &time, 0, static_cast<float>(session.scene().duration), "%.2f s")) {
        session.playing = false;
        session.seek(std::min<double>(time, session.scene().duration * 0.999999));
    }
}

void timesSection(ViewerSession& session, PanelState& state) {
    session.timing = true;
    for (const PassTime& pass : session.passes()) {
        const double now = std::isfinite(pass.gpuSeconds) ? pass.gpuSeconds : pass.wallSeconds;
        double& kept = state.passTimes.try_emplace(pass.name, now).first->second;
        kept += 0.1 * (now - kept);
        ImGui::Text("%-14s %7.2f ms", pass.name.c_str(), 1e3 * kept);
    }
    ImGui::TextDisabled("measured by waiting after each part");
    ImGui::TextWrapped("%s", state.device.c_str());
}

void helpWindow(PanelState& state, Vec2 origin, Vec2 window) {
    ImGui::SetNextWindowPos(ImVec2(static_cast<float>(0.5 * (origin.x + window.x)), static_cast<float>(0.5 * window.y)),
                            ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowBgAlpha(0.93f);
    if (ImGui::Begin("Keys and mouse", &state.help,
                     ImGuiWindowFlags_NoResize | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                         ImGuiWindowFlags_NoMove)) {
        if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
            const auto row = [](const char* first, const char* second) {
                ImGui::TableNextRow();
                ImGui::TableNextColumn();
                ImGui::TextColored(ImVec4(1, 0.85f, 0.5f, 1), "%s", first);
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(second);
            };
            for (const MouseBinding& binding : mouseBindings()) row(binding.gesture, binding.help);
            for (const KeyBinding& binding : keyBindings()) row(binding.name, binding.help);
            ImGui::EndTable();
        }
    }
    ImGui::End();
}

void drawMarks(const ViewerSession& session, const PanelState& state, Vec2 origin) {
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    for (const LightMark& mark : lightMarks(session)) {
        const ImVec2 at(static_cast<float>(origin.x + mark.at.x), static_cast<float>(origin.y + mark.at.y));
        const bool chosen = mark.light == state.light;
        list->AddCircleFilled(at, chosen ? 6.f : 4.f, IM_COL32(255, 220, 90, chosen ? 255 : 170));
        list->AddCircle(at, chosen ? 9.f : 6.f, IM_COL32(0, 0, 0, 200), 0, 1.5f);
    }
}

/// Passes are timed only while someone looks: it costs a wait after each.
void sections(ViewerSession& session, Comparison& comparison, PanelState& state) {
    status(session, state);
    viewSection(session, comparison, state);
    const auto open = [](const char* title) { return ImGui::CollapsingHeader(title, ImGuiTreeNodeFlags_DefaultOpen); };
    if (session.scene().duration > 0 && open("Animation")) animationSection(session);
    if (open("Material")) materialSection(session, state);
    if (!session.scene().lights.empty() && open("Light")) lightSection(session, state);
    if (open("Method")) methodSection(session);
    if (!session.scene().assets.empty()) {
        const bool assets = ImGui::CollapsingHeader("Baked assets");
        notePlace(state, "Baked assets");
        if (assets) assetSection(session, state);
    }
    if (hasSpecular(session.scene())) {
        const bool passes = ImGui::CollapsingHeader("Passes");
        notePlace(state, "Passes");
        if (passes) passesSection(session, state);
    }
    const bool times = ImGui::CollapsingHeader("Times of the passes");
    if (times && !session.timing) session.touch();
    session.timing = times;
    if (times) timesSection(session, state);
}

}  // namespace

void drawPanel(ViewerSession& session, Comparison& comparison, PanelState& state, Vec2 origin, Vec2 window) {
    state.places.clear();
    if (state.open) {
        drawMarks(session, state, origin);
        ImGui::SetNextWindowPos(ImVec2(0, 0));
        ImGui::SetNextWindowSize(ImVec2(kPanelWidth, static_cast<float>(window.y)));
        if (ImGui::Begin("nacre", nullptr,
                         ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                             ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoBringToFrontOnFocus)) {
            ImGui::PushItemWidth(-110);
            sections(session, comparison, state);
            ImGui::PopItemWidth();
        }
        ImGui::End();
    }
    if (state.help) helpWindow(state, origin, window);
}

}  // namespace nacre
