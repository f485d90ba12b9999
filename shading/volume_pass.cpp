#include "shading/volume_pass.hpp"

#include <epoxy/gl.h>

#include "shading/context.hpp"
#include "shading/draw.hpp"
#include "shading/environment_pass.hpp"
#include "shading/pass_state.hpp"

namespace nacre {
namespace {

/// After the textures of a BRDF and a surrounding, where a mesh's relief is else.
constexpr int kVolumeUnit = kMaxFactoredTextures + kEnvironmentUnits;

/// Depth test and write on, culling and blending off; left so.
void setState(const RenderTarget& target) {
    target.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
}

template <class Brdf>
void render(ProgramLoader& loader, const RenderTarget& target, const VolumeSurface& surface, const LitView& view,
            const Brdf& brdf) {
    checkVolume(surface);
    checkLights(view.lights, kMaxLights);
    ShaderDefines defines = withLights(brdf.defines(), view);
    defines.emplace_back("NACRE_SCENE_LAMPS", "1");
    if (surface.method == VolumeMethod::March) defines.emplace_back("NACRE_VOLUME_MARCH", "1");
    const Program& program = loader.load("volume.vert.glsl", "volume.frag.glsl", defines);
    brdf.bind(program);
    setLights(program, view);
    drawVolume(program, target, surface, view.camera);
}

}  // namespace

void drawVolume(const Program& program, const VolumeSurface& surface, const SpecularView& view,
                const ViewLight& light) {
    checkVolume(surface);
    bindVolume(program, surface, kVolumeUnit);
    setView(program, view, light);
    const bool march = surface.method == VolumeMethod::March;
    if (march) program.set("nacre_clip_to_world", glm::mat4(glm::inverse(view.toClip)));
    program.use();
    if (march) {
        drawFullscreen(VertexArray());
    } else {
        // Along which depths grow: the camera's axis, or its image.
        const Vec3 deeper(view.toClip[0][3], view.toClip[1][3], view.toClip[2][3]);
        const Vec3 axis = view.eye.w == 0 ? -Vec3(view.eye) : glm::normalize(deeper);
        drawSlices(volumeSlices(volumeBox(surface), axis, volumeStep(surface)));
    }
    checkGl("drawing a volume");
}

void drawVolume(const Program& program, const RenderTarget& target, const VolumeSurface& surface,
                const Camera& camera) {
    setState(target);
    drawVolume(program, surface, viewOf(camera, static_cast<double>(target.width()) / target.height()));
}

void renderVolume(ProgramLoader& loader, const RenderTarget& target, const VolumeSurface& surface, const LitView& view,
                  const GpuFactoredBrdf& brdf) {
    render(loader, target, surface, view, brdf);
}

void renderVolume(ProgramLoader& loader, const RenderTarget& target, const VolumeSurface& surface, const LitView& view,
                  const GpuDirectBrdf& brdf) {
    render(loader, target, surface, view, brdf);
}

}  // namespace nacre
