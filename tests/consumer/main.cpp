// An application: a baked BRDF on a torus, rendered without a window. consumer ASSET.exr PICTURE.png
#include <shading/context.hpp>
#include <shading/image_output.hpp>
#include <shading/lit_pass.hpp>
#include <shading/primitives.hpp>

#include <cstdio>

static void render(const char* asset, const char* picture) {
    const nacre::Context context;
    nacre::ProgramLoader loader;
    const nacre::GpuFactoredBrdf brdf(nacre::factoredFromAsset(nacre::readAsset(asset), asset));
    nacre::LitView view;
    view.camera.eye = {0, 2.5, 4.5};
    view.lights = {nacre::Light{true, {0.6, 0.8, 0}, nacre::Rgb(3)}};
    const nacre::RenderTarget target({.width = 256, .height = 256, .samples = 4});
    target.clear();
    nacre::renderFactored(loader, target, nacre::GpuMesh(nacre::makeTorus()), view, brdf);
    nacre::writePng(target.read(), picture);
}

int main(int argc, char** argv) try {
    if (argc != 3) return std::fprintf(stderr, "usage: consumer ASSET.exr PICTURE.png\n"), 2;
    render(argv[1], argv[2]);
} catch (const std::exception& error) {  // a missing file, a driver that can't
    return std::fprintf(stderr, "consumer: %s\n", error.what()), 1;
}
