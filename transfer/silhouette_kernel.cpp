#include "transfer/silhouette_kernel.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace nacre {
namespace {

#define NACRE_KERNEL "transfer/silhouette_kernel.inl"
#include "core/wide.inl"

template <int N>
SilhouetteKernel kernelOf([[maybe_unused]] VectorSet set) {
#if defined(__x86_64__)
    if (set == VectorSet::Avx512)
        return {avx512::place,    avx512::classify, avx512::face,   avx512::differ,   avx512::nearPole,
                avx512::overhead, avx512::deal,     avx512::add<N>, avx512::finish<N>};
    if (set == VectorSet::Avx2)
        return {avx2::place,    avx2::classify, avx2::face,   avx2::differ,   avx2::nearPole,
                avx2::overhead, avx2::deal,     avx2::add<N>, avx2::finish<N>};
#endif
    return {plain::place,    plain::classify, plain::face,   plain::differ,   plain::nearPole,
            plain::overhead, plain::deal,     plain::add<N>, plain::finish<N>};
}

}  // namespace

void DifferingEdges::resize(std::size_t edges) {
    for (std::vector<std::uint32_t>* column : {&edge, &sides, &first}) column->resize(edges + kLanes);
}

ReceiverLanes receiverLanes(std::span<const Receiver> receivers, const GroupBox& box) {
    ReceiverLanes out;
    out.box = box;
    for (std::size_t k = 0; k < kLanes; ++k) {
        const Receiver& r = receivers[k < receivers.size() ? k : 0];
        for (int c = 0; c < 3; ++c) {
            out.point[c][k] = r.point[c];
            out.normal[c][k] = r.normal[c];
        }
        out.height[k] = r.normal.x * r.point.x + r.normal.y * r.point.y + r.normal.z * r.point.z;
    }
    return out;
}

SilhouetteKernel silhouetteKernel(int size, VectorSet set) {
    set = chosenSet(set);
    return forMaskSize(size, [&](auto n) { return kernelOf<n>(set); });
}

}  // namespace nacre
