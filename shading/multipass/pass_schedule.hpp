// What is drawn, in which order, where: a picture with specular faces as a list of passes. A value, made without
// OpenGL: pass_runner.hpp executes it, pass_text.hpp prints it.
//
// The order is MPR's draw_window and draw_spec_objects (7.1). A view draws its surfaces and the faces' own light, and
//   Light    adds that of a lamp, or of its image in faces, where no shadow volume is counted. Then
// for each face that shows something, and each way that light leaves it:
//   Mask     where the face is seen, the stencil counts one level down
//   Clear    depths go back to the far plane there
//   Weight   (partial faces) destination alpha takes what share of the light the path keeps, a pixel at a time
//   …        the view behind the face, which recurs
//   Unmask   the count goes back, and the face's own depths return
#pragma once

#include <vector>

#include "core/scene.hpp"
#include "shading/multipass/specular_face.hpp"
#include "shading/multipass/stencil_counter.hpp"
#include "shading/multipass/virtual_light.hpp"

namespace nacre {

/// [pixels], from the lower left.
struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0;
    bool operator==(const PixelRect&) const = default;
};

struct ScheduledView {
    SpecularView view;
    int level = 0;               ///< specular surfaces on the way, and the stencil value of its pixels
    int parent = -1, face = -1;  ///< seen through this face of that view
    Bounce bounce{};             ///< how
    ViewLight light;             ///< factor: what the path keeps, the same in each pixel
    bool weighted = false;       ///< and times destination alpha
    int shear = -1;              ///< which of the samples, on paths with frosted or glossy faces
    double near = 0;             ///< depthOf what is nearer isn't seen
    bool adds = false;           ///< to what other paths left there; false: nothing has been drawn there yet
    std::vector<Vec2> window;    ///< where it is seen: a convex polygon, −1 to 1, counter-clockwise
    PixelRect scissor;           ///< the window's box
};

enum class PassKind { Surfaces, Light, Mask, Clear, Weight, Unmask };

struct Pass {
    PassKind kind = PassKind::Surfaces;
    int view = 0;     ///< whose matrix draws
    int face = -1;    ///< what is drawn: a face alone; −1: Surfaces, and Weight, which draws all faces of the path
    int stencil = 0;  ///< where the buffer equals this; Mask adds one there, Unmask takes one
    PixelRect scissor;
    int light = -1;  ///< of the schedule: what a Light pass adds
};

struct PassSchedule {
    std::vector<SpecularFace> faces;
    std::vector<ScheduledLight> lights;
    std::vector<ScheduledView> views;  ///< the camera's first; parents before children
    std::vector<Pass> passes;
    int deepest = 0;  ///< level of any view
    bool hasWeights = false;
    std::size_t unseen = 0;  ///< views that were left out since nothing can be seen in them
};

struct ScheduleInput {
    Camera camera;
    int width = 512, height = 512;  ///< [pixels]
    Vec3 low{0}, high{0};           ///< a box about the scene
    std::vector<ScheduledLight> lights{};
};

/// Paths that end at `depth` faces show those black, but for their own light. Views are left out whose window is empty:
/// the window is the face's outline in its parent's, cut by it (beam tracing on the image plane).
/// \throws std::invalid_argument for sizes < 1; nacre::Error when depth is more than the stencil counts, the views are
///         more than options.most, or there are lights and views that don't keep depth
PassSchedule makeSchedule(std::vector<SpecularFace> faces, const ScheduleInput& input, const SpecularOptions& options);

/// Whether some of a ball may be seen in a view; true where that isn't sure. width, height: of the picture.
bool maySee(const ScheduledView& view, int width, int height, const Vec3& centre, double radius);

/// depthOf the nearest point of a ball.
double nearestDepth(const SpecularView& view, const Vec3& centre, double radius);

/// The way to a view: for each face 2 · its number, + 1 where it refracts. The same for all shears of a face.
std::vector<int> pathOf(const PassSchedule& schedule, int view);

}  // namespace nacre
