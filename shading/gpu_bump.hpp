// A relief on the GPU: textures of a bump asset, and the uniforms that shaders/nacre/bind/bump.glsl declares.
#pragma once

#include <optional>

#include "bump/bump_asset.hpp"
#include "core/scene_description.hpp"
#include "shading/program.hpp"

namespace nacre {

class GpuBump;

/// A relief in use on a mesh. The mesh's tangents must run along ∂P/∂u with w the sign of the uv area (the primitives'
/// Circular tangents do, makeTangents makes them); stretched uv stretch the relief but not its slopes.
struct BumpSurface {
    const GpuBump* map = nullptr;  ///< none: smooth
    BumpShadow shadow = BumpShadow::Ellipse;
    Vec2 tiles{1};  ///< of the relief per unit of the mesh's uv, > 0

    /// Widens direct microfacet models (Beckmann, GGX) by the slopes that a far view blends; the asset's normals need a
    /// roughness channel. Other models and tables stay.
    bool roughness = false;

    /// Indirect light of one light: an RGB texture over the asset's uv of radiance per unit of that light's irradiance
    /// on the plane that faces it, with filter and wrap of its own; it is added as it is, times the light's colour and
    /// falloff, where the mesh faces the light. 0: none.
    GlName indirect = 0;
    int indirectLight = 0;  ///< index in LitView::lights
};

struct GpuBumpOptions {
    TexelFormat format = TexelFormat::Half;  ///< or Float, whose linear filter ES 3.0 doesn't promise
    /// Shadows blend two levels too. Without it a far plane shows a faint line where levels change; with it a shadowed
    /// frame takes 1.5 to 1.6 times plain bump mapping's instead of 1.3 (llvmpipe, one light, see bench/bump_gpu.hpp).
    bool blendLevels = false;
    unsigned threads = 0;  ///< for the shadows' levels (bump/bump_levels.hpp)
};

/// Normals (trilinear), ellipses and horizons (bilinear, in levels of bump/bump_levels.hpp), those that the maps
/// have, wrapped as the asset says. In mirrored tiles the relief's directions turn over with it.
class GpuBump {
public:
    /// Binds 0 to 2D and 2D array targets of the active unit and sets the unpack alignment to 1.
    /// \throws std::invalid_argument without normals or for Unorm8; StorageError for values that don't fit the format;
    ///         nacre::Error from the driver
    explicit GpuBump(const BumpMaps& maps, const GpuBumpOptions& options = {});

    int width() const { return width_; }
    int height() const { return height_; }
    Wrap wrap() const { return wrap_; }
    bool has(BumpShadow shadow) const;
    bool hasRoughness() const { return roughness_; }
    std::size_t bytes() const { return bytes_; }  ///< of all textures

private:
    friend void bindBump(const Program&, const BumpSurface&, int);
    int width_ = 0, height_ = 0, azimuths_ = 0;
    Wrap wrap_ = Wrap::Repeat;
    bool roughness_ = false;
    std::size_t bytes_ = 0;
    TextureName normals_;
    std::optional<TextureName> shape_, offset_, horizons_;
};

/// What a program for a relief must be loaded with. \param indirectLight  a light's index, or -1: none
ShaderDefines bumpDefines(BumpShadow shadow, Wrap wrap, bool roughness, int indirectLight);
/// The same for a surface in use; nothing for a smooth one.
/// \throws std::invalid_argument for a shadow or roughness that the maps don't have, tiles that aren't finite and > 0
ShaderDefines bumpDefines(const BumpSurface& surface);

/// Binds textures from unit firstUnit, at most kBumpUnits, and sets the uniforms; leaves `program` in use.
inline constexpr int kBumpUnits = 5;
void bindBump(const Program& program, const BumpSurface& surface, int firstUnit);

}  // namespace nacre
