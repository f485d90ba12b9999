#include "shading/multipass/pass_runner.hpp"

#include <epoxy/gl.h>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/pass_state.hpp"

namespace nacre {
namespace {

class Runner {
public:
    Runner(ProgramLoader& loader, const PassSchedule& schedule, const RenderTarget& target,
           const std::vector<FaceMesh>& meshes, const SurfaceDrawer& draw, const LightAdder& add)
        : loader_(loader), schedule_(schedule), target_(target), meshes_(meshes), draw_(draw), add_(add) {}

    void run() {
        target_.bind();
        glEnable(GL_DEPTH_TEST);
        glDisable(GL_CULL_FACE);
        glDisable(GL_BLEND);
        enableTests();
        for (const Pass& pass : schedule_.passes) execute(pass);
        glDisable(GL_STENCIL_TEST);
        glDisable(GL_SCISSOR_TEST);
        if (!schedule_.faces.empty()) glDisable(GL_CLIP_DISTANCE0);
        if (schedule_.hasWeights) {  // alpha was in use
            colorMask(false, true);
            glClearColor(0, 0, 0, 1);
            glClear(GL_COLOR_BUFFER_BIT);
        }
        colorMask(true, true);
        depth(GL_LESS, true);
        checkGl("drawing specular views");
    }

private:
    void enableTests() const {
        if (schedule_.faces.empty()) return;
        glEnable(GL_STENCIL_TEST);
        glEnable(GL_SCISSOR_TEST);
        glEnable(GL_CLIP_DISTANCE0);
    }

    static void colorMask(bool color, bool alpha) { glColorMask(color, color, color, alpha); }
    static void depth(GLenum function, bool write) {
        glDepthFunc(function);
        glDepthMask(write);
    }

    void execute(const Pass& pass) {
        glScissor(pass.scissor.x, pass.scissor.y, pass.scissor.width, pass.scissor.height);
        glStencilFunc(GL_EQUAL, pass.stencil, ~0u);
        glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
        const ScheduledView& view = schedule_.views[static_cast<std::size_t>(pass.view)];
        switch (pass.kind) {
            case PassKind::Surfaces:
                return surfaces(view);
            case PassKind::Light:
                add_(view, pass.light);
                glStencilMask(~0u);
                return enableTests();
            case PassKind::Mask:  // no later face hides it: all faces' depths are there
                glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
                depth(GL_LEQUAL, false);
                return face(view, pass.face);
            case PassKind::Clear:
                glDepthRange(1, 1);
                depth(GL_ALWAYS, true);
                face(view, pass.face);
                glDepthRange(0, 1);
                return;
            case PassKind::Weight:
                return weight(view);
            case PassKind::Unmask:
                glStencilOp(GL_KEEP, GL_KEEP, GL_DECR);
                depth(GL_ALWAYS, true);
                return face(view, pass.face);
        }
    }

    void surfaces(const ScheduledView& view) {
        const bool flat = view.view.toClip[3][2] == 0 && view.view.toClip[2][2] == 0 && view.view.toClip[0][2] == 0 &&
                          view.view.toClip[1][2] == 0;
        if (view.adds) {
            colorMask(false, false);
            depth(GL_LESS, true);
            draw_(view, SurfacePart::Depth);
        }
        colorMask(true, view.level == 0);
        blend(view);
        depth(view.adds ? GL_EQUAL : flat ? GL_ALWAYS : GL_LESS, !view.adds);
        draw_(view, SurfacePart::Light);
        depth(GL_LEQUAL, false);
        draw_(view, SurfacePart::Background);
        glDisable(GL_BLEND);
        colorMask(true, true);
        depth(GL_LESS, true);
    }

    static void blend(const ScheduledView& view) {
        if (!view.adds && !view.weighted) return glDisable(GL_BLEND);
        glEnable(GL_BLEND);
        glBlendFunc(view.weighted ? GL_DST_ALPHA : GL_ONE, view.adds ? GL_ONE : GL_ZERO);
    }

    void face(const ScheduledView& view, int index) {
        colorMask(false, false);
        const auto i = static_cast<std::size_t>(index);
        drawFace(loader_, view, meshes_[i]);
        colorMask(true, true);
    }

