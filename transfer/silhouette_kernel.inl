// The arithmetic of silhouette_kernel.hpp; core/wide.inl says where this is compiled.
#include "transfer/vector_parts.inl"

NACRE_INLINE Columns columnsOf(const float (&v)[3][kLanes]) { return {load(v[0]), load(v[1]), load(v[2])}; }
NACRE_INLINE Columns from(const float* p, const Columns& q) { return {splat(p[0]) - q.x, splat(p[1]) - q.y, splat(p[2]) - q.z}; }

ClusterFlags classify(const TriangleCluster& b, const ReceiverLanes& receivers) {
    constexpr float kRounding = 2e-6f;  // of the extent
    const Columns d = from(b.centre, columnsOf(receivers.point));
    const Floats radius = splat(b.radius), height = dot(columnsOf(receivers.normal), d), squared = dot(d, d);
    const Floats front = -(splat(b.axis[0]) * d.x + splat(b.axis[1]) * d.y + splat(b.axis[2]) * d.z);
    // front ≷ ±(spread |d| + slab), without the root
    const Floats slab = splat(b.slab + kRounding), spread = splat(b.spread * b.spread) * squared, over = front - slab, under = front + slab;
    const Mask above = height + radius > Floats{};
    return {lanes(above), lanes((over > Floats{}) & (over * over > spread)), lanes((under < Floats{}) & (under * under > spread)),
            lanes(above & (squared - height * height <= splat(1.0001f) * radius * radius + splat(kRounding * kRounding)))};
}

template <bool kBacks>
NACRE_INLINE Bits facesOf(const TriangleCluster& cluster, const ReceiverLanes& receivers) {
    const Columns n{load(cluster.normal[0]), load(cluster.normal[1]), load(cluster.normal[2])};
    const Floats offset = load(cluster.offset), least = splat(kFacing);
    Bits sides{};
    for (int k = 0; k < kLanes; ++k) {
        const glm::vec3 p(receivers.point[0][k], receivers.point[1][k], receivers.point[2][k]);
        const Floats front = dot(p, n) - offset;
        sides |= as<Bits>(front > least) & (1u << k);
        if (kBacks) sides |= as<Bits>(front < -least) & (0x10000u << k);
    }
    return sides;
}

std::uint32_t face(const TriangleCluster& cluster, const ReceiverLanes& receivers, std::uint32_t seen, std::uint32_t members,
                   const std::uint32_t* own, std::uint32_t* out) {
    Bits excepted;
    std::memcpy(&excepted, own, sizeof(excepted));
    Bits sides = ~excepted & (seen >> 16 ? facesOf<true>(cluster, receivers) : facesOf<false>(cluster, receivers)) & seen;
    if (members != 0xffff)
        for (int t = 0; t < kLanes; ++t) sides[t] = members >> t & 1 ? sides[t] : 0;
    store(out, sides);
    std::uint32_t all = 0;
    for (int t = 0; t < kLanes; ++t) all |= sides[t];
    return all;
}

#if NACRE_SET == 512
NACRE_INLINE void addDiffering(std::size_t edge, const __m512i& a, const __m512i& b, DifferingEdges& out) {
    const __m512i numbers = _mm512_add_epi32(_mm512_set1_epi32(static_cast<int>(edge)), _mm512_set_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0));
    const unsigned some = _mm512_cmpneq_epi32_mask(a, b);
    append(out.edge.data(), out.count, numbers, some);
    append(out.sides.data(), out.count, _mm512_xor_si512(a, b), some);
    out.count = append(out.first.data(), out.count, a, some);
}
#endif

