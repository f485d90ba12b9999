// Where the fit of a separable form starts: decompositions of a BRDF tabulated over coarse grids of both arguments,
// weighted by the measure dμ = cosθi cosθo dωi dωo.
#pragma once

#include <functional>
#include <vector>

#include "core/math.hpp"
#include "factorize/log_table_fit.hpp"

namespace nacre {

/// A BRDF over texels of two square tables of edge² texels: value(x, y) at grid coordinates in [0,1]², and the square
/// roots of the measure of a row and of a column, whose product stands for that of the pair. Both > 0.
struct SeparableGrid {
    int edge = 16;
    std::function<Rgb(const glm::dvec2& x, const glm::dvec2& y)> value;
    std::function<double(const glm::dvec2& x)> rowWeight;
    std::function<double(const glm::dvec2& y)> columnWeight;
    unsigned threads = 0;
};

/// Tables U0, V0, U1, V1, … (RGB) with value ≈ Σ_k U_k(x) V_k(y): the leading singular pairs, channel after channel, of
/// the matrix with rows and columns multiplied by their weights, which makes its least squares those over dμ
/// (Kautz & McCool 1999, whose grid has no weights). O(terms edge⁴).
std::vector<FitTable> singularPairs(const SeparableGrid& grid, int terms);

/// `tables` tables (RGBA) with value ≈ Σ_t Σ_ch T_t,ch(x) T_t,ch(y) color_t,ch, symmetric in x and y for a symmetric
/// value: products a aᵀ with one colour each, of either sign, found one after the other (the best of what the earlier
/// ones left, by alternating between a and its colour) and shared by the three channels. O(tables edge⁴).
std::vector<FitTable> symmetricProducts(const SeparableGrid& grid, int tables);

}  // namespace nacre
