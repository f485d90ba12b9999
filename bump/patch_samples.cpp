#include "bump/patch_samples.hpp"

#include "bump/scatter_plan.hpp"

namespace nacre {

Image PatchSamples::normals(const HeightMap& map) const {
    Image out((k + 1) * map.width(), (k + 1) * map.height(), 3);
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) {
            const PatchPlace u = of(x), v = of(y);
            const int i = static_cast<int>(u.corner), j = static_cast<int>(v.corner);
            const double a = map.at(i, j), b = map.at(i + 1, j), c = map.at(i, j + 1), d = map.at(i + 1, j + 1);
            if (std::isnan(a + b + c + d)) continue;
            const double alongX = (1 - v.share) * (b - a) + v.share * (d - c),
                         alongY = (1 - u.share) * (c - a) + u.share * (d - b);
            out.setRgb(x, y, glm::normalize(Vec3(-alongX, -alongY, 1)));
        }
    return out;
}

Image PatchSamples::lit(const HeightMap& map, const Vec3& light, unsigned threads) const {
    const HeightMap fine = refinedRelief(map, k);  // its texels' centres are the samples' places
    const Image mask = litMask(fine, light, threads);
    Image out((k + 1) * map.width(), (k + 1) * map.height(), 1);
    const auto fineIndex = [&](int texel, int count) {
        const PatchPlace place = of(texel);
        const int i = k * static_cast<int>(place.corner) + k / 2 + static_cast<int>(std::lround(k * place.share));
        return wrapIndex(i, count, map.wrap);
    };
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
            out.at(x, y, 0) = mask.at(fineIndex(x, fine.width()), fineIndex(y, fine.height()), 0);
    return out;
}

}  // namespace nacre