void differ(const EdgeSides& edges, const std::uint32_t* sides, const std::uint8_t* look, DifferingEdges& out) {
    out.count = 0;
    const std::size_t clusters = edges.between.size();
#if NACRE_SET == 512
    const __m512i zero = _mm512_setzero_si512();
    for (std::size_t c = 0; c < clusters; ++c) {
        if (look[c] & kInside) {
            const __m512i own = _mm512_loadu_si512(sides + kLanes * c);  // places modulo 16 are lanes
            for (std::size_t e = edges.inside[c]; e < edges.between[c]; e += kWide)
                addDiffering(e, _mm512_permutexvar_epi32(_mm512_loadu_si512(&edges.a[e]), own), _mm512_permutexvar_epi32(_mm512_loadu_si512(&edges.b[e]), own), out);
        }
        if (look[c] & kBetween)
            for (std::size_t e = edges.between[c]; e < edges.inside[c + 1]; e += kWide)
                addDiffering(e, _mm512_mask_i32gather_epi32(zero, 0xffff, _mm512_loadu_si512(&edges.a[e]), sides, 4), _mm512_mask_i32gather_epi32(zero, 0xffff, _mm512_loadu_si512(&edges.b[e]), sides, 4), out);
    }
#else
    const auto add = [&](std::size_t first, std::size_t end) {
        for (std::size_t e = first; e < end; ++e) {
            const std::uint32_t a = sides[edges.a[e]], some = a ^ sides[edges.b[e]];
            out.edge[out.count] = static_cast<std::uint32_t>(e);
            out.sides[out.count] = some;
            out.first[out.count] = a;
            out.count += some != 0;
        }
    };
    for (std::size_t c = 0; c < clusters; ++c) {
        if (look[c] & kInside) add(edges.inside[c], edges.between[c]);
        if (look[c] & kBetween) add(edges.between[c], edges.inside[c + 1]);
    }
#endif
    for (std::vector<std::uint32_t>* column : {&out.edge, &out.sides, &out.first}) std::memset(column->data() + out.count, 0, sizeof(Bits));
}

/// Twice the area of the pole and an edge, seen along the pole.
NACRE_INLINE Floats turning(const Floats& x0, const Floats& y0, const Floats& x1, const Floats& y1) { return x0 * y1 - x1 * y0; }

/// Whether the edge turns about the pole the way that azimuths grow; the opposite for the edge reversed. An edge right
/// through the pole passes beside (0, ε): `rowsBefore` of y − 1e-30 agrees with that.
NACRE_INLINE Mask turnsLeft(const Floats& turn, const Floats& x0, const Floats& y0, const Floats& x1, const Floats& y1) {
    return (turn > Floats{}) | ((turn == Floats{}) & ((x1 > x0) | ((x1 == x0) & (y1 > y0))));
}

std::int32_t overhead(const TriangleCluster& cluster, const Receiver& receiver, int lane, const std::uint32_t* faces) {
    const auto frame = [&](const float (&a)[kLanes], const float (&b)[kLanes], const float (&c)[kLanes], Floats& x, Floats& y) {
        const Columns d = Columns{load(a), load(b), load(c)} - receiver.point;
        x = dot(receiver.tangent, d);
        y = dot(receiver.bitangent, d);
    };
    Floats x[3], y[3];
    frame(cluster.middle[0], cluster.middle[1], cluster.middle[2], x[0], y[0]);
    const Floats reach = splat(1.0001f) * load(cluster.reach) + splat(1e-5f);
    Bits words;
    std::memcpy(&words, faces, sizeof(words));
    const Mask near = x[0] * x[0] + y[0] * y[0] <= reach * reach;
    Mask front = near & as<Mask>(words << static_cast<unsigned>(31 - lane)), back = near & as<Mask>(words << static_cast<unsigned>(15 - lane));
    if ((lanes(front) | lanes(back)) == 0) return 0;
    for (int c = 0; c < 3; ++c) frame(cluster.corners[3 * c], cluster.corners[3 * c + 1], cluster.corners[3 * c + 2], x[c], y[c]);
    // A front turns clockwise about a pole that it hides, seen from above; a back the other way.
    for (int c = 0; c < 3; ++c) {
        const int e = (c + 1) % 3;
        const Mask left = turnsLeft(turning(x[c], y[c], x[e], y[e]), x[c], y[c], x[e], y[e]);
        front &= ~left;
        back &= left;
    }
    return __builtin_popcount(lanes(front) | lanes(back));
}

