#include "demos/exhibit_task.hpp"

#include <fmt/format.h>

#include "demos/recipe.hpp"

namespace nacre {

Surrounding Task::open(const std::string& name) const {
    Surrounding s = openSurrounding(name, options.worldFolder);
    if (!s.note.empty()) notes.push_back(id + ": " + s.note);
    return s;
}

ReliefSource Task::openHeights(const std::string& name, double scale) const {
    ReliefSource s = openRelief(name, options.heightFolder, scale);
    if (!s.note.empty()) notes.push_back(id + ": " + s.note);
    return s;
}

std::vector<Rgb> shade(const Body& body, const SurroundedSurface& surface, const EnvMap& sky) {
    return shadeSurrounded(body.traced, surface, [&](const Vec3& d) { return sampleEnv(sky, d); });
}

std::vector<std::string> envmapCommands(const Surrounding& s, int coarseSize, const std::vector<std::string>& filters) {
    if (s.file.empty()) return {};
    const std::string name = std::filesystem::path(s.file).stem().string(),
                      coarse = fmt::format("{}-{}.exr", name, coarseSize);
    std::vector<std::string> out{fmt::format("nacre envmap {} -o {} --convert --layout cube --size {}",
                                             shellQuoted(s.file), coarse, coarseSize)};
    for (const std::string& filter : filters) out.push_back(fmt::format("nacre envmap {} -o {}", coarse, filter));
    return out;
}

}  // namespace nacre
