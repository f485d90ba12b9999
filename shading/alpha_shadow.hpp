// Shadow maps with the alpha test and the stencil buffer, as HSE section 2.1 has them: what graphics hardware of 1999
// could do. shading/shadow_map.hpp is what to use.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/shadow_view.hpp"
#include "shading/gpu_direct_brdf.hpp"
#include "shading/lit_pass.hpp"
#include "shading/shadow_map.hpp"

namespace nacre {

/// Texels of the ramp, the one-dimensional texture that maps depth to alpha.
inline constexpr int kAlphaRampTexels = 256;
/// alpha = s in [0, 1], rounded to `bits` (32: not). Twin: nacre_alpha_ramp (shaders/nacre/alpha_shadow.glsl).
double alphaRamp(double s, int bits);

struct AlphaShadowOptions {
    int size = 1024;  ///< texels along the map's edge, even, ≥ 8
    int bits = 8;     ///< of alpha, in map, registers and framebuffer: 8 and 16 unorm, 32 float
    /// Two textures at once and a stencil buffer, or the form without: difference by blending in destination alpha.
    bool multiTexture = true;
    std::optional<double> bias{};  ///< [world units]; none: alphaBias
};

/// Texture coordinates are linear in the world, so this bias can't know slopes: a texel's half diagonal at the far end,
/// times tan 75°, which clears surfaces that lean as far from the map's plane, and what single precision leaves.
/// Steeper ones show acne, which is this method's price. Steps of alpha need no more: rounding keeps order, so a
/// receiver no deeper than what is stored has no greater alpha, and what is nearer than a step to its shadow's caster
/// may be lit. [world units]
double alphaBias(const ShadowView& view);

/// The map of one spot or directional light (a single square), RGBA with depth in alpha.
/// RGBA8; RGBA16 (OpenGL ES: EXT_texture_norm16); RGBA32F (OpenGL ES: EXT_color_buffer_float).
class AlphaShadow {
public:
    /// \throws std::invalid_argument for bits other than 8, 16, 32
    explicit AlphaShadow(const AlphaShadowOptions& options = {});

    /// Draws the scene from the light: one pass. State as ShadowMap::update leaves it.
    /// \throws std::invalid_argument for a light that needs a cube; nacre::Error from the driver
    void update(ProgramLoader& loader, const Light& light, const ShadowScene& scene);

    /// The picture of `meshes`, with the light's shadows, into a framebuffer of the options' bits: values above 1 are
    /// clamped unless bits = 32. Passes over the scene, with multi-texturing: ambient light; the test, lit fragments
    /// marked in the stencil buffer; the lit ones' light added. Without: ambient light; alpha by depth; alpha minus the
    /// projected map's; (the copy, alpha times 2^bits;) light times 1 − alpha added. Reads back; leaves framebuffer 0
    /// bound, depth test LESS and write on, blending, stencil test and culling off.
    /// \param view  the map's light, alone. \throws std::invalid_argument otherwise, and before update()
    Image render(ProgramLoader& loader, std::span<const ShadowCaster> meshes, const LitView& view,
                 const GpuDirectBrdf& brdf, int width, int height) const;

    const ShadowView& view() const { return view_; }
    double bias() const;  ///< in use [world units]

private:
    struct Frame;
    void scenePass(const Frame& frame, const char* step, double bias) const;
    void lightPass(const Frame& frame, const std::vector<Light>& lights, const Rgb& ambient) const;
    void markLit(const Frame& frame) const;
    void blendDifference(const Frame& frame) const;

    AlphaShadowOptions options_;
    ShadowView view_;
    bool drawn_ = false;
    TextureName ramp_, map_;
    FramebufferName framebuffer_;
    Renderbuffer depth_;
};

}  // namespace nacre
