#include "bench/bump_gpu.hpp"

#include "core/directions.hpp"
#include "factorize/models/models.hpp"
#include "shading/primitives.hpp"
#include "shading/timing.hpp"

namespace nacre::bench {

BumpCost bumpCost(ProgramLoader& loader, const GpuBump& map, const BumpFrame& frame) {
    const RenderTarget target({.width = frame.pixels, .height = frame.pixels});
    const GpuMesh mesh(makeQuad());
    const GpuDirectBrdf brdf =
        directBrdf(makeModel("torrance-sparrow:d=beckmann,g=smith,alpha=0.2,f=dielectric")).value();
    LitView view;
    view.camera.orthographic = true;
    for (int i = 0; i < frame.lights; ++i)
        view.lights.push_back({true, sphericalDirection(0.9 + 0.1 * i, 1.3 * i), Rgb(1.0 / frame.lights)});
    std::vector<std::function<void()>> frames{[&] { target.clear(), renderDirect(loader, target, mesh, view, brdf); }};
    for (const BumpShadow shadow :
         {BumpShadow::None, BumpShadow::HardEllipse, BumpShadow::Ellipse, BumpShadow::HardHorizon, BumpShadow::Horizon})
        if (map.has(shadow))
            frames.push_back([&, shadow] {
                target.clear();
                renderDirect(loader, target, mesh, view, brdf,
                             BumpSurface{.map = &map, .shadow = shadow, .tiles = Vec2(frame.tiles)});
            });
    const std::vector<double> seconds = medianFrameSeconds(frames, {.repeats = frame.repeats});
    BumpCost out;
    out.plainMs = 1000 * seconds[1];
    out.smooth = seconds[0] / seconds[1];
    std::size_t next = 2;
    const auto ratio = [&](BumpShadow shadow) { return map.has(shadow) ? seconds[next++] / seconds[1] : 0; };
    out.hardEllipse = ratio(BumpShadow::HardEllipse);
    out.ellipse = ratio(BumpShadow::Ellipse);
    out.hardHorizon = ratio(BumpShadow::HardHorizon);
    out.horizon = ratio(BumpShadow::Horizon);
    return out;
}

}  // namespace nacre::bench
