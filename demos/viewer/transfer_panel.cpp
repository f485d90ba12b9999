#include "demos/viewer/transfer_panel.hpp"

#include <imgui.h>

#include <cmath>

#include "demos/viewer/panel.hpp"

namespace nacre {
namespace {

void status(const TransferSession& session, const TransferPanelState& state) {
    const TransferPlayer& player = session.player();
    const TransferPlayer::Cost& cost = player.cost();
    ImGui::TextUnformatted(std::filesystem::path(session.options().file).filename().c_str());
    ImGui::Text("%zu vertices, %zu triangles, order %d", player.vertexCount(), player.triangles().size(),
                player.order());
    ImGui::Text("%d x %d  %.1f ms a frame, %.0f frames/s", session.width(), session.height(), 1e3 * state.frameSeconds,
                state.frameSeconds > 0 ? 1 / state.frameSeconds : 0.0);
    if (player.recording())
        ImGui::Text("transfer from the file, light in %.2f ms", 1e3 * cost.lightSeconds);
    else
        ImGui::Text("%.2f M vertices/s: %zu of them in %.2f ms", 1e-6 * session.verticesPerSecond(), cost.computed,
                    1e3 * cost.transferSeconds);
    if (!session.problem().empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1, 0.45f, 0.4f, 1));
        ImGui::TextWrapped("%s", session.problem().c_str());
        ImGui::PopStyleColor();
    }
    if (!state.note.empty()) ImGui::TextWrapped("%s", state.note.c_str());
}

void viewSection(TransferSession& session, TransferPanelState& state) {
    if (ImGui::Button("Screenshot (S)")) state.wantsScreenshot = true;
    ImGui::SameLine();
    if (ImGui::Button("Reset camera")) session.resetCamera();
    auto stops = static_cast<float>(-std::log2(state.white));
    ImGui::SetNextItemWidth(170);
    if (ImGui::SliderFloat("exposure", &stops, -10, 10, "%.2f stops")) state.white = std::exp2(-stops);
    ImGui::SameLine();
    if (ImGui::Button("Fit")) state.wantsAutoExposure = true;
}

void animationSection(TransferSession& session) {
    if (ImGui::Button(session.playing ? "Pause" : "Play")) session.playing = !session.playing;
    ImGui::SameLine();
    auto frame = static_cast<int>(session.frame());
    const auto last = static_cast<int>(session.player().frameCount()) - 1;
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderInt("##frame", &frame, 0, last, "frame %d"))
        session.step(frame - static_cast<int>(session.frame()));
}

void lightSection(TransferSession& session) {
    constexpr auto kDegrees = static_cast<float>(180 / kPi);
    auto turn = static_cast<float>(session.light.turn) * kDegrees;
    if (ImGui::SliderFloat("turn", &turn, -180, 180, "%.0f degrees")) session.light.turn = turn / kDegrees;
    auto speed = static_cast<float>(session.turnSpeed) * kDegrees;
    if (ImGui::SliderFloat("a second", &speed, -180, 180, "%.0f degrees")) session.turnSpeed = speed / kDegrees;
    for (std::size_t i = 0; i < session.options().environments.size(); ++i) {
        auto weight = static_cast<float>(session.light.weights[i]);
        const std::string name = std::filesystem::path(session.options().environments[i]).filename().string();
        if (ImGui::SliderFloat(name.c_str(), &weight, 0, 1)) session.light.weights[i] = weight;
    }
}

}  // namespace

void drawTransferPanel(TransferSession& session, TransferPanelState& state, int height) {
    if (!state.open) return;
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(kPanelWidth, static_cast<float>(height)));
    if (ImGui::Begin("nacre", nullptr,
                     ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoBringToFrontOnFocus)) {
        ImGui::PushItemWidth(-110);
        status(session, state);
        viewSection(session, state);
        if (session.player().frameCount() > 1) animationSection(session);
        lightSection(session);
        ImGui::TextDisabled("drag: orbit   Ctrl + drag: turn the light\nShift + drag: pan   wheel: zoom");
        ImGui::TextDisabled("Space, Left, Right: frames   Home: camera\n-, =, 0: exposure   Tab: panel   Esc: close");
        ImGui::TextWrapped("%s", state.device.c_str());
        ImGui::PopItemWidth();
    }
    ImGui::End();
}

}  // namespace nacre
