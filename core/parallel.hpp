// Deterministic parallel loops: task i writes element i, so results do not depend on the number of threads.
#pragma once

#include <cstddef>
#include <functional>

namespace nacre {

/// Calls body(i) for i in [0, count), each once, in any order. The body must not throw and must write only what belongs
/// to i; sums are kept per i and combined in index order by the caller.
/// \param threads  0 = all cores, 1 = in order on this thread
void parallelFor(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& body);

/// Σ term(chunk) over `chunks` chunks, computed in parallel and added in chunk order: same bits for any thread count.
double parallelSum(std::size_t chunks, unsigned threads, const std::function<double(std::size_t)>& term);

}  // namespace nacre
