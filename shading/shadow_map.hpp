// Shadow maps: linear depth from a light, drawn on the GPU, looked up in the pass that lights (LitView::shadows).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/shadow_view.hpp"
#include "shading/gl_objects.hpp"
#include "shading/gpu_mesh.hpp"
#include "shading/program.hpp"
#include "shading/render_target.hpp"
#include "shading/volume_surface.hpp"

namespace nacre {

struct ShadowCaster {
    const GpuMesh* mesh = nullptr;
    glm::dmat4 toWorld{1};
};

/// What a map is drawn from. bounds holds casters and receivers; camera and aspect (width / height) fit cascades.
struct ShadowScene {
    std::vector<ShadowCaster> casters;
    Bounds bounds;
    const Camera* camera = nullptr;
    double aspect = 1;
    std::vector<VolumeSurface> volumes{};  ///< cast the hull of their inside, whatever `faces` says
};

/// The maps of one light: an array texture with the layers of ShadowView, as columns of four rows that overlap by two
/// (shaders/nacre/shadow.glsl): RGBA32UI with the bits of floats, or RGBA16UI with codes k/65535. OpenGL ES 3 renders
/// to both without extensions (to R32F and R16 it doesn't), and one fetch brings what a filter of three needs of a
/// column. A layer is drawn into a depth texture of 32 bits, which the fragments give linear depth, and stored from
/// there. Cost: a draw of every caster a layer. 8 or 4 bytes a texel, and 4 bytes a texel of one layer to draw into.
class ShadowMap {
public:
    /// Nothing is drawn, and nothing looked up, before update().
    explicit ShadowMap(const SceneShadow& options = {}) : options_(options) {}

    /// Fits the view to light and scene (fitShadow) and draws. Leaves framebuffer 0 bound, the viewport the map's,
    /// depth test LESS and depth write on, culling and blending off, front faces counter-clockwise.
    /// DualParaboloid: edges of triangles are straight in the map, where true ones are arcs of circles no smaller than
    /// the horizon: a chord of c horizon radii is off by up to c²/8 of them, a texel of 1024 for edges of 7° to 14°.
    /// Split longer ones. Depths are those of the triangles' planes at each texel's ray, long or short.
    /// A volume is drawn as its method says: slices perpendicular to the layer's axis, which see the surface up to a
    /// step (times the ray's length over the axis) late, or a march along each texel's ray. DualParaboloid always
    /// marches: slices have the longest edges of all. \throws std::invalid_argument as fitShadow and checkVolume say,
    /// for null casters; nacre::Error from the driver
    void update(ProgramLoader& loader, const Light& light, const ShadowScene& scene);

    bool drawn() const { return texture_.has_value(); }
    const SceneShadow& options() const { return options_; }
    const ShadowView& view() const { return view_; }
    std::size_t bytes() const;  ///< of the layers
    /// The layers for shadowLit. Desktop OpenGL only.
    std::vector<Image> download() const;

private:
    friend void bindShadows(const Program&, std::span<const ShadowMap* const>, int);
    void allocate(int layers);
    void store(const Program& program, int layer) const;  ///< the depth texture, as blocks
    SceneShadow options_;
    ShadowView view_;
    int layers_ = 0;
    std::optional<TextureName> texture_, depth_;
    std::optional<FramebufferName> drawn_, stored_;
};

inline constexpr int kMaxShadows = 8;  ///< each takes a sampler; OpenGL ES promises 16 a program, all textures together

/// What a program must be loaded with; nothing when all are null or none is given. \param shadows  one a light
/// \throws std::invalid_argument unless there are none or as many as lights, for a map not drawn yet, and for a map of
///         another kind of light
ShaderDefines shadowDefines(std::span<const ShadowMap* const> shadows, std::span<const Light> lights);
/// The same of the maps' views, without a GPU.
ShaderDefines shadowDefines(std::span<const ShadowView* const> views);
/// Binds light i's map to unit firstUnit + i and sets the uniforms of bind/shadows.glsl; leaves `program` in use.
void bindShadows(const Program& program, std::span<const ShadowMap* const> shadows, int firstUnit);

/// The share of the light that the map leaves to each visible point, grey; state as renderFactored's. For masks,
/// overlays, measurements.
void renderShadowMask(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const Camera& camera,
                      const ShadowMap& shadow, const glm::dmat4& toWorld = glm::dmat4(1));

}  // namespace nacre
