#include "shading/shadow_map.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"
#include "shading/pass_state.hpp"

namespace nacre {
namespace {

constexpr const char* kKinds[] = {"NACRE_SHADOW_SPOT", "NACRE_SHADOW_DIRECTIONAL", "NACRE_SHADOW_CUBE",
                                  "NACRE_SHADOW_DUAL_PARABOLOID"};

/// Culls what the options don't draw. Seen from the light, matrices that mirror turn front faces over.
void setFaces(SceneShadow::Faces faces, const glm::dmat4& toWorld) {
    glFrontFace(glm::determinant(glm::dmat3(toWorld)) < 0 ? GL_CW : GL_CCW);
    if (faces == SceneShadow::Faces::Both) {
        glDisable(GL_CULL_FACE);
        return;
    }
    glEnable(GL_CULL_FACE);
    glCullFace(faces == SceneShadow::Faces::Front ? GL_BACK : GL_FRONT);
}

void setDrawn(const Program& program, const ShadowView& view) {
    program.set("nacre_shadow_drawn", glm::vec4(Vec4(view.near, 1 / (view.far - view.near), view.scale, view.size)));
}

void setLayer(const Program& program, const ShadowView& view, int layer) {
    const bool paraboloid = view.kind == ShadowKind::DualParaboloid;
    if (!paraboloid) program.set("nacre_shadow_to_clip", glm::mat4(shadowClip(view, layer)));
    setDrawn(program, view);
}

void drawCasters(const Program& program, const ShadowView& view, int layer, const ShadowScene& scene,
                 SceneShadow::Faces faces) {
    const glm::dmat4 toLight = glm::dmat4(shadowLayerFrame(view, layer)) * view.fromWorld;
    for (const ShadowCaster& caster : scene.casters) {
        program.set("nacre_shadow_from_mesh", glm::mat4(toLight * caster.toWorld));
        setFaces(faces, caster.toWorld);
        caster.mesh->draw();
    }
}

/// In the units of bind/volume.glsl; 0 holds the depths that store() reads.
constexpr int kVolumeUnit = 1;

ShaderDefines rayDefines(ShadowKind kind) {
    if (kind == ShadowKind::DualParaboloid) return {{"NACRE_SHADOW_PARABOLOID", "1"}};
    if (kind == ShadowKind::Directional) return {{"NACRE_SHADOW_PARALLEL", "1"}};
    return {};
}

void marchVolume(ProgramLoader& loader, const ShadowView& view, int layer, const VolumeSurface& surface,
                 const glm::dmat4& toLight) {
    const Program& program = loader.load("fullscreen.vert.glsl", "shadow_volume.frag.glsl", rayDefines(view.kind));
    setDrawn(program, view);
    if (view.kind == ShadowKind::Directional)
        program.set("nacre_shadow_square", glm::vec3(view.cascades[static_cast<std::size_t>(layer)]));
    bindVolume(program, surface, kVolumeUnit, toLight);
    drawFullscreen(VertexArray());
}

void sliceVolume(ProgramLoader& loader, const ShadowView& view, int layer, const VolumeSurface& surface,
                 const glm::dmat4& toLight) {
    const Program& program =
        loader.load("shadow_map.vert.glsl", "shadow_map.frag.glsl", {{"NACRE_SHADOW_SLICES", "1"}});
    setLayer(program, view, layer);
    program.set("nacre_shadow_from_mesh", glm::mat4(1));
    bindVolume(program, surface, kVolumeUnit, toLight);
    drawSlices(volumeSlices(toLight * volumeBox(surface), Vec3(0, 0, 1), volumeStep(surface)));
}

void drawVolumes(ProgramLoader& loader, const ShadowView& view, int layer, const std::vector<VolumeSurface>& volumes) {
    glDisable(GL_CULL_FACE);
    const glm::dmat4 toLight = glm::dmat4(shadowLayerFrame(view, layer)) * view.fromWorld;
    for (const VolumeSurface& surface : volumes) {
        const bool march = surface.method == VolumeMethod::March || view.kind == ShadowKind::DualParaboloid;
        (march ? marchVolume : sliceVolume)(loader, view, layer, surface, toLight);
    }
}

void unfiltered(GLenum target) {
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glBindTexture(target, 0);
}

void checkComplete(const std::string& what) {
    checkGl(what);
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw Error(fmt::format("{}: expected a complete framebuffer, found status 0x{:04x}", what, status));
}

bool fits(const Light& light, ShadowKind kind) { return light.directional == (kind == ShadowKind::Directional); }

}  // namespace

void ShadowMap::allocate(int layers) {
    if (texture_ && layers_ == layers) return;
    const bool half = options_.bits == 16;
    const int size = options_.size;
    TextureName texture, depth;
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture.name());
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, half ? GL_RGBA16UI : GL_RGBA32UI, size, size / 2, layers, 0, GL_RGBA_INTEGER,
                 half ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT, nullptr);
    unfiltered(GL_TEXTURE_2D_ARRAY);
    glBindTexture(GL_TEXTURE_2D, depth.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, size, size, 0, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
    unfiltered(GL_TEXTURE_2D);
    const std::string what = fmt::format("shadow map of {} x {} x {}, {} bits", size, size, layers, options_.bits);
    FramebufferName drawn, stored;
    glBindFramebuffer(GL_FRAMEBUFFER, drawn.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth.name(), 0);
    const GLenum none = GL_NONE;
    glDrawBuffers(1, &none);
    glReadBuffer(GL_NONE);
    checkComplete(what);
    glBindFramebuffer(GL_FRAMEBUFFER, stored.name());
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture.name(), 0, 0);
    checkComplete(what);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    texture_ = std::move(texture);
    depth_ = std::move(depth);
    drawn_ = std::move(drawn);
    stored_ = std::move(stored);
    layers_ = layers;
}

