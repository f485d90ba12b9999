#include "transfer/mask_kernel.hpp"

#include <cmath>
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
    if (set == VectorSet::Avx512) return {avx512::draw<N>, avx512::integrate<N>};
    if (set == VectorSet::Avx2) return {avx2::draw<N>, avx2::integrate<N>};
#endif
    return {plain::draw<N>, plain::integrate<N>};
}

}  // namespace

BlockerRow blockerRow(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 n = glm::cross(b - a, c - a);
    return {{a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z}, {n.x, n.y, n.z}, glm::dot(n, a), glm::length(n), {}};
}

Receiver receiverAt(const glm::vec3& point, const glm::vec3& normal) {
    const glm::vec3& n = normal;
    const float s = std::copysign(1.0f, n.z), a = -1 / (s + n.z);
    const glm::vec3 tangent(1 + s * n.x * n.x * a, s * n.x * n.y * a, -s * n.x);
    return {point, tangent, glm::cross(n, tangent), n};
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
    if (set == VectorSet::Avx2) return hasAvx2();
    return true;
#else
    return set == VectorSet::Plain || set == VectorSet::Widest;
#endif
}

VectorSet chosenSet(VectorSet set) {
    require(processorHas(set), "transfer: this processor has no such vectors");
    if (set != VectorSet::Widest) return set;
    return processorHas(VectorSet::Avx512) ? VectorSet::Avx512
           : processorHas(VectorSet::Avx2) ? VectorSet::Avx2
                                           : VectorSet::Plain;
}

MaskKernel maskKernel(int size, VectorSet set) {
    set = chosenSet(set);
    return forMaskSize(size, [&](auto n) { return kernelOf<n>(set); });
}

}  // namespace nacre
