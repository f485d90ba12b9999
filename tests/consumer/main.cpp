// An application: a baked BRDF on a torus, rendered without a window. consumer ASSET.exr PICTURE.png
#include <shading/context.hpp>
#include <shading/image_output.hpp>
#include <shading/lit_pass.hpp>
#include <shading/primitives.hpp>

int main(int, char** argv) {
    const nacre::Context context;
    nacre::ProgramLoader loader;
    const nacre::GpuFactoredBrdf brdf(nacre::factoredFromAsset(nacre::readAsset(argv[1]), argv[1]));
    nacre::LitView view;
    view.camera.eye = {0, 2.5, 4.5};
    view.lights = {nacre::Light{true, {0.6, 0.8, 0}, nacre::Rgb(3)}};
    const nacre::RenderTarget target({.width = 256, .height = 256, .samples = 4});
    target.clear();
    nacre::renderFactored(loader, target, nacre::GpuMesh(nacre::makeTorus()), view, brdf);
    nacre::writePng(target.read(), argv[2]);
}
