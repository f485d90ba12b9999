// The reliefs that exhibits show: height fields that fetch.sh took from a Debian package, or made-up cobbles; and what
// light they send to the eye, exactly.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "bump/height_map.hpp"
#include "reference/raytrace.hpp"
#include "reference/relief_rays.hpp"

namespace nacre {

struct ReliefSource {
    HeightMap map;      ///< repeats
    std::string file;   ///< what a command line names; empty for the made-up cobbles
    std::string words;  ///< for a reader
    std::string note;   ///< not empty when the cobbles stand in
};

/// NAME.bmp in `folder`, black to white rising by `scale` texels; when it isn't there, cobbles.
/// \throws nacre::Error when it is there but broken
ReliefSource openRelief(const std::string& name, const std::filesystem::path& folder, double scale);

/// Rows of rounded stones with gaps between, size² texels, rising by `scale` texels; repeats.
HeightMap cobbles(int size, double scale);

/// What a point of a mesh with a relief on it sends to the eye, one radiance a sample of `traced`: at uv · tiles the
/// patch's own normal, lights that the horizon doesn't hide (exact rays, over a plane: the relief is small against the
/// mesh's curvature), f in the bumped frame. `extra` is added: per point of the relief [texels].
struct ReliefShading {
    std::vector<Light> lights;  ///< directional
    std::function<Rgb(const Vec3& wi, const Vec3& wo)> brdf;
    Vec2 tiles{1};
    bool shadows = true;
    std::function<Rgb(const Vec2& p)> extra{};
};
std::vector<Rgb> shadeRelief(const TracedSurface& traced, const HeightMap& map, const ReliefShading& shading);

}  // namespace nacre
