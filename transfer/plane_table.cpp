#include "transfer/plane_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {
namespace {

#define NACRE_KERNEL "transfer/plane_table.inl"
#include "core/wide.inl"

DiskGrid makeGrid() {
    DiskGrid grid;
    for (int i = 0; i < kDiskSize; ++i) grid.x[i] = grid.y[i] = (static_cast<float>(i) + 0.5f) / (kDiskSize / 2) - 1;
    for (int j = 0; j < kDiskSize; ++j)
        for (int i = 0; i < kDiskSize; ++i) {
            const float squared = grid.x[i] * grid.x[i] + grid.y[j] * grid.y[j];
            grid.z[j][i] = squared <= 1 ? std::sqrt(1 - squared) : -1;
            if (squared > 1) continue;
            grid.inside.rows[j] |= 1u << i;
            ++grid.count;
        }
    return grid;
}

DiskMask maskAbove(const glm::vec3& n) {
    const DiskGrid& grid = diskGrid();
    DiskMask mask;
    for (int j = 0; j < kDiskSize; ++j)
        for (int i = 0; i < kDiskSize; ++i)
            if (n.x * grid.x[i] + n.y * grid.y[j] + n.z * grid.z[j][i] >= 0) mask.rows[j] |= 1u << i;
    return mask;
}

}  // namespace

const DiskGrid& diskGrid() {
    static const DiskGrid grid = makeGrid();
    return grid;
}

std::size_t PlaneTable::indexOf(const glm::vec3& n) const {
    const glm::vec3 a = glm::abs(n);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    const auto texel = [&](float along) {
        const float half = 0.5f * static_cast<float>(size);
        return std::min(static_cast<std::size_t>(along * (half / a[axis]) + half), static_cast<std::size_t>(size) - 1);
    };
    const auto face = static_cast<std::size_t>(2 * axis + (n[axis] < 0 ? 1 : 0)), edge = static_cast<std::size_t>(size);
    return (face * edge + texel(n[axis == 2 ? 1 : 2])) * edge + texel(n[axis == 0 ? 1 : 0]);
}

std::shared_ptr<const PlaneTable> planeTable(int size, unsigned threads) {
    require(size >= 1 && size <= 512, "plane table: expected a size of 1 to 512");
    auto table = std::make_shared<PlaneTable>();
    const auto edge = static_cast<std::size_t>(size);
    table->size = size;
    table->masks.resize(6 * edge * edge);
    parallelFor(6 * edge, threads, [&](std::size_t row) {
        const int axis = static_cast<int>(row / edge / 2);
        const auto along = [&](std::size_t i) {
            return (2 * static_cast<float>(i) + 1) / static_cast<float>(size) - 1;
        };
        for (std::size_t u = 0; u < edge; ++u) {
            glm::vec3 n;
            n[axis] = row / edge % 2 == 0 ? 1.0f : -1.0f;
            n[axis == 0 ? 1 : 0] = along(u);
            n[axis == 2 ? 1 : 2] = along(row % edge);
            table->masks[row * edge + u] = maskAbove(n);
        }
    });
    return table;
}

DiskKernel diskKernel(VectorSet set) {
    require(processorHas(set), "plane table: this processor has no such vectors");
#if defined(__x86_64__)
    if (set == VectorSet::Avx512) return {avx512::draw, avx512::integrate};
    if (set == VectorSet::Avx2) return {avx2::draw, avx2::integrate};
#endif
    if (set == VectorSet::Plain) return {plain::draw, plain::integrate};
    return {NACRE_WIDEST(draw), NACRE_WIDEST(integrate)};
}

}  // namespace nacre
