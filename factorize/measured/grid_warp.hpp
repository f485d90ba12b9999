// Bilinear functions on the unit square in slices over (phi_i, theta_i), and the warp that sends points distributed
// like such a function to uniform ones (Dupuy & Jakob 2018, section 4: the adaptive parameterisation).
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/math.hpp"

namespace nacre {

/// Up to four slices and their weights, which sum to 1.
struct SliceBlend {
    std::array<std::size_t, 4> slice{};
    std::array<float, 4> weight{};
    int count = 0;
};

/// Linear weights between neighbours of sorted axes, constant beyond their ends; slices are [first axis][second axis].
SliceBlend blendSlices(const std::vector<float>& first, const std::vector<float>& second, double atFirst,
                       double atSecond);

/// width × height values a slice at the vertices of a regular grid, (0,0) to (1,1) inclusive; x runs fastest.
/// width, height ≥ 2.
struct SlicedGrid {
    std::size_t width = 0, height = 0;
    std::vector<float> values;
};

/// Value at a point of [0,1]² in a single slice.
double interpolate(const SlicedGrid& grid, std::size_t slice, const Vec2& at);

/// Integrals of a grid, per slice normalised to a total of 1.
struct GridWarp {
    SlicedGrid density;            ///< normalised: mean over the slice's square is 1 · (width-1)(height-1)
    std::vector<float> rowCdf;     ///< like density: ∫ along x from 0 to the vertex, at the height of its row
    std::vector<float> columnCdf;  ///< height a slice: ∫∫ below the row
    std::optional<std::size_t> emptySlice;
};

/// O(values). When a slice's total is not positive, the rest is left undone and `emptySlice` says which.
GridWarp makeGridWarp(SlicedGrid grid);

/// The uniform point u that the density's sampling sends to `at`: u.y = P(Y < at.y), u.x = P(X < at.x | Y = at.y), with
/// the blended density. (u.x is 0 where that row has no density.)
Vec2 toUniform(const GridWarp& warp, const SliceBlend& blend, const Vec2& at);

}  // namespace nacre
