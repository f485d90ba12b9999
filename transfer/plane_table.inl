// The arithmetic of plane_table.hpp; core/wide.inl says where this is compiled.
#include "transfer/vector_parts.inl"

template <class V>
NACRE_INLINE V vectorAt(const void* p) {
    V v;
    std::memcpy(&v, p, sizeof(v));
    return v;
}

/// Planes through the eye and the edges, in the receiver's frame, the triangle on their positive side.
/// \return  lanes that are to be drawn
NACRE_INLINE unsigned edgePlanes(const BlockerRow* blockers, const Receiver& receiver, bool bothSides,
                                 const std::uint32_t* indices, Columns (&edge)[3]) {
    Floats v[9];
    gather<9>(blockers, indices, v);
    Columns corner[3];
    for (int c = 0; c < 3; ++c) {
        const Columns d = Columns{v[3 * c], v[3 * c + 1], v[3 * c + 2]} - receiver.point;
        corner[c] = {dot(receiver.tangent, d), dot(receiver.bitangent, d), dot(receiver.normal, d)};
    }
    for (int e = 0; e < 3; ++e) {  // a shared edge gives its negative exactly
        const Columns &p = corner[(e + 1) % 3], &q = corner[e];
        edge[e] = {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
    }
    const Floats volume = edge[0].x * corner[2].x + edge[0].y * corner[2].y + edge[0].z * corner[2].z;
    if (!bothSides) return lanes(volume > Floats{});
    const Mask back = volume < Floats{};
    for (Columns& e : edge) e = {choose(back, -e.x, e.x), choose(back, -e.y, e.y), choose(back, -e.z, e.z)};
    return lanes(volume != Floats{});
}

/// PlaneTable::indexOf, and some plane for n = 0: an edge seen end-on, whose triangle rounds to a volume.
NACRE_INLINE Mask planeIndex(int size, const Columns& n) {
    const Floats ax = absolute(n.x), ay = absolute(n.y), az = absolute(n.z),
                 half = splat(0.5f * static_cast<float>(size));
    const Mask alongX = (ax >= ay) & (ax >= az), alongY = ~alongX & (ay >= az);
    const Floats major = choose(alongX, n.x, choose(alongY, n.y, n.z));
    const Floats scale = half / (absolute(major) + splat(1e-30f));
    const Mask last = Mask{} + (size - 1);
    Mask u = __builtin_convertvector(choose(alongX, n.y, n.x) * scale + half, Mask);
    Mask v = __builtin_convertvector(choose(alongX | alongY, n.z, n.y) * scale + half, Mask);
    u = u > last ? last : u;
    v = v > last ? last : v;
    const Mask face = (alongX ? Mask{} : (alongY ? Mask{} + 2 : Mask{} + 4)) - (major < Floats{});
    return (face * size + v) * size + u;
}

/// Bits of one triangle by its planes.
NACRE_INLINE void drawExactly(const Columns (&edge)[3], int lane, DiskMask& mask) {
    const DiskGrid& grid = diskGrid();
    for (int j = 0; j < kDiskSize; ++j) {
        std::uint32_t row = 0;
        for (int i = 0; i < kDiskSize; i += kWide) {
            const Floats x = load(grid.x + i), z = load(grid.z[j] + i);
            Floats least{};
            for (int e = 0; e < 3; ++e) {
                const Floats above =
                    splat(edge[e].x[lane]) * x + splat(edge[e].y[lane] * grid.y[j]) + splat(edge[e].z[lane]) * z;
                least = e == 0 ? above : smaller(least, above);
            }
            row |= lanes(least >= Floats{}) << i;
        }
        mask.rows[j] |= row;
    }
}

void draw(const PlaneTable* table, const BlockerRow* blockers, const Receiver& receiver, bool bothSides,
          std::uint32_t* indices, int count, DiskMask& mask) {
    constexpr int kBatch = 256;  // a cache's first level holds their masks
    std::uint32_t planes[3 * kBatch];
    Bits bits[2];
    std::memcpy(bits, mask.rows, sizeof(bits));
    for (int k = count; k % kWide; ++k) indices[k] = indices[count - 1];
    for (int first = 0; first < count; first += kBatch) {
        std::size_t triangles = 0;
        for (int i = first; i < std::min(count, first + kBatch); i += kWide) {
            Columns edge[3];
            unsigned drawn = edgePlanes(blockers, receiver, bothSides, indices + i, edge);
            drawn &= count - i >= kWide ? 0xffffu : (1u << (count - i)) - 1;
            if (table == nullptr) {
                for (; drawn; drawn &= drawn - 1) drawExactly(edge, __builtin_ctz(drawn), mask);
                continue;
            }
            const Mask at[3] = {planeIndex(table->size, edge[0]), planeIndex(table->size, edge[1]),
                                planeIndex(table->size, edge[2])};
            for (; drawn; drawn &= drawn - 1, ++triangles)
                for (std::size_t e = 0; e < 3; ++e) {
                    const std::uint32_t plane = static_cast<std::uint32_t>(at[e][__builtin_ctz(drawn)]);
                    planes[3 * triangles + e] = plane;
                    __builtin_prefetch(table->masks[plane].rows);
                    __builtin_prefetch(table->masks[plane].rows + 16);
                }
        }
        for (std::size_t t = 0; t < triangles; ++t)
            for (int half = 0; half < 2; ++half) {
                Bits triangle = ~Bits{};
                for (std::size_t e = 0; e < 3; ++e)
                    triangle &= vectorAt<Bits>(table->masks[planes[3 * t + e]].rows + kWide * half);
                bits[half] |= triangle;
            }
    }
    if (table != nullptr) std::memcpy(mask.rows, bits, sizeof(bits));
}

void integrate(const DiskIntegrals& integrals, const DiskMask& mask, float* sums) {
    // Set bits of each four side by side, in bytes; then of four rows.
    std::uint32_t fours[2][kDiskSize];
    for (int half = 0; half < 2; ++half) {
        Bits x = vectorAt<Bits>(mask.rows + kWide * half) & vectorAt<Bits>(diskGrid().inside.rows + kWide * half);
        x -= x >> 1 & 0x55555555u;
        x = (x & 0x33333333u) + (x >> 2 & 0x33333333u);
        const Bits even = x & 0x0f0f0f0fu, odd = x >> 4 & 0x0f0f0f0fu;
        std::memcpy(fours[0] + kWide * half, &even, sizeof(even));
        std::memcpy(fours[1] + kWide * half, &odd, sizeof(odd));
    }
    Floats low{}, high{};
    for (std::size_t block = 0; block < kDiskBlocks; ++block) {
        const std::size_t j = block / 8 * 4, i = block % 8;
        const std::uint32_t* f = fours[i % 2] + j;
        const Floats count =
            splat(static_cast<float>((f[0] + f[1] + f[2] + f[3]) >> (4 * (i & ~std::size_t{1})) & 255));
        low += count * load(integrals.perBit[block]);
        high += count * load(integrals.perBit[block] + kWide);
    }
    std::memcpy(sums, &low, sizeof(low));
    std::memcpy(sums + kWide, &high, sizeof(high));
}