void deal(const EdgeRow* rows, const ReceiverLanes& receivers, const DifferingEdges& edges, DealtEdges& out) {
    // A front on the edge's first side hides the same side of it as a back on its other.
    for (std::size_t i = 0; i < edges.count; i += kWide) {
        Bits edge, sides, first;
        std::memcpy(&edge, edges.edge.data() + i, sizeof(edge));
        std::memcpy(&sides, edges.sides.data() + i, sizeof(sides));
        std::memcpy(&first, edges.first.data() + i, sizeof(first));
        const float* from[kWide];
        for (std::size_t k = 0; k < kWide; ++k) from[k] = rows[edges.edge[i + k]].p;
        Floats v[8];
        gather<8>(from, v);
        const Columns p{v[0], v[1], v[2]}, q{v[4], v[5], v[6]};
        const Bits item = edge << 3, backs = sides >> 16, either = sides | backs, twice = (sides & backs) << 1;
        const bool some = any(as<Mask>(backs));
        const Bits other = some ? (~first & sides) | (first >> 16 & backs) : ~first;
#if NACRE_SET == 512
        for (std::size_t k = 0; k < kLanes; ++k) {
            const glm::vec3 n(receivers.normal[0][k], receivers.normal[1][k], receivers.normal[2][k]);
            const Floats height = larger(dot(n, p), dot(n, q));
            const __m512i bit = _mm512_set1_epi32(1 << k), items = as<__m512i>(item), one = _mm512_set1_epi32(DealtEdges::kOther);
            const __mmask16 above = _mm512_cmp_ps_mask(as<__m512>(height), _mm512_set1_ps(receivers.height[k]), _CMP_GT_OQ);
            const __mmask16 to = _mm512_mask_test_epi32_mask(above, as<__m512i>(either), bit);
            __m512i value = _mm512_mask_or_epi32(items, _mm512_test_epi32_mask(as<__m512i>(other), bit), items, one);
            if (some) value = _mm512_or_si512(value, _mm512_and_si512(_mm512_srli_epi32(as<__m512i>(twice), static_cast<unsigned>(k)), _mm512_set1_epi32(DealtEdges::kTwice)));
            out.counts[k] = append(out.items.data() + k * out.room, out.counts[k], value, to);
        }
#else
        for (std::size_t k = 0; k < kLanes; ++k) {
            const auto bit = static_cast<unsigned>(k);
            const glm::vec3 n(receivers.normal[0][k], receivers.normal[1][k], receivers.normal[2][k]);
            const Mask above = larger(dot(n, p), dot(n, q)) > splat(receivers.height[k]);
            Bits value = item | (other >> bit & DealtEdges::kOther);
            if (some) value |= twice >> bit & DealtEdges::kTwice;
            out.counts[k] = append(out.items.data() + k * out.room, out.counts[k], value, lanes(above & as<Mask>(either << (31 - bit))));
        }
#endif
    }
}

/// The number of rows whose middles lie between azimuth 0 and that of (x, y), −N/2 to N/2: rows begin ≤ r < end are those
/// that an edge sweeps. \param tangents  [N/8] of the first rows' middles
template <int N>
NACRE_INLINE Mask rowsBefore(const float* tangents, const Floats& x, const Floats& y) {
    const Floats ax = absolute(x), ay = absolute(y), most = larger(ax, ay), least = smaller(ax, ay);
    Mask rows{};
    for (int j = 0; j < N / 8; ++j) rows -= least > splat(tangents[j]) * most;
    rows = ay > ax ? N / 4 - rows : rows;
    rows = x < Floats{} ? N / 2 - rows : rows;
    return y < Floats{} ? -rows : rows;
}

/// A table's numbers for sixteen rows.
template <int N>
NACRE_INLINE Floats atRows(const float* table, const Mask& row) {
#if NACRE_SET == 512
    const auto ofTwo = [&](const float* at) {
        return _mm512_permutex2var_ps(_mm512_load_ps(at), as<__m512i>(row), _mm512_load_ps(at + kWide));
    };
    if constexpr (N == 16) return as<Floats>(_mm512_permutexvar_ps(as<__m512i>(row), _mm512_load_ps(table)));
    if constexpr (N == 32) return as<Floats>(ofTwo(table));
    if constexpr (N == 64) return choose((row & 32) != 0, as<Floats>(ofTwo(table + 32)), as<Floats>(ofTwo(table)));
#endif
    Floats out;
    for (int k = 0; k < kWide; ++k) out[k] = table[row[k]];
    return out;
}

