#include "bump/sweep_memory.hpp"

#include <new>
#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace nacre {

float* SweepMemory::need(std::size_t count) {
    if (count <= count_) return values_.get();
    constexpr std::size_t kHugePage = std::size_t{2} << 20, kLine = 64;
    const std::size_t unit = count * sizeof(float) < kHugePage ? kLine : kHugePage;
    const std::size_t bytes = (count * sizeof(float) + unit - 1) / unit * unit;
    values_.reset();
    count_ = 0;
    values_.reset(static_cast<float*>(std::aligned_alloc(unit, bytes)));
    if (!values_) throw std::bad_alloc();
    count_ = count;
#if defined(__linux__)
    if (unit == kHugePage) madvise(values_.get(), bytes, MADV_HUGEPAGE);  // a hint: without, it works as well
#endif
    return values_.get();
}

std::unique_ptr<SweepMemory> SweepMemories::take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<SweepMemory>();
    std::unique_ptr<SweepMemory> out = std::move(idle_.back());
    idle_.pop_back();
    return out;
}

void SweepMemories::giveBack(std::unique_ptr<SweepMemory> memory) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(memory));
}

}  // namespace nacre
