#include "core/parallel.hpp"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <vector>

namespace nacre {

void parallelFor(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& body) {
    if (threads == 1) {
        for (std::size_t i = 0; i < count; ++i) body(i);
        return;
    }
    // More threads than cores buy nothing, and TBB would complain about them on stderr.
    const int cores = tbb::info::default_concurrency();
    tbb::task_arena arena(threads == 0 ? cores : static_cast<int>(std::min<unsigned>(threads, cores)));
    arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, body); });
}

double parallelSum(std::size_t chunks, unsigned threads, const std::function<double(std::size_t)>& term) {
    std::vector<double> parts(chunks);
    parallelFor(chunks, threads, [&](std::size_t i) { parts[i] = term(i); });
    double sum = 0;
    for (double part : parts) sum += part;
    return sum;
}

}  // namespace nacre
