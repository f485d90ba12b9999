#include "demos/shadow_verdict.hpp"

#include "core/error.hpp"

namespace nacre {

Image verdictPicture(const Image& truth, const Image& verdict, double white) {
    require(truth.width() == verdict.width() && truth.height() == verdict.height(),
            "verdictPicture: expected truth and verdict of one size");
    const Rgb colors[] = {Rgb(0), {1, 0.05, 0.02}, {0.05, 0.2, 1}, {1, 0.75, 0}};
    Image out(truth.width(), truth.height(), 3);
    for (int y = 0; y < truth.height(); ++y)
        for (int x = 0; x < truth.width(); ++x) {
            const auto kind = static_cast<std::size_t>(verdict.at(x, y, 0));
            out.setRgb(x, y, white * (kind > 0 ? colors[kind] : Rgb(0.03 + 0.3 * truth.at(x, y, 0))));
        }
    return out;
}

}  // namespace nacre
