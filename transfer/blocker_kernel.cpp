#include "transfer/blocker_kernel.hpp"

#include <cstring>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace nacre {
namespace {

#define NACRE_KERNEL "transfer/blocker_kernel.inl"
#include "core/wide.inl"

}  // namespace

void PatchColumns::resize(std::size_t patches, std::size_t levels) {
    count = patches;
    const std::size_t padded = (patches + kLanes - 1) / kLanes * kLanes;
    for (std::vector<float>& c : centre) c.resize(padded);
    for (std::vector<float>& c : corners) c.resize(padded);
    radius.resize(padded);
    off.resize(levels);
    for (std::size_t l = 1; l < levels; ++l) off[l].resize(padded);
}

BlockerKernel blockerKernel(VectorSet set) {
#if defined(__x86_64__)
    switch (chosenSet(set)) {
        case VectorSet::Avx512:
            return {avx512::choose, avx512::cull};
        case VectorSet::Avx2:
            return {avx2::choose, avx2::cull};
        default:
            break;
    }
#endif
    return {plain::choose, plain::cull};
}

}  // namespace nacre
