#include "core/parallel.hpp"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <vector>

namespace nacre {

void parallelFor(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& body) {
    if (threads == 1) {
        for (std::size_t i = 0; i < count; ++i) body(i);
        return;
    }
    // More threads than cores buy nothing, and TBB would complain about them on stderr. An arena of its own costs a
    // loop tens of microseconds: only fewer threads need one. Isolated, a thread that waits takes up no other loop's
    // task.
    if (threads == 0 || threads >= static_cast<unsigned>(tbb::info::default_concurrency())) {
        tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, count, body); });
        return;
    }
    tbb::task_arena arena(static_cast<int>(threads));
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
