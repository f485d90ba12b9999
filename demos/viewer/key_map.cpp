#include "demos/viewer/key_map.hpp"

namespace nacre {
namespace {

// GLFW's numbers (glfw3.h), so that this file needs no window library; the window asserts that they are.
constexpr int kEscape = 256, kTab = 258, kRight = 262, kLeft = 263, kHome = 268, kF1 = 290, kF5 = 294;

constexpr KeyBinding kKeys[] = {
    {kF1, "F1", Action::Help, "this help"},
    {kTab, "Tab", Action::Panel, "panel on and off"},
    {'S', "S", Action::Screenshot, "screenshot: PNG as shown, EXR in linear light"},
    {' ', "Space", Action::PlayPause, "animation: play, pause"},
    {kLeft, "Left", Action::StepBack, "animation: 1/20 back"},
    {kRight, "Right", Action::StepForward, "animation: 1/20 on"},
    {kHome, "Home", Action::ResetCamera, "the scene's own camera"},
    {'-', "-", Action::Darker, "exposure: 1/3 stop darker"},
    {'=', "=", Action::Brighter, "exposure: 1/3 stop brighter"},
    {'0', "0", Action::AutoExposure, "exposure: fitted to the picture"},
    {'M', "M", Action::Reflectance, "method: factored per pixel, fast Phong, direct"},
    {'H', "H", Action::Shadows, "shadows on and off"},
    {'B', "B", Action::Relief, "bump maps on and off"},
    {'I', "I", Action::Indirect, "indirect light in bump maps on and off"},
    {'E', "E", Action::Surrounding, "light of the surrounding on and off"},
    {'K', "K", Action::Sky, "background on and off"},
    {'D', "D", Action::View, "show: picture, reference, difference"},
    {'L', "L", Action::NextLight, "choose the next light"},
    {'N', "N", Action::NextMaterial, "the chosen mesh's next material"},
    {'C', "C", Action::CopyCamera, "copy the camera as JSON for a scene file"},
    {kF5, "F5", Action::Reload, "read everything again"},
    {kEscape, "Esc", Action::Quit, "close the help, or the viewer"},
};

constexpr MouseBinding kMouse[] = {
    {"left drag", "orbit"},
    {"middle drag, or Shift + left drag", "pan"},
    {"right drag on a mesh", "move it across the view"},
    {"wheel", "zoom"},
    {"click", "choose a mesh"},
    {"drag a light's mark, or Ctrl + drag", "move or turn the chosen light"},
    {"Ctrl + wheel", "the chosen light nearer or farther"},
    {"Ctrl + Shift + drag", "aim the chosen spot"},
};

}  // namespace

std::span<const KeyBinding> keyBindings() { return kKeys; }
std::span<const MouseBinding> mouseBindings() { return kMouse; }

std::optional<Action> actionOf(int key) {
    for (const KeyBinding& binding : kKeys)
        if (binding.key == key) return binding.action;
    return {};
}

}  // namespace nacre