/// Edges in a receiver's frame that sweep some rows, side by side.
struct Swept {
    static constexpr std::size_t kRoom = 256;
    static constexpr int kEnds = 1 << 7, kTwice = 1 << 8, kMore = 1 << 9;
    float column[6][kRoom + kWide];   ///< both ends
    std::int32_t rows[kRoom + kWide];  ///< first row + kEnds where layers end below the edge + kTwice + kMore × how many rows
    std::size_t count = 0;
};

/// Where edges cross rows: planes as cot θ = a cosφ + b sinφ, and the layers that begin there, side by side.
struct Crossings {
    static constexpr std::size_t kRoom = 512;
    float a[kRoom + kWide], b[kRoom + kWide];
    std::int32_t row[kRoom + kWide], layers[kRoom + kWide];
    std::size_t count = 0;
};

template <int N>
NACRE_INLINE void addCrossings(const MaskRows& rows, Crossings& crossings, std::int16_t* layers) {
    for (float* column : {crossings.a, crossings.b}) std::fill_n(column + crossings.count, kWide, 0.0f);
    std::fill_n(crossings.row + crossings.count, kWide, 0);
    for (std::size_t i = 0; i < crossings.count; i += kWide) {
        Mask row;
        std::memcpy(&row, crossings.row + i, sizeof(row));
        const Floats cot = load(crossings.a + i) * atRows<N>(rows.cosPhi, row) + load(crossings.b + i) * atRows<N>(rows.sinPhi, row);
        const Floats bounded = larger(cot, Floats{});
        const Mask step = whole(splat(N) / (splat(1) + bounded * bounded) + atRows<N>(rows.dither, row));
        std::int32_t at[kWide];
        store(at, step * N + row);
        const std::size_t end = std::min<std::size_t>(kWide, crossings.count - i);
        for (std::size_t k = 0; k < end; ++k) layers[at[k]] = static_cast<std::int16_t>(layers[at[k]] + crossings.layers[i + k]);
    }
    crossings.count = 0;
}

template <int N>
void addSwept(const MaskRows& rows, Swept& swept, std::int16_t* layers) {
    Crossings crossings;
    for (float(&column)[Swept::kRoom + kWide] : swept.column) std::fill_n(column + swept.count, kWide, 0.0f);
    std::fill_n(swept.rows + swept.count, kWide, 0);
    for (std::size_t i = 0; i < swept.count; i += kWide) {
        const Columns p{load(swept.column[0] + i), load(swept.column[1] + i), load(swept.column[2] + i)};
        const Columns q{load(swept.column[3] + i), load(swept.column[4] + i), load(swept.column[5] + i)};
        Mask packed;
        std::memcpy(&packed, swept.rows + i, sizeof(packed));
        Mask row = packed & (N - 1), more = packed / Swept::kMore;
        const Mask twice = (packed & Swept::kTwice) ? Mask{} + 2 : Mask{} + 1, begun = (packed & Swept::kEnds) ? -twice : twice;
        const Columns n = cross(p, q);
        const Floats least = splat(1e-7f) * (absolute(n.x) + absolute(n.y)) + splat(1e-37f);  // vertical planes
        const Floats inverse = splat(1) / larger(absolute(n.z), least);
        const Mask left = turnsLeft(n.z, p.x, p.y, q.x, q.y);
        const Floats a = choose(left, -n.x, n.x) * inverse, b = choose(left, -n.y, n.y) * inverse;
        unsigned some = swept.count - i >= kWide ? 0xffffu : (1u << (swept.count - i)) - 1;
        while (some) {
            append(crossings.a, crossings.count, a, some);
            append(crossings.b, crossings.count, b, some);
            append(crossings.row, crossings.count, row, some);
            crossings.count = append(crossings.layers, crossings.count, begun, some);
            if (crossings.count > Crossings::kRoom - kWide) addCrossings<N>(rows, crossings, layers);
            row = (row + 1) & (N - 1);
            more -= 1;
            some &= lanes(Mask{} - more);
        }
    }
    addCrossings<N>(rows, crossings, layers);
    swept.count = 0;
}

