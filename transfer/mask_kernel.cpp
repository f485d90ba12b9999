#include "transfer/mask_kernel.hpp"

#include <cstring>
#include <string>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "core/error.hpp"

namespace nacre {
namespace {

#define NACRE_KERNEL "transfer/mask_kernel.inl"
#include "core/wide.inl"

template <int N>
MaskKernel kernelOf([[maybe_unused]] VectorSet set) {
#if defined(__x86_64__)
    if (set == VectorSet::Avx512) return {avx512::cull, avx512::draw<N>, avx512::integrate<N>};
    if (set == VectorSet::Avx2) return {avx2::cull, avx2::draw<N>, avx2::integrate<N>};
#endif
    return {plain::cull, plain::draw<N>, plain::integrate<N>};
}

}  // namespace

void BlockerList::start(std::size_t room) {
    count = drawnOnly = 0;
    if (room <= room_) return;
    room_ = room;
    const std::size_t padded = room + 2 * kLanes;
    for (std::vector<float>& c : corners) c.resize(padded);
    for (std::vector<float>& c : plane) c.resize(padded);
    byTriangle.resize(12 * padded);
}

void BlockerList::writeTriangle(std::size_t at, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const float numbers[12] = {a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, 0, 0, 0};
    std::memcpy(&byTriangle[12 * at], numbers, sizeof(numbers));
}

void BlockerList::add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& normal, float offset) {
    writeTriangle(count, a, b, c);
    for (std::size_t k = 0; k < 9; ++k) corners[k][count] = byTriangle[12 * count + k];
    for (int k = 0; k < 3; ++k) plane[k][count] = normal[k];
    plane[3][count] = offset;
    ++count;
}

void BlockerList::add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 n = glm::cross(b - a, c - a);
    add(a, b, c, n, glm::dot(n, a));
}

void BlockerList::pad() {
    drawnOnly = (count + kLanes - 1) / kLanes * kLanes;
    for (std::size_t i = count; i < drawnOnly; ++i) writeTriangle(i, glm::vec3(0), glm::vec3(0), glm::vec3(0));
}

std::uint32_t BlockerList::addDrawnOnly(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    if (12 * (drawnOnly + 1) > byTriangle.size()) byTriangle.resize(24 * (drawnOnly + 1));
    writeTriangle(drawnOnly, a, b, c);
    return static_cast<std::uint32_t>(drawnOnly++);
}

VectorSet vectorSetFromString(const std::string& name) {
    if (name == "plain") return VectorSet::Plain;
    if (name == "avx2") return VectorSet::Avx2;
    if (name == "avx512") return VectorSet::Avx512;
    if (name == "widest") return VectorSet::Widest;
    throw std::invalid_argument("expected vectors of plain, avx2, avx512 or widest, found " + name);
}

bool processorHas([[maybe_unused]] VectorSet set) {
#if defined(__x86_64__)
    if (set == VectorSet::Avx512) return hasAvx512();
    if (set == VectorSet::Avx2) return __builtin_cpu_supports("avx2");
    return true;
#else
    return set == VectorSet::Plain || set == VectorSet::Widest;
#endif
}

MaskKernel maskKernel(int size, VectorSet set) {
    require(processorHas(set), "transfer: this processor has no such vectors");
    if (set == VectorSet::Widest)
        set = processorHas(VectorSet::Avx512) ? VectorSet::Avx512
              : processorHas(VectorSet::Avx2) ? VectorSet::Avx2
                                              : VectorSet::Plain;
    switch (size) {
        case 16: return kernelOf<16>(set);
        case 32: return kernelOf<32>(set);
        case 64: return kernelOf<64>(set);
        case 128: return kernelOf<128>(set);
        default: throw std::invalid_argument("mask: expected a size of 16, 32, 64 or 128, found " + std::to_string(size));
    }
}

}  // namespace nacre
