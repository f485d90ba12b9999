// Prefiltering on the GPU, for surroundings that change: a little every frame, within a time.
#pragma once

#include <span>
#include <vector>

#include "core/environment.hpp"
#include "envmaps/prefilter.hpp"
#include "shading/gl_objects.hpp"
#include "shading/program.hpp"
#include "shading/render_target.hpp"

namespace nacre {

struct GpuPrefilterOptions {
    /// Source texels a width of the lobe (an anisotropic one's narrower width), and as many an angle farther out. The
    /// error falls with its square or faster and the cost grows with its square. Worst level, rmse as a share of the
    /// mean, over an even map, lamps and suns: 0.55 % with 8, 1.4 % with 4.
    double detail = 8;
    /// Of the result. Half floats filter everywhere, but drivers may truncate them.
    ColorFormat color = ColorFormat::Rgba16F;
};

/// A chain of lobes of one surrounding: a cube texture whose mip level k is levels[k], for
/// `textureLod(cube, direction, k)`. What result() names is always a complete chain of one moment; the next is made
/// behind it. Sums are deterministic quadrature (shaders/nacre/prefilter.glsl) and divided by those over a white map,
/// so a white surrounding stays white to rounding; the same bits for any time budget.
///
/// Lookups across edges are smooth where the driver filters seamlessly: enable GL_TEXTURE_CUBE_MAP_SEAMLESS on desktop.
/// Needs rendering to 32-bit floats (ES 3: EXT_color_buffer_float). Cost a texel: about 16 detail² lobe evaluations for
/// each doubling of the angle between the lobe's width, or a texel, and its end; an anisotropic lobe's are more by up
/// to its alphas' ratio. What would be more steps than drivers finish in one draw is summed in several, behind each
/// other.
class GpuPrefilter {
public:
    /// \param sourceSize  edge of the surroundings to come, ≥ 1; halved while even, and what is coarser than the last
    ///                    level isn't read
    /// \param levels      ≥ 1; sizes are size0 / 2^k, rounded down. A mirror's (isMirror) is sourceSize / 2^k.
    /// \throws std::invalid_argument for what breaks these, nacre::Error when the driver refuses
    GpuPrefilter(ProgramLoader& loader, int sourceSize, std::vector<PrefilterLevel> levels,
                 const GpuPrefilterOptions& options = {});

    /// Goes on for about `milliseconds` of wall time with glFinish (past them by at most one tile of 8 × 8 texels, or,
    /// when a chain begins, by the copy of the surrounding).
    /// \param source  a cube texture of sourceSize that `texture(source, direction)` answers the radiance of; it is
    /// read
    ///                only by the call that begins a chain, and may change afterwards
    /// \return true when this call completed a chain, which result() names from now on; the next call begins another
    /// Changes: program, textures of units 0 and 1 (0), framebuffer (0), viewport, vertex array (0); scissor, depth,
    /// blending and culling are off afterwards.
    bool update(GlName source, double milliseconds);

    /// A chain has been completed. Before that result() is black.
    bool ready() const { return ready_; }
    GlName result() const { return chains_[shown_].name(); }
    int levelCount() const { return static_cast<int>(levels_.size()); }
    double progress() const;  ///< share of the texels of the chain that is being made

    /// A level of result(), for checks. Desktop or ES; leaves framebuffer 0 bound.
    EnvMap read(int level) const;

private:
    void makeTextures(const GpuPrefilterOptions& options);
    void snapshot(GlName source);
    void warmUp();
    void prepare(int level) const;
    void drawBlocks(int level, int face, int firstBlock, int blocks);
    int blocksAFace(int level) const;

    struct Range {
        int first, last;  ///< levels of the strip
    };
    Range rangeOf(int level) const;
    std::vector<glm::ivec4> partsOf(int level) const;

    int sourceSize_;
    std::vector<PrefilterLevel> levels_;
    double detail_;
    int stripLevels_ = 1;
    std::vector<const Program*> programs_;        ///< of each level
    std::vector<std::vector<glm::ivec4>> parts_;  ///< of each level: what one draw sums
    const Program *copy_, *halve_;
    TextureName strip_, chains_[2], sums_[2];
    FramebufferName framebuffer_;
    VertexArray empty_;
    int shown_ = 0;
    bool ready_ = false, begun_ = false;
    int level_ = 0, face_ = 0, block_ = 0;  ///< what comes next
    double blockMilliseconds_ = 0;          ///< of the last draw of this level; 0 = unknown
};

/// The map as an OpenGL cube texture (RGBA32F, one level, linear filter): OpenEXR's faces mirrored to OpenGL's, so that
/// `texture(cube, direction)` answers the map's radiance. \throws std::invalid_argument unless the layout is Cube
void uploadCube(const EnvMap& map, const TextureName& texture);

}  // namespace nacre
