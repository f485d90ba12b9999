// Prefiltered environment maps on the GPU: a chain of levels as one texture's mip levels, and the tables that weigh
// them.
#pragma once

#include <span>

#include "core/environment.hpp"
#include "core/texture.hpp"
#include "shading/program.hpp"
#include "shading/texture.hpp"

namespace nacre {

struct GpuEnvironmentOptions {
    TexelFormat format = TexelFormat::Half;  ///< or Float
    /// The texture holds radiance / scale, for half floats and suns above 65504; scale() says it, and renderers of
    /// environment_pass.hpp multiply it back.
    double scale = 1;
};

/// NACRE_ENV_LAYOUT, as shaders/nacre/bind/environment.glsl wants it.
ShaderDefines layoutDefines(EnvLayout layout);

/// Levels of one layout, finest first, as the mip levels of one texture: GL_TEXTURE_CUBE_MAP for Cube, else
/// GL_TEXTURE_2D with the map's image as it is. Linear filter within levels; between them linear for a cube, while
/// shaders blend the levels of the others themselves (nacre_env_chain), for each has its own N in the coordinates.
///
/// A cube's faces are uploaded turned: OpenEXR shows each face from inside with up = +y (front: +z), OpenGL mirrored.
/// +-X and +-Z are flipped left to right, +-Y upside down; then texture(samplerCube, d) is the radiance from d.
class GpuEnvironment {
public:
    /// Enables GL_TEXTURE_CUBE_MAP_SEAMLESS (ES 3.0 has it always) and leaves it so: lookups across edges need it.
    /// Binds 0 to the target of the active unit and sets the unpack alignment to 1.
    /// \throws std::invalid_argument for no level, layouts that differ, sizes that don't halve as mip levels do,
    /// Unorm8;
    ///         StorageError for values that are not finite or don't fit the format; nacre::Error from the driver
    explicit GpuEnvironment(std::span<const EnvMap> levels, const GpuEnvironmentOptions& options = {});
    explicit GpuEnvironment(const EnvMap& map, const GpuEnvironmentOptions& options = {})
        : GpuEnvironment(std::span(&map, 1), options) {}

    EnvLayout layout() const { return layout_; }
    int size() const { return size_; }  ///< of level 0
    int levels() const { return levels_; }
    double scale() const { return scale_; }
    std::size_t bytes() const { return bytes_; }
    ShaderDefines defines() const { return layoutDefines(layout_); }
    /// "cube" or "map": what follows nacre_env_reflection_ and its like in the sampler's name.
    const char* samplerKind() const { return layout_ == EnvLayout::Cube ? "cube" : "map"; }
    /// Binds to texture unit `unit` and leaves that unit active.
    void bind(int unit) const;

private:
    TextureName texture_;
    EnvLayout layout_;
    int size_ = 0, levels_ = 0;
    double scale_ = 1;
    std::size_t bytes_ = 0;
};

/// A Fresnel table (N x 1 texels, 1 or 3 channels, mapping `sqrt_cos`) or one of scale and bias (2 channels, mapping
/// `cos_perceptual`).
class GpuEnvironmentTable {
public:
    /// \throws std::invalid_argument for another mapping or other channels
    explicit GpuEnvironmentTable(const AssetTexture& table);

    bool isFresnel() const { return fresnel_; }
    /// Binds to `unit` and sets nacre_env_table, _scale, _bias; leaves `program` in use.
    void bind(const Program& program, int unit) const;

private:
    bool fresnel_;
    Texture texture_;
    glm::vec4 scale_, bias_;
};

}  // namespace nacre
