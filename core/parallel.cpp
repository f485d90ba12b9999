#include "core/parallel.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <vector>

namespace nacre {

void parallelFor(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& body) {
    if (threads == 1) {
        for (std::size_t i = 0; i < count; ++i) body(i);
        return;
    }
    tbb::task_arena arena(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads));
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
