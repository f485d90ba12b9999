// What keys do, and what F1 says of them: one table.
#pragma once

#include <optional>
#include <span>

namespace nacre {

enum class Action {
    Help,
    Panel,
    Screenshot,
    PlayPause,
    StepBack,
    StepForward,
    ResetCamera,
    Darker,
    Brighter,
    AutoExposure,
    Reflectance,
    Shadows,
    Relief,
    Indirect,
    Surrounding,
    Sky,
    View,
    NextLight,
    NextMaterial,
    CopyCamera,
    Reload,
    Quit
};

struct KeyBinding {
    int key;           ///< GLFW's number: capital letters are their ASCII codes
    const char* name;  ///< on the keyboard
    Action action;
    const char* help;  ///< one line
};

struct MouseBinding {
    const char *gesture, *help;
};

std::span<const KeyBinding> keyBindings();
std::span<const MouseBinding> mouseBindings();

std::optional<Action> actionOf(int key);

}  // namespace nacre