template <int N>
void add(const MaskRows& rows, const EdgeRow* edges, const Receiver& receiver, std::uint32_t* items, std::size_t count,
         std::int16_t* layers) {
    for (std::size_t k = count; k % kWide; ++k) items[k] = items[count - 1];
    const Floats zero{}, tiny = splat(1e-30f);
    Swept swept;
    for (std::size_t i = 0; i < count; i += kWide) {
        const unsigned used = count - i >= kWide ? 0xffffu : (1u << (count - i)) - 1;
        const float* from[kWide];
        for (std::size_t k = 0; k < kWide; ++k) from[k] = reinterpret_cast<const float*>(edges) + (items[i + k] & ~7u);
        static_assert(sizeof(EdgeRow) == 8 * sizeof(float));
        Floats v[8];
        gather<8>(from, v);
        const Columns d0 = Columns{v[0], v[1], v[2]} - receiver.point, d1 = Columns{v[4], v[5], v[6]} - receiver.point;
        const Columns p{dot(receiver.tangent, d0), dot(receiver.bitangent, d0), dot(receiver.normal, d0)};
        const Columns q{dot(receiver.tangent, d1), dot(receiver.bitangent, d1), dot(receiver.normal, d1)};
        const Mask begin = rowsBefore<N>(rows.tangents, p.x, p.y - tiny), end = rowsBefore<N>(rows.tangents, q.x, q.y - tiny);
        const Mask left = turnsLeft(turning(p.x, p.y, q.x, q.y), p.x, p.y, q.x, q.y);
        Mask sweep = ((end - begin + (N + N / 2)) & (N - 1)) - N / 2;
        sweep = (left & (sweep < -N / 4)) ? sweep + N : sweep;  // past the pole on the side that `left` tells
        sweep = (~left & (sweep > N / 4)) ? sweep - N : sweep;
        const unsigned some = lanes((sweep != 0) & ((p.z > zero) | (q.z > zero))) & used;
        if (some == 0) continue;
        Bits item;
        std::memcpy(&item, items + i, sizeof(item));
        const Mask backwards = sweep < 0, other = as<Mask>(item & DealtEdges::kOther), under = as<Mask>(item & DealtEdges::kUnder);
        const Mask ends = (backwards & 1) ^ other;
        const Mask packed = ((backwards ? end : begin) & (N - 1)) + (under ? Mask{} : ends * Swept::kEnds) +
                            as<Mask>(item & DealtEdges::kTwice) * (Swept::kTwice / 2) + (backwards ? -sweep : sweep) * Swept::kMore;
        const Floats* const columns[6] = {&p.x, &p.y, &p.z, &q.x, &q.y, &q.z};
        for (int c = 0; c < 6; ++c) append(swept.column[c], swept.count, *columns[c], some);
        swept.count = append(swept.rows, swept.count, packed, some);
        if (swept.count > Swept::kRoom - kWide) addSwept<N>(rows, swept, layers);
    }
    addSwept<N>(rows, swept, layers);
}

NACRE_INLINE Mask wide(const std::int16_t* p) {
#if NACRE_SET == 512
    return as<Mask>(_mm512_maskz_cvtepi16_epi32(0xffff, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p))));
#else
    Mask out;
    for (int k = 0; k < kWide; ++k) out[k] = p[k];
    return out;
#endif
}

template <int N>
void finish(const std::int16_t* layers, std::int32_t pole, std::uint32_t* mask) {
    for (int block = 0; block < N / kWide; ++block) {
        Mask sum = Mask{} + pole;
        for (int w = 0; w < (N + 31) / 32; ++w) {
            Bits word{};
            for (int k = 0; k < (N < 32 ? N : 32); ++k) {
                sum += wide(layers + (32 * w + k) * N + kWide * block);
                word |= as<Bits>(sum > 0) & (1u << k);
            }
            store(mask + w * N + kWide * block, word);
        }
    }
}
