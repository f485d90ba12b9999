#include "shading/alpha_shadow.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"
#include "shading/pass_state.hpp"

namespace nacre {
namespace {

GLint colorFormat(int bits) { return bits == 8 ? GL_RGBA8 : bits == 16 ? GL_RGBA16 : GL_RGBA32F; }

/// An empty RGBA texture with alpha of so many bits, nearest, clamped; leaves it bound.
void allocate(const TextureName& texture, int bits, int width, int height) {
    glBindTexture(GL_TEXTURE_2D, texture.name());
    const GLenum type = bits == 8 ? GL_UNSIGNED_BYTE : bits == 16 ? GL_UNSIGNED_SHORT : GL_FLOAT;
    glTexImage2D(GL_TEXTURE_2D, 0, colorFormat(bits), width, height, 0, GL_RGBA, type, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

/// Colour into the texture, depth and stencil into the renderbuffer. Leaves the framebuffer bound.
void attach(const FramebufferName& framebuffer, const TextureName& color, const Renderbuffer& depth, int width,
            int height, const std::string& what) {
    glBindRenderbuffer(GL_RENDERBUFFER, depth.name());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, width, height);
    glBindRenderbuffer(GL_RENDERBUFFER, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color.name(), 0);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, depth.name());
    checkGl(what);
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw Error(
            fmt::format("{}: expected a complete framebuffer (OpenGL ES needs EXT_texture_norm16 for 16 bits of alpha, "
                        "EXT_color_buffer_float for 32), found status 0x{:04x}",
                        what, status));
}

void bindTexture(const Program& program, const char* sampler, GlName texture, int unit) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, texture);
    program.set(sampler, unit);
}

void drawAll(const Program& program, std::span<const ShadowCaster> meshes) {
    for (const ShadowCaster& m : meshes) {
        setModel(program, m.toWorld);
        m.mesh->draw();
    }
}

/// Texture coordinates of the light: its map's place, and depth less `bias` from near to far.
void setCoordinates(const Program& program, const ShadowView& view, double bias) {
    const glm::dmat4 clip = shadowClip(view, 0) * view.fromWorld;
    glm::dmat4 half(0.5);  // clip coordinates to texture coordinates
    half[3] = Vec4(0.5, 0.5, 0.5, 1);
    const Vec4 z(view.fromWorld[0][2], view.fromWorld[1][2], view.fromWorld[2][2], view.fromWorld[3][2]);
    program.set("nacre_alpha_light_clip", glm::mat4(clip));
    program.set("nacre_alpha_project", glm::mat4(half * clip));
    program.set("nacre_alpha_depth", glm::vec4((z - Vec4(0, 0, 0, view.near + bias)) / (view.far - view.near)));
}

void opaqueState() {
    glDisable(GL_DITHER);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glDisable(GL_STENCIL_TEST);
}

/// What was drawn once is drawn again on top of itself.
void againState(bool blend, GLenum equation, GLenum source, GLenum destination) {
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    blend ? glEnable(GL_BLEND) : glDisable(GL_BLEND);
    glBlendEquation(equation);
    glBlendFunc(source, destination);
}

constexpr double kSteepest = 3.7320508;  ///< tan 75°
constexpr GLboolean kOn = GL_TRUE, kOff = GL_FALSE;

}  // namespace

/// One picture in the making: what is drawn and where.
struct AlphaShadow::Frame {
    ProgramLoader& loader;
    std::span<const ShadowCaster> meshes;
    const LitView& view;
    const GpuDirectBrdf& brdf;
    int width, height;
    double aspect() const { return static_cast<double>(width) / height; }
};

double alphaRamp(double s, int bits) {
    const double steps = bits == 32 ? 0 : std::pow(2.0, bits) - 1, alpha = clamp01(s);
    return steps > 0 ? std::floor(alpha * steps + 0.5) / steps : alpha;
}

double alphaBias(const ShadowView& view) {
    const double texel = view.kind == ShadowKind::Directional ? 2 / (view.cascades[0].z * view.size)
                                                              : 2 * view.far / (view.scale * view.size);
    return std::sqrt(0.5) * texel * kSteepest + view.resolution;
}

AlphaShadow::AlphaShadow(const AlphaShadowOptions& options) : options_(options) {
    require(options.bits == 8 || options.bits == 16 || options.bits == 32,
            fmt::format("alpha shadow: expected 8, 16 or 32 bits of alpha, found {}", options.bits));
    std::array<float, kAlphaRampTexels> ramp{};
    for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<float>(i) / (kAlphaRampTexels - 1);
    glBindTexture(GL_TEXTURE_2D, ramp_.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, kAlphaRampTexels, 1, 0, GL_RED, GL_FLOAT, ramp.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glBindTexture(GL_TEXTURE_2D, 0);
    checkGl("ramp of an alpha shadow");
}

double AlphaShadow::bias() const { return options_.bias ? *options_.bias : alphaBias(view_); }

void AlphaShadow::update(ProgramLoader& loader, const Light& light, const ShadowScene& scene) {
    SceneShadow fit;
    fit.size = options_.size;
    fit.bias = options_.bias;
    const ShadowView view = fitShadow(fit, light, scene.bounds);
    require(view.layers() == 1, "alpha shadow: expected a spot or a directional light");
    const Program& program = loader.load("alpha_shadow.vert.glsl", "alpha_shadow.frag.glsl",
                                         {{"NACRE_ALPHA_STEP", "NACRE_ALPHA_RAMP"}, {"NACRE_ALPHA_FROM_LIGHT", "1"}});
    if (!drawn_) {
        allocate(map_, options_.bits, options_.size, options_.size);
        glBindTexture(GL_TEXTURE_2D, 0);
        attach(framebuffer_, map_, depth_, options_.size, options_.size,
               fmt::format("alpha shadow map of {0} x {0}, {1} bits", options_.size, options_.bits));
    }
    view_ = view;
    drawn_ = true;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, view.size, view.size);
    opaqueState();
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    setCoordinates(program, view, 0);
    bindTexture(program, "nacre_alpha_ramp_texture", ramp_.name(), 0);
    program.set("nacre_alpha_steps", options_.bits == 32 ? 0.0f : std::exp2(static_cast<float>(options_.bits)) - 1);
    drawAll(program, scene.casters);
    glEnable(GL_DITHER);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("drawing an alpha shadow map");
}

