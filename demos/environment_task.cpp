#include "demos/environment_task.hpp"

#include "demos/recipe.hpp"

namespace nacre {

Surrounding Task::open(const std::string& name) const {
    Surrounding s = openSurrounding(name, options.worldFolder);
    if (!s.note.empty()) notes.push_back(id + ": " + s.note);
    return s;
}

std::vector<Rgb> shade(const Body& body, const SurroundedSurface& surface, const EnvMap& sky) {
    return shadeSurrounded(body.traced, surface, [&](const Vec3& d) { return sampleEnv(sky, d); });
}

std::vector<std::string> envmapCommands(const Surrounding& s, const std::vector<std::string>& rest) {
    std::vector<std::string> out;
    if (!s.file.empty())
        for (const std::string& r : rest) out.push_back("nacre envmap " + shellQuoted(s.file) + " -o " + r);
    return out;
}

}  // namespace nacre
