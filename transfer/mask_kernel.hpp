// Inside: blockers into masks and masks into coefficients, by the widest vectors that the processor has.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene.hpp"
#include "transfer/mask_tables.hpp"

namespace nacre {

/// Blockers as the kernels read them: corners by component for the tests, by triangle for the drawing.
struct BlockerList {
    std::vector<float> corners[9];  ///< x0, y0, z0, x1, …
    std::vector<float> plane[4];    ///< outward normal of any length and its dot product with a corner
    std::vector<float> byTriangle;  ///< [12] the nine numbers, then room
    std::size_t count = 0;          ///< to be tested
    std::size_t drawnOnly = 0;      ///< behind the padded count in byTriangle: skip the tests

    /// Empty, with room for so many triangles.
    void start(std::size_t room);
    void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& normal, float offset);
    void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);
    /// Fills up to a multiple of 16; nothing to be tested comes after.
    void pad();
    /// \return its index for drawing
    std::uint32_t addDrawnOnly(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

private:
    std::size_t room_ = 0;
    void writeTriangle(std::size_t at, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);
};

/// Where a hemisphere stands: a point and a frame with z the normal, in the blockers' coordinates.
struct Receiver {
    glm::vec3 point{0}, tangent{1, 0, 0}, bitangent{0, 1, 0}, normal{0, 0, 1};
};

/// Which processor's vectors compute. All give the same bits.
enum class VectorSet { Plain, Avx2, Avx512, Widest };
/// plain, avx2, avx512, widest \throws std::invalid_argument that lists them
VectorSet vectorSetFromString(const std::string& name);
bool processorHas(VectorSet set);

struct MaskKernel {
    /// Triangles with a corner higher than `above` over the receiver's plane and, unless bothSides, facing it.
    /// \param out  room for the padded count and 16 more \return how many
    int (*cull)(const BlockerList& list, const Receiver& receiver, float above, bool bothSides, std::uint32_t* out);
    /// Sets the bits of `count` triangles. \param indices  into byTriangle [12 numbers each]; room for 15 more behind
    /// \param mask  [N/32][N] words (N = 16: one half of each)
    void (*draw)(const MaskRows& rows, const float* byTriangle, const Receiver& receiver, bool bothSides,
                 std::uint32_t* indices, int count, std::uint32_t* mask);
    /// Σ over set bits, in the receiver's frame: [groups][cos, sin][16] by pair (l, m). For ones everywhere the integral
    /// of y_lm cosθ/π over the hemisphere.
    void (*integrate)(const MaskIntegrals& tables, const std::uint32_t* mask, float* sums);
};

/// \param size  of the mask: 16, 32, 64 or 128 \throws std::invalid_argument also when the processor lacks the set
MaskKernel maskKernel(int size, VectorSet set = VectorSet::Widest);

inline std::size_t maskWords(int size) { return static_cast<std::size_t>(size) * static_cast<std::size_t>((size + 31) / 32); }

}  // namespace nacre
