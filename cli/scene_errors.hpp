// A scene as drawn against the same scene traced, and what each approximation has to do with the difference.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/image.hpp"
#include "core/progress.hpp"
#include "reference/image_compare.hpp"
#include "reference/scene_trace.hpp"
#include "shading/scene_renderer.hpp"

namespace nacre::cli {

struct SceneShot {
    int width = 512, height = 512;
    int samples = 2;  ///< n × n shaded a pixel, and averaged
    double time = 0;
    bool interreflection = false;  ///< the reference has light between meshes
};
/// Both draw and trace specular surfaces to the depth of the renderer's switches.

/// Means of n × n pixels. \param fine  RGB, n times as large
Image shrunk(const Image& fine, int n);

/// Draws with the renderer's switches and reads back.
Image shoot(SceneRenderer& renderer, const SceneShot& shot);

/// The fastest of so many frames, drawn and read back, once programs and casters are there [s].
double fastestFrame(SceneRenderer& renderer, const SceneShot& shot, int frames);

/// One approximation. Errors are of sRGB values, as ImageDifference::psnrSrgb; all with the full reference's white.
struct SceneShare {
    std::string name;        ///< brdf, shadow maps, relief shadows, indirect light, surrounding
    double psnrOff = 0;      ///< picture with it switched off against the full reference [dB]: what it is good for
    double psnrWithout = 0;  ///< picture and reference both without it [dB]; brdf: the reference has the baked one
    double share = 0;        ///< 1 − mean square error without it / with it: what it does wrong; < 0: hides others'
};

struct SceneErrors {
    Image reference;
    double white = 1;  ///< pictureWhite(reference)
    ImageDifference all;
    std::optional<ImageDifference> occluded;  ///< where a surrounding lights: its light blocked by meshes, too
    std::vector<SceneShare> shares;
    std::vector<std::string> notes;
    double seconds = 0;  ///< of tracing
};

/// \param picture  the renderer's, with all switches on
/// \param rays     n × n a pixel of the reference; shares: fill SceneErrors::shares for the approximations it has
SceneErrors measureScene(SceneRenderer& renderer, const Image& picture, const SceneShot& shot, int rays, bool shares,
                         const Progress& progress);

}  // namespace nacre::cli
