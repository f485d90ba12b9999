// Executes a PassSchedule (pass_schedule.hpp) on a render target.
#pragma once

#include <functional>
#include <vector>

#include "shading/gpu_mesh.hpp"
#include "shading/multipass/pass_schedule.hpp"
#include "shading/program.hpp"
#include "shading/render_target.hpp"
#include "shading/texture.hpp"

namespace nacre {

/// Of a Surfaces pass. Depth comes first, and alone, where a view adds to what is there: light is then added where
/// depths are equal. The background is where nothing was drawn; the first view's is what the target was cleared to.
enum class SurfacePart { Depth, Light, Background };

/// Draws a part of what a view sees, with NACRE_VIEW programs and setView. Touches no state but program, textures,
/// vertex array and front face: depth test, blending, masks, stencil and scissor are set.
using SurfaceDrawer = std::function<void(const ScheduledView& view, SurfacePart part)>;

/// Adds one of the schedule's lights to a view whose surfaces have been drawn. Any state, but: draws to the same
/// target, within the scissor, and only where the stencil has the view's level, which it leaves.
using LightAdder = std::function<void(const ScheduledView& view, int light)>;

struct FaceMesh {
    const GpuMesh* mesh = nullptr;
    glm::dmat4 toWorld{1};
    const Texture* texture = nullptr;  ///< SceneSpecular::texture
};

/// \param meshes  one a face of the schedule; \param target  cleared, its stencil to 0
/// Without faces it is one call of `draw`. Leaves depth test LESS and write on; blending, culling, scissor and stencil
/// test off. \throws nacre::Error in a context of OpenGL ES, which has no clip distances, when there are faces
void runPasses(ProgramLoader& loader, const PassSchedule& schedule, const RenderTarget& target,
               const std::vector<FaceMesh>& meshes, const SurfaceDrawer& draw, const LightAdder& add = {});

/// How the light of a view's pixels comes from the camera's eye, the last face on the way first: what face.glsl needs
/// to know a pixel's own angle. Empty where the virtual eye is exact: on ways without refraction.
struct FaceSteps {
    std::vector<glm::vec4> planes, eyes;
    glm::vec4 index{0}, first{0};
};
FaceSteps stepsTo(const PassSchedule& schedule, const ScheduledView& view);

/// Draws a face alone, or any mesh where depth is all that counts, with the state as it is. `as`: whose light, for
/// Weight passes; −1 for none.
void drawFace(ProgramLoader& loader, const ScheduledView& view, const FaceMesh& mesh,
              const SpecularFace* face = nullptr, Bounce bounce = Bounce::Reflected, const FaceSteps& steps = {});

}  // namespace nacre
