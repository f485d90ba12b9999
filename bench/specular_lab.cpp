#include "bench/specular_lab.hpp"

#include <epoxy/gl.h>

#include <chrono>

#include "shading/timing.hpp"

namespace nacre::bench {

SpecularLab::SpecularLab(ProgramLoader& loader, SceneDescription scene)
    : renderer_(loader, std::move(scene)), truths_(openTruths(renderer_.scene())) {}

Image SpecularLab::draw(const SceneSwitches& on, int size, int samples) {
    target_ = std::make_unique<RenderTarget>(RenderTargetOptions{.width = size, .height = size, .samples = samples});
    renderer_.switches = on;
    renderer_.render(*target_);
    target_->bind();
    points_.clear();
    for (int i = 0; i < samples; ++i) {
        float at[2] = {0.5f, 0.5f};
        if (samples > 1) glGetMultisamplefv(GL_SAMPLE_POSITION, static_cast<GLuint>(i), at);
        points_.emplace_back(at[0], 1 - at[1]);  // traced from the upper left
    }
    return target_->read();
}

double SpecularLab::frameSeconds(int repeats) {
    const std::function<void()> frame = [&] { renderer_.render(*target_); };
    return medianFrameSeconds({&frame, 1}, {.repeats = repeats}).front();
}

Image SpecularLab::trace(const SceneSwitches& on, int size, int spreadRays) {
    SceneTraceOptions options{.width = size, .height = size};
    options.points = points_;
    options.specularDepth = on.specular.depth;
    options.lightDepth = on.specular.lightDepth;
    options.spreadRays = spreadRays;
    options.lightPoints = 64;
    const SceneDescription& scene = renderer_.scene();
    const auto begin = std::chrono::steady_clock::now();
    Image out = traceScene(scene, scene.camera, truths_, {{}}, options).front();
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return out;
}

}  // namespace nacre::bench
