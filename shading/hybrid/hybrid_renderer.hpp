// A scene in stages (HYBRID figure 10): direct light by the scene renderer, what surfaces reflect once by virtual
// lights, and specular pixels by rays on the CPU, at the same time.
#pragma once

#include <future>

#include "shading/hybrid/indirect_pass.hpp"
#include "shading/hybrid/pipe_crew.hpp"
#include "shading/hybrid/reflected_power.hpp"
#include "shading/hybrid/sampled_shadows.hpp"
#include "shading/hybrid/traced_pixels.hpp"
#include "shading/scene_renderer.hpp"

namespace nacre {

struct VirtualLightOptions {
    int count = 64;  ///< at most; the paper has 8 a graphics pipe
    VirtualLightChoice choice = VirtualLightChoice::Grouped;
    bool shadows = false;  ///< maps of shadowSize² texels each; without, light leaks through walls (HYBRID figure 8)
    int shadowSize = 128;
    ElementOptions elements{32768};  ///< whose power is found
    int shadowElements = 4096;       ///< that shadow maps are drawn from, at least: paraboloids bend what is large
    ReflectedPowerOptions power{};
    NearLight near = NearLight::Rectangle;
};

struct HybridOptions {
    std::optional<VirtualLightOptions> virtualLights{};  ///< none: no indirect light
    std::optional<SampledShadowOptions> shadows{};       ///< none: as direct().switches say
    bool traced = false;  ///< specular pixels, to the depth of direct().switches; else they are black
};

/// How materials reflect, one each: what virtual lights and rays know of them.
struct HybridMaterials {
    std::vector<Rgb> albedos;         ///< of diffuse reflection, in [0, 1]
    std::vector<BrdfFunction> brdfs;  ///< of all; empty: black
};

/// What the stages took and left.
struct HybridReport {
    std::size_t elements = 0, lights = 0;
    double leftOut = 0;             ///< share of the reflected power that has no virtual light
    SampledShadowChoice shadows{};  ///< with sampled ones
    double clamped = 0;             ///< share of points' light in the picture that a bounded singularity took away
    TracedReport traced{};
    std::vector<PassTime> stages;  ///< wall seconds between two glFinish; gpuSeconds isn't measured
    double shadowSeconds = 0;      ///< of the direct stage: making and counting volumes, and the light outside them
    std::vector<double> pipes;     ///< seconds that each drew; below 0: its part is lacking; NaN: it had none
};

/// Images of three channels, the size that was asked for. What wasn't asked for is black.
struct HybridPicture {
    Image direct, indirect, traced, blended;
};

struct HybridFrame {
    HybridPicture picture;
    HybridReport report;
};

/// The context that was current in the constructor must be current in every call.
class HybridRenderer {
public:
    /// \param loader  outlives this
    /// \throws as SceneRenderer; std::invalid_argument for another number of albedos or BRDFs
    HybridRenderer(ProgramLoader& loader, SceneDescription scene, HybridMaterials materials);

    const SceneDescription& scene() const { return scene_; }
    /// Draws direct light, of the scene with specular surfaces black: curved ones are welcome.
    SceneRenderer& direct() { return direct_; }

    /// All stages of the scene as it stands at `time`. Rays are followed in a thread of their own while the rest is
    /// drawn. \throws as sceneElements, chooseVirtualLights and SpecularTracer; std::invalid_argument for sizes < 1
    HybridPicture draw(int width, int height, const HybridOptions& options, double time = 0);
    /// The same by a crew's pipes, in the leader; the others call drawShare. Returns when everything is drawn: what
    /// ends the frame on the CPU runs in a thread of its own, and may be waited for after the next frame was started.
    /// \param crew  begun, outlives the frame
    std::future<HybridFrame> start(int width, int height, const HybridOptions& options, double time, PipeCrew& crew);
    /// One of the other pipes' part. \param options, width, height  the leader's
    void drawShare(int width, int height, const HybridOptions& options, double time, PipeCrew& crew);
    /// Of the last picture.
    const HybridReport& report() const { return report_; }
    const std::vector<VirtualPointLight>& virtualLights() const { return lights_.lights; }

private:
    struct Drawing;
    void stage(const char* name, const std::function<void()>& work);
    void placeVirtualLights(const VirtualLightOptions& options, const std::vector<glm::dmat4>& nodes, PipeCrew* crew);
    void drawShadowMaps(const VirtualLightOptions& options, const std::vector<glm::dmat4>& nodes,
                        std::span<const VirtualPointLight> lights);
    void drawLight(const Drawing& drawing, const DrawShare& share);
    std::function<CompositedFrame()> drawAll(Drawing& drawing, PipeCrew* crew);
    static HybridFrame finish(Drawing& drawing, const CompositedFrame& composited);
    TracedLight lightOfEnds(const HybridOptions& options, const std::vector<glm::dmat4>& nodes) const;

    ProgramLoader& loader_;
    SceneDescription scene_;
    HybridMaterials materials_;
    SceneRenderer direct_;
    std::map<int, GpuMesh> meshes_;
    VirtualLights lights_;
    std::optional<VirtualShadows> shadows_;
    SampledShadows sampled_;
    HybridReport report_;
};

/// The same scene with black, opaque surfaces where it has specular ones.
SceneDescription withoutSpecular(SceneDescription scene);

/// Share of the light in a picture that addVirtualLights drew alone, four channels on black, which the bound of the
/// singularity took away: Σ alpha / Σ (alpha + luminance). 0 without light.
double clampedShare(const Image& indirect);

}  // namespace nacre
