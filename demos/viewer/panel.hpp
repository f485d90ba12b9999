// The panel beside the picture, the help over it, and the marks of lights in it: Dear ImGui alone, no OpenGL.
#pragma once

#include <string>
#include <vector>

#include "demos/viewer/comparison.hpp"
#include "demos/viewer/scene_edits.hpp"
#include "demos/viewer/session.hpp"

namespace nacre {

inline constexpr int kPanelWidth = 340;  ///< [pixels]

/// What the user has chosen, beyond the session.
struct PanelState {
    bool open = true, help = false;
    int node = -1, light = 0;
    double white = 1;
    std::string modelText, fileText;          ///< typed so far
    std::string note;                         ///< what was done last
    std::vector<FoundAsset> found;            ///< baked assets beside the scene
    double frameSeconds = 0;                  ///< smoothed, of whole frames
    std::map<std::string, double> passTimes;  ///< smoothed [s]
    bool wantsScreenshot = false, wantsAutoExposure = false, wantsFind = true;
    bool wantsQuit = false;
    std::map<std::string, Vec2> places;  ///< middles of what can be clicked to choose files [pixels of the window]
    std::string wantsCopy;               ///< text for the clipboard
    std::string device;                  ///< what draws
};

/// The picture's top left corner in the window.
inline Vec2 pictureOrigin(const PanelState& state) { return {state.open ? kPanelWidth : 0, 0}; }

/// A light's mark in the picture.
struct LightMark {
    int light = -1;
    Vec2 at{0};  ///< [pixels of the picture]
};

/// Marks of the lights that can be seen: point lights where they are, directional ones on a circle about the picture's
/// middle, towards where their light comes from.
std::vector<LightMark> lightMarks(const ViewerSession& session);

/// Between ImGui::NewFrame and Render. \param origin  the picture's top left corner in the window
void drawPanel(ViewerSession& session, Comparison& comparison, PanelState& state, Vec2 origin, Vec2 window);

}  // namespace nacre
