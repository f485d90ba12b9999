// Parallel loops visit each index once, and sums have the same bits for any number of threads.
#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>
#include <vector>

namespace nacre {
namespace {

TEST(ParallelFor, EachIndexOnce) {
    for (const unsigned threads : {0u, 1u, 2u, 7u}) {
        std::vector<int> visits(10007);
        parallelFor(visits.size(), threads, [&](std::size_t i) { ++visits[i]; });
        EXPECT_EQ(visits, std::vector<int>(10007, 1)) << threads << " threads";
    }
}

TEST(ParallelFor, NothingToDo) {
    parallelFor(0, 0, [](std::size_t) { FAIL(); });
    EXPECT_EQ(parallelSum(0, 0, [](std::size_t) { return 1.0; }), 0);
}

TEST(ParallelFor, OneThreadRunsHereInOrder) {
    std::vector<std::size_t> order;
    const auto here = std::this_thread::get_id();
    parallelFor(100, 1, [&](std::size_t i) {
        EXPECT_EQ(std::this_thread::get_id(), here);
        order.push_back(i);
    });
    for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
}

TEST(ParallelFor, Nested) {
    std::vector<int> visits(64 * 64);
    parallelFor(64, 2, [&](std::size_t i) { parallelFor(64, 2, [&](std::size_t j) { ++visits[i * 64 + j]; }); });
    EXPECT_EQ(visits, std::vector<int>(64 * 64, 1));
}

TEST(ParallelSum, SameBitsForAnyThreadCount) {  // terms of very different size: another order gives other bits
    const auto term = [](std::size_t i) { return std::sin(static_cast<double>(i)) * std::pow(10.0, i % 17); };
    const double one = parallelSum(5000, 1, term);
    for (const unsigned threads : {0u, 2u, 3u, 16u})
        for (int repeat = 0; repeat < 5; ++repeat) EXPECT_EQ(parallelSum(5000, threads, term), one) << threads;
}

}  // namespace
}  // namespace nacre
