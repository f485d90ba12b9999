// A scene that is drawn by passes and traced, timed.
#pragma once

#include "core/image.hpp"
#include "reference/scene_trace.hpp"
#include "shading/scene_renderer.hpp"

namespace nacre::bench {

class SpecularLab {
public:
    SpecularLab(ProgramLoader& loader, SceneDescription scene);

    /// One sample in each pixel's middle, or as many as the driver takes.
    Image draw(const SceneSwitches& on, int size, int samples = 1);
    double frameSeconds(int repeats);  ///< of the last picture drawn, median
    /// The same points with the depths of `on`. \param spreadRays  of a ray at a frosted face
    Image trace(const SceneSwitches& on, int size, int spreadRays = 16);
    double traceSeconds() const { return seconds_; }  ///< of the last trace
    const SceneRenderer& renderer() const { return renderer_; }

private:
    SceneRenderer renderer_;
    SceneTruths truths_;
    std::unique_ptr<RenderTarget> target_;
    std::vector<Vec2> points_;  ///< of a pixel's samples
    double seconds_ = 0;
};

}  // namespace nacre::bench
