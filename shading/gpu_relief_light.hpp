// Indirect light in bump maps on the GPU (HSE section 3.2): a texture of the light that leaves a relief under one
// light, made by dependent lookups through its scatter map. The steps are those of bump/scattered_light.hpp.
#pragma once

#include <functional>
#include <optional>

#include "bump/scatter_plan.hpp"
#include "shading/gl_objects.hpp"
#include "shading/gpu_environment.hpp"
#include "shading/gpu_factored_brdf.hpp"
#include "shading/render_target.hpp"

namespace nacre {

struct GpuReliefLightOptions {
    Rgb albedo{0.7};
    Image albedoMap = {};  ///< RGB factor of `albedo`, of the relief's size; empty: 1
    Image normals = {};    ///< of the relief's size, unit; empty: those of surfaceSlopes
    /// f/albedo in the frame of the texel's normal, each path alone; none: Lambert, paths that meet. Outlives this.
    const GpuFactoredBrdf* brdf = nullptr;
    int bounces = 3;  ///< B ≥ 0
    int paths = 100;  ///< P ≥ 1
    int detail = 3;   ///< k odd: (k + 1)² samples a patch of the light that Lambert passes on
    ColorFormat color = ColorFormat::Rgba16F;
    unsigned threads = 0;  ///< of the baking on the CPU
};

/// The light of one update. Directions are the relief's: x along columns, y along rows, z up.
struct ReliefLamp {
    Vec3 light{0, 0, 1};                                 ///< unit, towards the light
    Rgb irradiance{1};                                   ///< of a surface that faces it
    std::function<Rgb(const Vec3& direction)> sky = {};  ///< radiance, or factor of `surrounding`; none: 0, or 1
    const GpuEnvironment* surrounding = nullptr;         ///< a cube: radiance from the sky; none: `sky` alone
    glm::mat3 toSurrounding{1};                          ///< turns the relief's directions to the surrounding's
    Vec3 viewer{0, 0, 1};                                ///< unit, for a BRDF
};

/// Needs rendering to 32-bit floats (ES 3: EXT_color_buffer_float). Half textures: distances, points, and with Rgba16F
/// the radiance too. Row 0 of the textures is row 0 of the relief; they wrap as it does and filter linearly. Lambert
/// costs 2 B draws with P·B lookups a texel in all (a mirrored relief's four tiles: all but the viewed bounce four
/// times), a sky one draw more for each 16 directions; a BRDF P (B + 1). Where the light is seen is found by rays on
/// the CPU, when the light changes its direction.
class GpuReliefLight {
public:
    /// \param scatter  of this map
    /// \throws std::invalid_argument for a bad map or option, nacre::Error when the driver refuses
    GpuReliefLight(ProgramLoader& loader, const HeightMap& map, const ScatterMap& scatter,
                   const GpuReliefLightOptions& options = {});

    /// Makes both results. Changes: program, textures of units 0 to 14 (0), framebuffer (0), viewport, vertex array
    /// (0); scissor, depth, blending and culling are off afterwards. \throws std::invalid_argument for directions that
    /// are not unit, or a surrounding that is no cube
    void update(const ReliefLamp& lamp);

    GlName scattered() const { return scattered_.name(); }  ///< radiance without direct light: sky and indirect
    GlName total() const { return total_.name(); }          ///< radiance
    /// A result, for checks: RGB. Leaves framebuffer 0 bound.
    Image read(GlName result) const;

private:
    void makeTextures(const HeightMap& map, const ScatterMap& scatter, const ScatterPlan& plan,
                      const GpuReliefLightOptions& options);
    const Program& prepare(const char* step, const ReliefLamp& lamp) const;
    void draw(const TextureName& to, int width, int height) const;
    void setDirections(const Program& program, const ReliefLamp& lamp, std::span<const int> directions,
                       std::span<const double> weights, const Vec2& side = Vec2(1)) const;
    void sumSky(const ReliefLamp& lamp, bool patches, const TextureName& to) const;
    void meet(const ReliefLamp& lamp);
    void follow(const ReliefLamp& lamp);

    ProgramLoader* loader_;
    HeightMap period_;
    int width_, height_, detail_, bounces_, paths_;
    int viewedPoints_ = 0, patchPoints_ = 0;  ///< of each texel, of each patch
    unsigned threads_;
    const GpuFactoredBrdf* brdf_;
    std::vector<Vec3> directions_;
    std::vector<double> weights_;
    std::optional<Vec3> litFor_;
    TextureName distances_, normals_, albedo_, slopes_, fineNormals_, lit_, leaves_, radiance_[2], sums_[2], scattered_,
        total_;
    struct Seen {
        TextureName points, own, sky;
    } viewed_, patch_;
    TextureName passedOn_[2];
    FramebufferName framebuffer_;
    VertexArray empty_;
};

}  // namespace nacre
