// Triangles into masks and masks into coefficients, by the widest vectors that the processor has.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "core/scene.hpp"
#include "transfer/mask_tables.hpp"

namespace nacre {

/// A triangle as the kernels read it.
struct alignas(64) BlockerRow {
    float corners[9] = {};
    float normal[3] = {};  ///< outward, as long as twice the area
    float offset = 0;      ///< normal · corner
    float normalLength = 0;
    float room[2] = {};
};
BlockerRow blockerRow(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// Where a hemisphere stands: a point and a frame with z the normal, in the blockers' coordinates.
struct Receiver {
    glm::vec3 point{0}, tangent{1, 0, 0}, bitangent{0, 1, 0}, normal{0, 0, 1};
};

/// A frame about a unit normal (Duff et al. 2017).
Receiver receiverAt(const glm::vec3& point, const glm::vec3& normal);

/// Which processor's vectors compute. All give the same bits.
enum class VectorSet { Plain, Avx2, Avx512, Widest };
/// plain, avx2, avx512, widest \throws std::invalid_argument that lists them
VectorSet vectorSetFromString(const std::string& name);
bool processorHas(VectorSet set);
/// Widest resolved. \throws std::invalid_argument when the processor lacks the set
VectorSet chosenSet(VectorSet set);

struct MaskKernel {
    /// Sets the bits of `count` triangles, in any order. \param indices  into blockers; room for 15 more behind
    /// \param mask  [(N + 31)/32][N] words
    void (*draw)(const MaskRows& rows, const BlockerRow* blockers, const Receiver& receiver, bool bothSides,
                 std::uint32_t* indices, std::size_t count, std::uint32_t* mask);
    /// Σ over set bits, in the receiver's frame: [groups][cos, sin][16] by pair (l, m). For ones everywhere the
    /// integral of y_lm cosθ/π over the hemisphere.
    void (*integrate)(const MaskIntegrals& tables, const std::uint32_t* mask, float* sums);
};

/// \param size  of the mask: 16, 32, 64 or 128 \throws std::invalid_argument also when the processor lacks the set
MaskKernel maskKernel(int size, VectorSet set = VectorSet::Widest);

/// of(N) with the size as a constant. \throws std::invalid_argument for other sizes
template <class Of>
auto forMaskSize(int size, const Of& of) {
    switch (size) {
        case 16:
            return of(std::integral_constant<int, 16>{});
        case 32:
            return of(std::integral_constant<int, 32>{});
        case 64:
            return of(std::integral_constant<int, 64>{});
        case 128:
            return of(std::integral_constant<int, 128>{});
        default:
            throw std::invalid_argument("mask: expected a size of 16, 32, 64 or 128, found " + std::to_string(size));
    }
}

inline std::size_t maskWords(int size) {
    return static_cast<std::size_t>(size) * static_cast<std::size_t>((size + 31) / 32);
}

}  // namespace nacre
