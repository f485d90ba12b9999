// Partial images of pipes into one that is their sum (HYBRID section 4.4).
#pragma once

#include <span>
#include <vector>

#include "core/image.hpp"
#include "shading/hybrid/pipe_link.hpp"
#include "shading/program.hpp"
#include "shading/render_target.hpp"

namespace nacre {

/// Rows of a target, from the lowest on.
struct ImageRows {
    int first = 0, count = 0;
};

/// The targets' pixels in these rows, four floats each, one target after the other. All are of one size.
std::vector<float> readRows(std::span<const RenderTarget* const> targets, ImageRows rows);

/// Rows that pipe `index` of `count` holds after all rounds of halves: none beyond the power of two in count.
/// \param height  of the image
ImageRows rowsAfterSwap(int height, int index, int count);

/// Hierarchical binary swap (Ma et al. 1994): in each round a pipe gives one half of its rows to a partner, whose half
/// of the others its pipeline adds to its own; log2 rounds leave each with the sum of all in a part of the rows. Where
/// the pipes aren't a power of two, those beyond one give their image to one of the first before.
/// \param pipes  that take part, in rising order, this one among them
/// \return whether no partner was lost: then rowsAfterSwap's rows are the sum. With one lost, the rounds go on, so that
///         the others needn't wait
bool binarySwap(ProgramLoader& loader, PipeLink& link, std::span<const int> pipes,
                std::span<const RenderTarget* const> targets, PipeClock::time_point deadline);

/// Σ over images of readRows' form, in order. O(images · floats) \param threads  0 = all cores
void addImages(std::vector<float>& sum, std::span<const std::vector<float>> images, unsigned threads = 0);

/// Four channels, row 0 on top. \param pixels  of all rows, from the lowest on
Image imageOf(std::span<const float> pixels, int width, int height);

}  // namespace nacre
