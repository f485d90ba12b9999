// Shadows of a scene's lights as levels of each pixel, found before the light is drawn: soft ones from points of the
// lights' areas, by counted volumes or by maps, whichever is faster (HYBRID section 4.1).
#pragma once

#include "shading/hybrid/counted_shadows.hpp"
#include "shading/hybrid/mapped_shadows.hpp"

namespace nacre {

/// Fastest: of those two whose levels are near enough to what rays say, the one that takes less time; the better one
/// when none is. Both are drawn in the first frame, and rays followed from 4096 of its pixels; again when nodes moved.
enum class SampledShadowMethod { Maps, Volumes, Fastest };

struct SampledShadowOptions {
    SampledShadowMethod method = SampledShadowMethod::Fastest;
    int points = 16;  ///< of an area, 1 to MappedShadows::kMostPoints; lights without one have one
    ShadowFilter filter = ShadowFilter::EdgeStopping;  ///< of lights with an area
    MappedShadowOptions maps{};
    double leastPsnr = 35;  ///< Fastest: that is near enough [dB]
};

/// What Fastest was chosen by. Of one frame's shadows of all lights.
struct SampledShadowChoice {
    SampledShadowMethod taken = SampledShadowMethod::Fastest;  ///< Maps or Volumes
    double mapSeconds = 0, volumeSeconds = 0;                  ///< without compiling programs
    /// Against rays to 256 points of each area: of levels times the cosine at which the light arrives [dB]; infinity:
    /// no difference.
    double mapPsnr = 0, volumePsnr = 0;
};

const char* nameOf(SampledShadowMethod method);

/// Levels of all lights, as one array texture for SceneSwitches::lightLevels. Directions have counted volumes.
class SampledShadows {
public:
    /// \param scene  outlives this
    SampledShadows(ProgramLoader& loader, const SceneDescription& scene) : loader_(loader), scene_(scene) {}

    /// Draws the levels of each light with a shadow; of others they are 0. \param geometry  drawn with `camera`; nodes:
    /// nodeTransforms' result. \return  a layer a light, until the next call
    /// \throws as MappedShadows::add and CountedShadows; std::invalid_argument for points < 1; nacre::Error for nodes
    /// with volumes
    GlName draw(const GeometryBuffer& geometry, const Camera& camera, const std::vector<glm::dmat4>& nodes,
                const SampledShadowOptions& options);
    /// Of the last frame; the figures only with Fastest.
    const SampledShadowChoice& choice() const { return choice_; }

private:
    void follow(const std::vector<glm::dmat4>& nodes);
    void allocate(int width, int height);
    void drawBy(SampledShadowMethod method, const GeometryBuffer& geometry, const Camera& camera,
                const SampledShadowOptions& options);
    double timed(SampledShadowMethod method, const GeometryBuffer& geometry, const Camera& camera,
                 const SampledShadowOptions& options);
    std::vector<float> read() const;

    ProgramLoader& loader_;
    const SceneDescription& scene_;
    std::vector<glm::dmat4> nodes_;  ///< of which the casters are
    std::optional<MappedShadows> maps_;
    std::optional<CountedShadows> volumes_;
    int width_ = 0, height_ = 0;
    std::optional<TextureName> layers_;
    std::vector<FramebufferName> framebuffers_;  ///< one a layer
    std::optional<ShadowLevels> sums_;
    SampledShadowChoice choice_;
    bool chosen_ = false;
};

}  // namespace nacre
