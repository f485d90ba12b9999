#include "demos/viewer/actions.hpp"

#include "demos/viewer/orbit.hpp"

namespace nacre {

/// Those that the chosen mesh can't have, as a relief without uv, are passed over.
static void nextMaterial(ViewerSession& session, const PanelState& state) {
    if (state.node < 0 || state.node >= static_cast<int>(session.scene().nodes.size())) return;
    const auto node = static_cast<std::size_t>(state.node);
    const auto count = static_cast<int>(session.scene().materials.size());
    const int now = session.scene().nodes[node].material;
    for (int k = 1; k < count; ++k)
        if (session.setNodeMaterial(node, (now + k) % count)) return;
}

void act(Action action, ViewerSession& session, Comparison& comparison, PanelState& state) {
    SceneSwitches& on = session.switches;
    const auto flip = [&](bool& value) {
        value = !value;
        session.touch();
    };
    const double duration = session.scene().duration;
    const auto step = [&](double share) {
        session.playing = false;
        session.seek(session.time + share * duration);
    };
    switch (action) {
        case Action::Help:
            state.help = !state.help;
            break;
        case Action::Panel:
            state.open = !state.open;
            break;
        case Action::Screenshot:
            state.wantsScreenshot = true;
            break;
        case Action::PlayPause:
            session.playing = duration > 0 && !session.playing;
            break;
        case Action::StepBack:
            step(-0.05);
            break;
        case Action::StepForward:
            step(0.05);
            break;
        case Action::ResetCamera:
            session.resetCamera();
            break;
        case Action::Darker:
            state.white *= std::exp2(1.0 / 3);
            break;
        case Action::Brighter:
            state.white /= std::exp2(1.0 / 3);
            break;
        case Action::AutoExposure:
            state.wantsAutoExposure = true;
            break;
        case Action::Reflectance:
            on.reflectance = static_cast<SceneReflectance>((static_cast<int>(on.reflectance) + 1) % 3);
            session.touch();
            break;
        case Action::Shadows:
            flip(on.shadows);
            break;
        case Action::Relief:
            flip(on.relief);
            break;
        case Action::Indirect:
            flip(on.indirect);
            break;
        case Action::Surrounding:
            flip(on.surrounding);
            break;
        case Action::Sky:
            flip(on.sky);
            break;
        case Action::View:
            comparison.shown = static_cast<Shown>((static_cast<int>(comparison.shown) + 1) % 3);
            break;
        case Action::NextLight:
            if (const auto count = static_cast<int>(session.scene().lights.size()); count > 0)
                state.light = (state.light + 1) % count;
            break;
        case Action::NextMaterial:
            nextMaterial(session, state);
            break;
        case Action::CopyCamera:
            state.wantsCopy = cameraText(session.camera);
            break;
        case Action::Reload:
            session.reload();
            break;
        case Action::Quit:
            if (state.help)
                state.help = false;
            else
                state.wantsQuit = true;
            break;
    }
}

}  // namespace nacre
