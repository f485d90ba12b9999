#include "bench/bump_reliefs.hpp"

#include <cstdlib>
#include <random>

#include "bump/read_height.hpp"
#include "core/error.hpp"

namespace nacre::bench {

namespace fs = std::filesystem;

namespace {

/// Sum of smooth noise on lattices from a quarter of the map to single texels, each with half the amplitude; repeats.
void addFractal(HeightMap& map, double amplitude) {
    const int size = map.width();
    std::mt19937 generator(20);
    for (int cell = size / 4; cell >= 1; cell /= 2, amplitude /= 2) {
        const int nodes = size / cell;
        std::vector<double> lattice(static_cast<std::size_t>(nodes) * nodes);
        for (double& node : lattice) node = amplitude * (static_cast<double>(generator()) / 2147483648.0 - 1);
        const auto at = [&](int i, int j) { return lattice[static_cast<std::size_t>(j % nodes * nodes + i % nodes)]; };
        const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const int i = x / cell, j = y / cell;
                const double s = smooth(static_cast<double>(x % cell) / cell),
                             t = smooth(static_cast<double>(y % cell) / cell);
                map.heights.at(x, y, 0) += static_cast<float>((1 - t) * ((1 - s) * at(i, j) + s * at(i + 1, j)) +
                                                              t * ((1 - s) * at(i, j + 1) + s * at(i + 1, j + 1)));
            }
    }
}

}  // namespace

HeightMap syntheticRelief(int size) {
    require(size >= 64, "syntheticRelief: expected a size >= 64");
    HeightMap map{Image(size, size, 1), Wrap::Repeat};
    addFractal(map, size / 128.0);
    const double brick = 4, dome = size / 16.0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const int shifted = x + y / 32 % 2 * 32;
            if (y % 32 >= 4 && shifted % 64 >= 4) map.heights.at(x, y, 0) += static_cast<float>(brick);
            const double r = std::hypot(x - size / 2.0, y - size / 2.0) / (size / 5.0);
            if (r < 1) map.heights.at(x, y, 0) += static_cast<float>(dome * std::sqrt(1 - r * r));
        }
    return map;
}

ReliefList benchReliefs() {
    std::vector<fs::path> folders;
    if (const char* named = std::getenv("NACRE_HEIGHTS")) folders.emplace_back(named);
    folders.emplace_back("build/data/heights");
    return benchReliefs(folders);
}

ReliefList benchReliefs(const std::vector<fs::path>& folders) {
    ReliefList out;
    out.reliefs.push_back({"synthetic", syntheticRelief(256)});
    for (const std::string name : {"rockwall_height", "terrain-heightmap"}) {
        const auto folder = std::find_if(folders.begin(), folders.end(),
                                         [&](const fs::path& f) { return fs::is_regular_file(f / (name + ".bmp")); });
        if (folder == folders.end()) {
            out.notes.push_back(name + ".bmp is in no folder of height fields, so it isn't measured.");
            continue;
        }
        HeightField field = readHeight(*folder / (name + ".bmp"), {.scale = 25.6});
        out.reliefs.push_back({name, std::move(field.map)});
    }
    return out;
}

}  // namespace nacre::bench