/// The scene with one of alpha_shadow.frag.glsl's steps.
void AlphaShadow::scenePass(const Frame& frame, const char* step, double bias) const {
    const Program& program =
        frame.loader.load("alpha_shadow.vert.glsl", "alpha_shadow.frag.glsl", {{"NACRE_ALPHA_STEP", step}});
    setCoordinates(program, view_, bias);
    bindTexture(program, "nacre_alpha_ramp_texture", ramp_.name(), 0);
    bindTexture(program, "nacre_alpha_map", map_.name(), 1);
    program.set("nacre_alpha_steps", options_.bits == 32 ? 0.0f : std::exp2(static_cast<float>(options_.bits)) - 1);
    setView(program, frame.view.camera, frame.aspect());
    drawAll(program, frame.meshes);
}

void AlphaShadow::lightPass(const Frame& frame, const std::vector<Light>& lights, const Rgb& ambient) const {
    LitView view = frame.view;
    view.lights = lights;
    view.ambient = ambient;
    const Program& program =
        frame.loader.load("lit.vert.glsl", "lit.frag.glsl", withLights(frame.brdf.defines(), lights));
    frame.brdf.bind(program);
    setView(program, view.camera, frame.aspect());
    setLights(program, view);
    drawAll(program, frame.meshes);
}

/// Both textures at once: fragments with alpha 0 live and leave a mark.
void AlphaShadow::markLit(const Frame& frame) const {
    againState(false, GL_FUNC_ADD, GL_ONE, GL_ZERO);
    glColorMask(kOff, kOff, kOff, kOff);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_ALWAYS, 1, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    scenePass(frame, "NACRE_ALPHA_TEST", bias());
    glColorMask(kOn, kOn, kOn, kOn);
    glStencilFunc(GL_EQUAL, 1, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
}

/// One texture a pass: alpha becomes the receiver's, less the map's, then 0 or 1 by the scaled copy.
void AlphaShadow::blendDifference(const Frame& frame) const {
    glColorMask(kOff, kOff, kOff, kOn);
    againState(false, GL_FUNC_ADD, GL_ONE, GL_ZERO);
    scenePass(frame, "NACRE_ALPHA_RAMP", bias());
    againState(true, GL_FUNC_REVERSE_SUBTRACT, GL_ONE, GL_ONE);
    scenePass(frame, "NACRE_ALPHA_MAP", 0);
    glDisable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    const TextureName copied;
    allocate(copied, options_.bits, frame.width, frame.height);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, frame.width, frame.height);
    const Program& copy = frame.loader.load("fullscreen.vert.glsl", "alpha_copy.frag.glsl");
    bindTexture(copy, "nacre_alpha_map", copied.name(), 0);
    copy.set("nacre_alpha_scale", std::exp2(static_cast<float>(options_.bits)));
    glDisable(GL_DEPTH_TEST);
    drawFullscreen(VertexArray());
    glEnable(GL_DEPTH_TEST);
    glColorMask(kOn, kOn, kOn, kOn);
}

Image AlphaShadow::render(ProgramLoader& loader, std::span<const ShadowCaster> meshes, const LitView& view,
                          const GpuDirectBrdf& brdf, int width, int height) const {
    require(drawn_, "alpha shadow: the map was not drawn yet");
    require(view.lights.size() == 1 && view.shadows.empty(), "alpha shadow: expected the map's light alone");
    require(width >= 1 && height >= 1, "alpha shadow: width and height must be >= 1");
    checkLights(view.lights, 1);
    const Frame frame{loader, meshes, view, brdf, width, height};
    const TextureName color;
    const Renderbuffer depth;
    const FramebufferName framebuffer;
    allocate(color, options_.bits, width, height);
    attach(framebuffer, color, depth, width, height, fmt::format("alpha shadow's picture of {} x {}", width, height));
    glViewport(0, 0, width, height);
    opaqueState();
    glClearColor(0, 0, 0, 0);
    glClearStencil(0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    lightPass(frame, {}, view.ambient);
    if (options_.multiTexture) {
        markLit(frame);
        againState(true, GL_FUNC_ADD, GL_ONE, GL_ONE);
    } else {
        blendDifference(frame);
        againState(true, GL_FUNC_ADD, GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    }
    glColorMask(kOn, kOn, kOn, kOff);
    lightPass(frame, view.lights, Rgb(0));
    glColorMask(kOn, kOn, kOn, kOn);
    opaqueState();
    glEnable(GL_DITHER);
    std::vector<float> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, pixels.data());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("drawing with an alpha shadow");
    Image out(width, height, 3);
    for (int y = 0; y < height; ++y)  // OpenGL's first row is the lowest
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                out.at(x, height - 1 - y, c) =
                    pixels[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x) * 4 + c];
    return out;
}

}  // namespace nacre