void ShadowMap::store(const Program& program, int layer) const {
    glBindFramebuffer(GL_FRAMEBUFFER, stored_->name());
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture_->name(), 0, layer);
    glViewport(0, 0, options_.size, options_.size / 2);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, depth_->name());
    program.set("nacre_shadow_depth", 0);
    program.set("nacre_shadow_stored", glm::vec2(view_.near, view_.far - view_.near));
    program.set("nacre_shadow_bits", options_.bits);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    drawFullscreen(VertexArray());
    glEnable(GL_DEPTH_TEST);
    glBindTexture(GL_TEXTURE_2D, 0);
}

void ShadowMap::update(ProgramLoader& loader, const Light& light, const ShadowScene& scene) {
    for (const ShadowCaster& caster : scene.casters) require(caster.mesh != nullptr, "shadow map: a caster is null");
    for (const VolumeSurface& volume : scene.volumes) checkVolume(volume);
    const ShadowView view = fitShadow(options_, light, scene.bounds, scene.camera, scene.aspect);
    ShaderDefines defines;
    if (view.kind == ShadowKind::DualParaboloid) defines.emplace_back("NACRE_SHADOW_PARABOLOID", "1");
    const Program& draw = loader.load("shadow_map.vert.glsl", "shadow_map.frag.glsl", defines);
    const Program& blocks = loader.load("fullscreen.vert.glsl", "shadow_blocks.frag.glsl");
    allocate(view.layers());
    view_ = view;
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    for (int layer = 0; layer < layers_; ++layer) {
        glBindFramebuffer(GL_FRAMEBUFFER, drawn_->name());
        glViewport(0, 0, view.size, view.size);
        glClear(GL_DEPTH_BUFFER_BIT);
        setLayer(draw, view, layer);
        drawCasters(draw, view, layer, scene, options_.faces);
        drawVolumes(loader, view, layer, scene.volumes);
        store(blocks, layer);
    }
    glFrontFace(GL_CCW);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("drawing a shadow map");
}

std::size_t ShadowMap::bytes() const {
    return static_cast<std::size_t>(layers_) * static_cast<std::size_t>(options_.size) *
           static_cast<std::size_t>(options_.size) * (options_.bits == 16 ? 4 : 8);
}