    /// The product over the path's faces, each seen from where its light came to the eye.
    void weight(const ScheduledView& view) {
        colorMask(false, true);
        glDisable(GL_DEPTH_TEST);
        glBlendFunc(GL_ZERO, GL_SRC_ALPHA);
        const ScheduledView* at = &view;
        for (bool first = true; at->parent >= 0; first = false) {
            const auto i = static_cast<std::size_t>(at->face);
            const ScheduledView& before = schedule_.views[static_cast<std::size_t>(at->parent)];
            (first ? glDisable : glEnable)(GL_BLEND);
            drawFace(loader_, before, meshes_[i], &schedule_.faces[i], at->bounce, stepsTo(schedule_, before));
            at = &before;
        }
        glDisable(GL_BLEND);
        glEnable(GL_DEPTH_TEST);
        colorMask(true, true);
    }

    ProgramLoader& loader_;
    const PassSchedule& schedule_;
    const RenderTarget& target_;
    const std::vector<FaceMesh>& meshes_;
    const SurfaceDrawer& draw_;
    const LightAdder& add_;
};

}  // namespace

void runPasses(ProgramLoader& loader, const PassSchedule& schedule, const RenderTarget& target,
               const std::vector<FaceMesh>& meshes, const SurfaceDrawer& draw, const LightAdder& add) {
    require(meshes.size() == schedule.faces.size(), "runPasses: expected a mesh for each face");
    require(schedule.lights.empty() || add, "runPasses: expected something that adds lights");
    if (!schedule.faces.empty() && !epoxy_is_desktop_gl())
        throw Error("specular faces: expected OpenGL with clip distances, found OpenGL ES");
    Runner(loader, schedule, target, meshes, draw, add).run();
}

FaceSteps stepsTo(const PassSchedule& schedule, const ScheduledView& view) {
    FaceSteps out;
    bool bends = false;
    const ScheduledView* at = &view;
    while (at->parent >= 0 && out.planes.size() < 4) {
        const ScheduledView& before = schedule.views[static_cast<std::size_t>(at->parent)];
        const SpecularFace& face = schedule.faces[static_cast<std::size_t>(at->face)];
        if (at->bounce == Bounce::Refracted) {
            const double index = sideOf(before.view, face.plane) > 0 ? *face.specular.ior : 1 / *face.specular.ior;
            out.index[static_cast<int>(out.planes.size())] = static_cast<float>(index);
            bends = bends || index != 1;
        }
        out.planes.emplace_back(face.plane);
        out.eyes.emplace_back(at->view.eye);
        at = &before;
    }
    out.first = glm::vec4(at->view.eye);
    return bends ? out : FaceSteps();
}

void drawFace(ProgramLoader& loader, const ScheduledView& view, const FaceMesh& mesh, const SpecularFace* face,
              Bounce bounce, const FaceSteps& steps) {
    ShaderDefines defines{{"NACRE_VIEW", "1"}};
    defines = joined(std::move(defines), viewDefines(view.light));
    if (!steps.planes.empty()) defines.emplace_back("NACRE_FACE_STEPS", std::to_string(steps.planes.size()));
    const bool textured = face && mesh.texture;
    if (textured) defines.emplace_back("NACRE_FACE_TEXTURE", "1");
    const Program& program = loader.load("lit.vert.glsl", "face.frag.glsl", defines);
    setView(program, view.view, view.light);
    if (!steps.planes.empty()) {
        program.set("nacre_step_plane", steps.planes);
        program.set("nacre_step_eye", steps.eyes);
        program.set("nacre_step_index", steps.index);
        program.set("nacre_step_first", steps.first);
    }
    if (textured) {
        mesh.texture->bind(0);
        program.set("nacre_face_texture", 0);
        program.set("nacre_face_surface", static_cast<float>(face->specular.surface));
    }
    float index = 0;
    if (face && face->specular.ior && face->specular.partial)
        index = static_cast<float>(sideOf(view.view, face->plane) > 0 ? *face->specular.ior : 1 / *face->specular.ior);
    program.set("nacre_face_index", index);
    program.set("nacre_face_normal", face ? glm::vec3(Vec3(face->plane)) : glm::vec3(0));
    program.set("nacre_face_reflects", bounce == Bounce::Reflected ? 1 : 0);
    drawPlaced(program, *mesh.mesh, mesh.toWorld, view.view.mirrored);
}

}  // namespace nacre
