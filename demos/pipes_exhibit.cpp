// HYBRID figure 11: what each of several pipes draws, and that their sum is the picture of one.
#include <fmt/format.h>

#include <chrono>

#include "demos/exhibit_builder.hpp"
#include "demos/exhibit_task.hpp"
#include "shading/scene_file.hpp"
#include "shading/scene_renderer.hpp"

namespace nacre {

Exhibit pipesExhibit(const Task& task) {
    constexpr int kPipes = 4;
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    SceneRenderer renderer(task.loader, readScene(task.options.sceneFolder / "soft.json"));
    renderer.switches.shadowMethod = ShadowMethod::Volumes;
    const int size = task.size(240);
    const RenderTarget target({.width = size, .height = size});
    const auto drawn = [&](const DrawShare& share) {
        renderer.switches.share = share;
        renderer.render(target);
        return target.read();
    };
    const Image one = drawn({});
    Image sum(size, size, 3);
    const auto begin = std::chrono::steady_clock::now();
    builder.row("What each of four pipes draws: four of the lamp's 16 points, and the first also what can't be shared");
    for (int pipe = 0; pipe < kPipes; ++pipe) {
        Image part = drawn(DrawShare::equal(pipe, kPipes));
        for (std::size_t i = 0; i < part.data().size(); ++i) sum.data()[i] += part.data()[i];
        builder.picture(fmt::format("pipe {}", pipe + 1), std::move(part));
    }
    builder.row("Their sum, beside the picture of one pipe");
    const std::chrono::duration<double> all = std::chrono::steady_clock::now() - begin;
    builder.compared("four pipes, one after the other", std::move(sum), one, 1000 * all.count());
    Exhibit e;
    e.table.head = {"the paper's table 2", "pipes", "shadow", "indirect", "direct", "specular", "composite", "seconds"};
    e.table.rows = {{"office", "2", "65.4 %", "20.0 %", "6.3 %", "2.7 %", "4.2 %", "0.404"},
                    {"office", "4", "46.7 %", "26.6 %", "9.9 %", "3.1 %", "11.3 %", "0.263"},
                    {"office", "8", "28.2 %", "28.0 %", "11.4 %", "4.1 %", "25.8 %", "0.209"},
                    {"classroom", "4", "80.2 %", "6.3 %", "2.6 %", "2.4 %", "7.4 %", "0.437"},
                    {"classroom", "8", "61.2 %", "10.6 %", "4.5 %", "4.0 %", "18.1 %", "0.249"}};
    e.section = "Hybrid rendering";
    e.title = "Several pipes draw one picture";
    e.caption =
        "HYBRID figure 11. Pipes share the lamp's points and the virtual lights; their images are added, by binary "
        "swap "
        "or in software. ./dev bench prints the same table for 1, 2, 4 and 8 pipes of this machine beside the paper's, "
        "whose seconds are those with compositing in software.";
    e.scene = "demos/scenes/soft.json; square lamp of 16 points, shadows by volumes.";
    e.commands = {
        "nacre render demos/scenes/soft.json -o soft.png --shadows volumes --indirect virtual-lights --pipes 4",
        "./dev bench --techniques hybrid"};
    builder.finish(e);
    return e;
}

}  // namespace nacre