std::vector<Image> ShadowMap::download() const {
    require(drawn(), "shadow map: nothing drawn yet");
    const auto edge = static_cast<std::size_t>(options_.size);
    std::vector<std::uint32_t> all(2 * edge * edge * static_cast<std::size_t>(layers_));
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture_->name());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT, all.data());
    glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
    checkGl("reading a shadow map");
    const auto decode = [&](std::uint32_t code) {
        const float depth =
            options_.bits == 16
                ? static_cast<float>(code) / 65535
                : static_cast<float>((std::bit_cast<float>(code) - view_.near) / (view_.far - view_.near));
        return std::clamp(depth, 0.0f, 1.0f);
    };
    std::vector<Image> out;
    std::size_t at = 0;
    for (int layer = 0; layer < layers_; ++layer) {
        Image& image = out.emplace_back(options_.size, options_.size, 1);
        for (int y = 0; y < options_.size; y += 2)
            for (int x = 0; x < options_.size; ++x, at += 4)
                for (int k = 0; k < 2; ++k) image.at(x, y + k, 0) = decode(all[at + static_cast<std::size_t>(k)]);
    }
    return out;
}

ShaderDefines shadowDefines(std::span<const ShadowMap* const> shadows, std::span<const Light> lights) {
    if (shadows.empty()) return {};
    require(
        shadows.size() == lights.size() && shadows.size() <= kMaxShadows,
        fmt::format("shadows: expected none or one for each of {} lights, found {}", lights.size(), shadows.size()));
    std::vector<const ShadowView*> views;
    for (std::size_t i = 0; i < shadows.size(); ++i) {
        views.push_back(nullptr);
        if (shadows[i] == nullptr) continue;
        require(shadows[i]->drawn(), "shadows: a map was not drawn yet");
        views.back() = &shadows[i]->view();
        require(fits(lights[i], views.back()->kind),
                fmt::format("shadows: light {} is of another kind than its map", i));
    }
    return shadowDefines(views);
}

ShaderDefines shadowDefines(std::span<const ShadowView* const> views) {
    ShaderDefines out;
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (views[i] == nullptr) continue;
        if (out.empty()) out.emplace_back("NACRE_SHADOWS", "1");
        const ShadowView& view = *views[i];
        out.emplace_back(fmt::format("NACRE_SHADOW_{}", i),
                         fmt::format("{}, {}, {}, {}", kKinds[static_cast<std::size_t>(view.kind)], view.filter,
                                     view.bits, view.cascades.size()));
    }
    return out;
}

void bindShadows(const Program& program, std::span<const ShadowMap* const> shadows, int firstUnit) {
    std::array<glm::mat4, kMaxShadows> fromWorld{};
    std::array<glm::vec4, kMaxShadows> ranges{}, sizes{};
    std::array<glm::vec4, 4 * kMaxShadows> cascades{};
    bool any = false;
    for (std::size_t i = 0; i < shadows.size(); ++i) {
        if (shadows[i] == nullptr) continue;
        any = true;
        const ShadowView& view = shadows[i]->view();
        fromWorld[i] = glm::mat4(view.fromWorld);
        ranges[i] = glm::vec4(Vec4(view.near, view.far - view.near, view.resolution, view.bias.value_or(-1)));
        const double half = view.size / 2.0;
        sizes[i] = glm::vec4(Vec4(view.size, 1.0 / view.size, view.scale * half, 1 / (view.scale * half)));
        for (std::size_t k = 0; k < view.cascades.size(); ++k) {
            const Vec3& c = view.cascades[k];
            cascades[4 * i + k] = glm::vec4(Vec4((c.x + 1) * half, (c.y + 1) * half, c.z * half, 1 / (c.z * half)));
        }
        const int unit = firstUnit + static_cast<int>(i);
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        glBindTexture(GL_TEXTURE_2D_ARRAY, shadows[i]->texture_->name());
        program.set(fmt::format("nacre_shadow_map{}", i), unit);
    }
    if (!any) return;
    program.set("nacre_shadow_from_world", fromWorld);
    program.set("nacre_shadow_range", ranges);
    program.set("nacre_shadow_size", sizes);
    program.set("nacre_shadow_cascades", cascades);
}

void renderShadowMask(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const Camera& camera,
                      const ShadowMap& shadow, const glm::dmat4& toWorld) {
    const ShadowMap* const shadows[] = {&shadow};
    Light light;
    light.directional = shadow.drawn() && shadow.view().kind == ShadowKind::Directional;
    const Program& program =
        loader.load("lit.vert.glsl", "shadow_mask.frag.glsl", shadowDefines(shadows, std::span(&light, 1)));
    bindShadows(program, shadows, 0);
    setView(program, camera, target);
    drawMesh(program, target, mesh, toWorld);
}

}  // namespace nacre
