#include "bench/environment_maps.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "core/error.hpp"
#include "core/image_file.hpp"
#include "envmaps/convert.hpp"

namespace nacre::bench {

namespace fs = std::filesystem;

EnvMap syntheticSurrounding(int size) {
    EnvMap map(EnvLayout::LatLong, size);
    double sum = 0;
    const auto radiance = [](const Vec3& d) {
        const double up = std::max(0.0, d.y), ripple = 0.5 + 0.5 * std::sin(23 * d.x + 9 * std::sin(17 * d.z));
        if (d.y < 0) return Rgb(0.3, 0.24, 0.17) * (0.6 + 0.4 * ripple);
        if (d.z < -0.8 && std::abs(d.x) < 0.2 && std::abs(d.y - 0.35) < 0.1) return Rgb(40, 36, 30);  // a lamp
        return Rgb(0.35, 0.55, 1.0) * (0.3 + 0.7 * (1 - up) * (1 - up)) + Rgb(0.15 * ripple);
    };
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < 2 * size; ++x) {
            const Rgb value = radiance(envTexelDirection(EnvLayout::LatLong, size, x, y));
            map.image.setRgb(x, y, value);
            sum += mean(value);
        }
    const glm::dvec2 sun = envPosition(EnvLayout::LatLong, size, glm::normalize(Vec3(0.5, 0.6, 0.4)));
    map.image.setRgb(static_cast<int>(sun.x), static_cast<int>(sun.y),
                     Rgb(1, 0.9, 0.7) * (26000 * sum / (2.0 * size * size)));
    return map;
}

/// Negative and non-finite values set to 0; returns how many there were.
static std::size_t mend(Image& image) {
    std::size_t mended = 0;
    for (float& v : image.data())
        if (!std::isfinite(v) || v < 0) v = 0, ++mended;
    return mended;
}

static Image threeChannels(const Image& image) {
    Image out(image.width(), image.height(), 3);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (int c = 0; c < 3; ++c) out.at(x, y, c) = image.at(x, y, image.channels() < 3 ? 0 : c);
    return out;
}

SurroundingList benchSurroundings() {
    std::vector<fs::path> folders;
    if (const char* named = std::getenv("NACRE_ENVIRONMENTS")) folders.emplace_back(named);
    folders.emplace_back("build/data/environments");
    folders.emplace_back("build/data/world");  // where demos/fetch.sh puts the gallery's
    folders.emplace_back("/usr/share/blender/datafiles/studiolights/world");
    return benchSurroundings(folders);
}

SurroundingList benchSurroundings(const std::vector<fs::path>& folders) {
    SurroundingList out;
    out.surroundings.push_back({kSyntheticName, syntheticSurrounding()});
    for (const std::string name : {"forest", "studio", "city"}) {
        const auto folder = std::find_if(folders.begin(), folders.end(),
                                         [&](const fs::path& f) { return fs::is_regular_file(f / (name + ".exr")); });
        if (folder == folders.end()) {
            out.notes.push_back(name + ".exr is in no folder of environments, so it isn't measured.");
            continue;
        }
        Image image = threeChannels(readImageFile(*folder / (name + ".exr")).image);
        if (const std::size_t mended = mend(image))
            out.notes.push_back(fmt::format("{}: {} negative or non-finite values set to 0.", name, mended));
        out.surroundings.push_back({name, EnvMap(EnvLayout::LatLong, std::move(image))});
    }
    return out;
}

EnvMap asCube(const BenchSurrounding& surrounding, int size) {
    return convertEnv(surrounding.map, EnvLayout::Cube, size);
}

}  // namespace nacre::bench
