// What `nacre render` does when a scene is drawn in stages (shading/hybrid/).
#pragma once

#include <string>
#include <vector>

#include "cli/render_pipes.hpp"
#include "cli/scene_errors.hpp"
#include "cli/verb.hpp"
#include "shading/hybrid/hybrid_renderer.hpp"

namespace nacre::cli {

struct HybridPictures {
    std::string scene, output;
    SceneShot shot;
    double white = 0;  ///< 0: of the picture
    int rays = 4;
    SceneSwitches switches;
    bool reference = false, asJson = false;
    bool indirect = false;                       ///< by virtual lights
    bool traced = false;                         ///< specular pixels
    std::optional<SampledShadowMethod> shadows;  ///< as levels of each pixel; points: switches.lightPoints
    bool counted = false;                        ///< shadows by volumes, which pipes share
    bool stages = false;                         ///< each a picture beside the output
    VirtualLightOptions lights;
    std::string dependent;  ///< the first option given that needs --indirect
    PipeSettings pipes;
};

/// Options that only such pictures have. \param p  outlives them
std::vector<Option> hybridOptions(HybridPictures& p);

/// Whether a stage beside direct light is asked for, or pipes and shadows that they share.
bool isHybrid(const HybridPictures& p);
/// \throws UsageError for options that nothing would read
void checkHybrid(const HybridPictures& p);

/// Draws, writes and prints; with p.reference traces the same stages (reference/scene_components.hpp).
void renderHybrid(const Context& context, SceneDescription scene, const HybridPictures& p);

}  // namespace nacre::cli
