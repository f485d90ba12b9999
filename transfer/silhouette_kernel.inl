// The arithmetic of silhouette_kernel.hpp; core/wide.inl says where this is compiled.
#include "transfer/vector_parts.inl"

NACRE_INLINE Columns columnsOf(const float (&v)[3][kLanes]) { return {load(v[0]), load(v[1]), load(v[2])}; }
NACRE_INLINE Columns from(const float* p, const Columns& q) { return {splat(p[0]) - q.x, splat(p[1]) - q.y, splat(p[2]) - q.z}; }

void place(const glm::vec3* points, const glm::uvec3* triangles, std::size_t count, TriangleCluster& out) {
    for (int t = 0; t < kLanes; ++t)
        for (int c = 0; c < 3; ++c) {
            const glm::vec3& p = points[triangles[t][c]];
            for (int axis = 0; axis < 3; ++axis) out.corners[3 * c + axis][t] = p[axis];
        }
    Columns corners[3];
    for (int c = 0; c < 3; ++c) corners[c] = {load(out.corners[3 * c]), load(out.corners[3 * c + 1]), load(out.corners[3 * c + 2])};
    const auto& [a, b, c] = corners;
    const Columns n = cross(b - a, c - a);
    const Floats length = lengthOf(n), inverse = choose(length > Floats{}, splat(1) / larger(length, splat(1e-37f)), Floats{});
    const Columns unit{n.x * inverse, n.y * inverse, n.z * inverse};
    store(out.normal[0], unit.x), store(out.normal[1], unit.y), store(out.normal[2], unit.z);
    store(out.offset, dot(unit, a));
    const Floats third = splat(1.0f / 3);
    const Columns middle{(a.x + b.x + c.x) * third, (a.y + b.y + c.y) * third, (a.z + b.z + c.z) * third};
    store(out.middle[0], middle.x), store(out.middle[1], middle.y), store(out.middle[2], middle.z);
    Floats reach{};
    for (const Columns& p : corners) {
        const Columns d = p - middle;
        reach = larger(reach, dot(d, d));
    }
    store(out.reach, root(reach));
    const auto ends = [&](const Floats& x, const Floats& y, const Floats& z, float& low, float& high) {
        float lows[kWide], highs[kWide];
        store(lows, smaller(x, smaller(y, z)));
        store(highs, larger(x, larger(y, z)));
        low = *std::min_element(lows, lows + count);
        high = *std::max_element(highs, highs + count);
    };
    glm::vec3 low, high;
    ends(a.x, b.x, c.x, low.x, high.x);
    ends(a.y, b.y, c.y, low.y, high.y);
    ends(a.z, b.z, c.z, low.z, high.z);
    const glm::vec3 centre = 0.5f * (low + high);
    float radii[kWide];
    Floats radius{};
    for (const Columns& p : corners) {
        const Columns d = p - centre;
        radius = larger(radius, dot(d, d));
    }
    store(radii, root(radius));
    out.radius = *std::max_element(radii, radii + count);
    for (int axis = 0; axis < 3; ++axis) out.centre[axis] = centre[axis];
}

ClusterFlags classify(const TriangleCluster& b, const ReceiverLanes& receivers) {
    const Columns d = from(b.centre, columnsOf(receivers.point));
    const Floats radius = splat(b.radius), height = dot(columnsOf(receivers.normal), d);
    const Mask above = height + radius > Floats{};
    return {lanes(above), lanes(above & (dot(d, d) - height * height <= splat(1.0001f) * radius * radius + splat(kRounding * kRounding)))};
}

NACRE_INLINE Mask upwards() {
    Mask out;
    for (int k = 0; k < kWide; ++k) out[k] = k;
    return out;
}

/// The lanes whose bits are set.
NACRE_INLINE Mask chosen(std::uint32_t bits) {
    return ((Bits{} + 1u) << as<Bits>(upwards()) & bits) != 0;
}

ClusterFaces face(const TriangleCluster& cluster, const ReceiverLanes& receivers, bool one, std::uint32_t seen, std::uint32_t members,
                  const std::uint32_t* own, std::uint32_t* out) {
    // Which side a box about the receivers is on, where it is on one; each of them else.
    const Columns n{load(cluster.normal[0]), load(cluster.normal[1]), load(cluster.normal[2])};
    const Floats front = dot(receivers.box.middle, n) - load(cluster.offset), least = splat(kFacing);
    const Floats margin = one ? Floats{} : dot(receivers.box.half, Columns{absolute(n.x), absolute(n.y), absolute(n.z)}) + splat(kRounding);
    const Mask ahead = front > margin, behind = one ? ~ahead : front < -margin;
    store(out, ((as<Bits>(ahead) & (seen & 0xffffu)) | (as<Bits>(behind) & (seen & 0xffff0000u))) & as<Bits>(chosen(members)));
    const unsigned facing = seen & 0xffffu ? lanes(ahead) & members : 0, away = seen >> 16 ? lanes(behind) & members : 0;
    unsigned left = one ? 0 : ~lanes(ahead | behind) & members;
    const bool alike = left == 0 && ((facing | away) == 0 || facing == 0xffff || away == 0xffff);
    std::uint32_t some = (facing ? seen & 0xffffu : 0) | (away ? seen & 0xffff0000u : 0);
    const Columns points = columnsOf(receivers.point), normals = columnsOf(receivers.normal);
    for (; left; left &= left - 1) {  // those that the triangle meets are in its plane, so that it's among these
        const int t = __builtin_ctz(left);
        const glm::vec3 normal(cluster.normal[0][t], cluster.normal[1][t], cluster.normal[2][t]);
        const Floats off = dot(normal, points) - splat(cluster.offset[t]);
        const Mask touched = (absolute(off) <= least) & (dot(normal, normals) < Floats{});
        some |= out[t] = (lanes((off > least) | touched) | lanes(off < -least) << 16) & seen & ~own[t];
    }
    return {some, alike};
}

void differ(const EdgeSides& edges, const std::uint32_t* sides, const std::uint8_t* look, DifferingEdges& out) {
    std::size_t count = 0;
    std::uint32_t *const edge = out.edge.data(), *const differing = out.sides.data(), *const first = out.first.data();
    const std::size_t clusters = edges.between.size();
#if NACRE_SET == 512
    const __m512i zero = _mm512_setzero_si512(), numbers = as<__m512i>(upwards());
    const auto add = [&](std::size_t e, const __m512i& a, const __m512i& b) {
        const unsigned some = _mm512_cmpneq_epi32_mask(a, b);
        append(edge, count, _mm512_add_epi32(_mm512_set1_epi32(static_cast<int>(e)), numbers), some);
        append(differing, count, _mm512_xor_si512(a, b), some);
        count = append(first, count, a, some);
    };
    for (std::size_t c = 0; c < clusters; ++c) {
        if (look[c] & kInside) {
            const __m512i own = _mm512_loadu_si512(sides + kLanes * c);  // places modulo 16 are lanes
            for (std::size_t e = edges.inside[c]; e < edges.between[c]; e += kWide)
                add(e, _mm512_permutexvar_epi32(_mm512_loadu_si512(&edges.a[e]), own), _mm512_permutexvar_epi32(_mm512_loadu_si512(&edges.b[e]), own));
        }
        if (look[c] & kBetween)
            for (std::size_t e = edges.between[c]; e < edges.inside[c + 1]; e += kWide)
                add(e, _mm512_mask_i32gather_epi32(zero, 0xffff, _mm512_loadu_si512(&edges.a[e]), sides, 4), _mm512_mask_i32gather_epi32(zero, 0xffff, _mm512_loadu_si512(&edges.b[e]), sides, 4));
    }
#else
    const auto add = [&](std::size_t from, std::size_t end) {
        for (std::size_t e = from; e < end; ++e) {
            const std::uint32_t a = sides[edges.a[e]], some = a ^ sides[edges.b[e]];
            edge[count] = static_cast<std::uint32_t>(e);
            differing[count] = some;
            first[count] = a;
            count += some != 0;
        }
    };
    for (std::size_t c = 0; c < clusters; ++c) {
        if (look[c] & kInside) add(edges.inside[c], edges.between[c]);
        if (look[c] & kBetween) add(edges.between[c], edges.inside[c + 1]);
    }
#endif
    out.count = count;
    for (std::vector<std::uint32_t>* column : {&out.edge, &out.sides, &out.first}) std::memset(column->data() + out.count, 0, sizeof(Bits));
}

/// Twice the area of the pole and an edge, seen along the pole.
NACRE_INLINE Floats turning(const Floats& x0, const Floats& y0, const Floats& x1, const Floats& y1) { return x0 * y1 - x1 * y0; }

/// Whether the edge turns about the pole the way that azimuths grow; the opposite for the edge reversed. An edge right
/// through the pole passes beside (0, ε): `rowsBefore` of y − 1e-30 agrees with that.
NACRE_INLINE Mask turnsLeft(const Floats& turn, const Floats& x0, const Floats& y0, const Floats& x1, const Floats& y1) {
    return (turn > Floats{}) | ((turn == Floats{}) & ((x1 > x0) | ((x1 == x0) & (y1 > y0))));
}

/// A number of the triangles at sixteen places.
NACRE_INLINE Floats atPlaces(const float* clusters, const Mask& places, int column) {
    constexpr int kStride = sizeof(TriangleCluster) / sizeof(float);
    static_assert(offsetof(TriangleCluster, corners) == 0);
    const Mask at = (places >> 4) * kStride + (places & 15) + column * kLanes;
#if NACRE_SET == 512
    return as<Floats>(_mm512_i32gather_ps(as<__m512i>(at), clusters, 4));
#else
    Floats out;
    for (int k = 0; k < kWide; ++k) out[k] = clusters[at[k]];
    return out;
#endif
}

void nearPole(const TriangleCluster& cluster, std::uint32_t number, const Receiver* receivers, std::uint32_t which, const std::uint32_t* faces,
              PoleTriangles& out) {
    const Columns middle = columnsOf(cluster.middle);
    Floats reach = splat(1.0001f) * load(cluster.reach) + splat(1e-5f);
    reach = reach * reach;
    Bits words;
    std::memcpy(&words, faces, sizeof(words));
    const Bits places = (as<Bits>(upwards()) + kLanes * number) << 1;
    for (; which; which &= which - 1) {
        const int k = __builtin_ctz(which);
        const Receiver& r = receivers[k];
        const Columns d = middle - r.point;
        const Floats x = dot(r.tangent, d), y = dot(r.bitangent, d);
        const Bits seen = words & (0x10001u << k);
        const Mask near = (fused(x, x, y * y) <= reach) & (seen != 0);
        const Bits item = places | (as<Bits>(seen > 0xffffu) & 1u);
        out.counts[k] = append(out.items.data() + static_cast<std::size_t>(k) * out.room, out.counts[k], item, lanes(near));
    }
}

std::int32_t overhead(const TriangleCluster* clusters, std::uint32_t* items, std::size_t count, const Receiver& receiver) {
    std::int32_t layers = 0;
    for (std::size_t k = count; k % kWide; ++k) items[k] = items[count - 1];
    for (std::size_t i = 0; i < count; i += kWide) {
        const unsigned used = count - i >= kWide ? 0xffffu : (1u << (count - i)) - 1;
        Bits item;
        std::memcpy(&item, items + i, sizeof(item));
        const Mask back = as<Mask>(item << 31);
        Floats x[3], y[3], lowest = splat(1e30f);
        for (int c = 0; c < 3; ++c) {
            Columns d;
            Floats* const xyz[3] = {&d.x, &d.y, &d.z};
            for (int axis = 0; axis < 3; ++axis)
                *xyz[axis] = atPlaces(reinterpret_cast<const float*>(clusters), as<Mask>(item >> 1), 3 * c + axis);
            d = d - receiver.point;
            x[c] = dot(receiver.tangent, d);
            y[c] = dot(receiver.bitangent, d);
            lowest = smaller(lowest, dot(receiver.normal, d));
        }
        // A front turns clockwise about a pole that it hides, seen from above; a back the other way.
        Mask all = Mask{} - 1, some{};
        for (int c = 0; c < 3; ++c) {
            const int e = (c + 1) % 3;
            const Mask left = turnsLeft(turning(x[c], y[c], x[e], y[e]), x[c], y[c], x[e], y[e]);
            all &= left;
            some |= left;
        }
        const Mask right = ~some, over = lowest > Floats{};  // below, both turn the other way
        layers += __builtin_popcount(lanes((all & back) | (right & ~back)) & used);
        layers -= __builtin_popcount(lanes(((all & ~back) | (right & back)) & over) & used);
    }
    return layers;
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
        const Floats cot = fused(load(crossings.b + i), atRows<N>(rows.sinPhi, row), load(crossings.a + i) * atRows<N>(rows.cosPhi, row));
        const Floats bounded = larger(cot, Floats{});
        const Mask step = whole(splat(N) / fused(bounded, bounded, splat(1)) + atRows<N>(rows.dither, row));
        store(crossings.row + i, step * N + row);
    }
    for (std::size_t i = 0; i < crossings.count; ++i) {  // of its own: numbers out of a vector are dearer than from memory
        std::int16_t& layer = layers[crossings.row[i]];
        layer = static_cast<std::int16_t>(layer + crossings.layers[i]);
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
        constexpr int kFew = 3;  // lanes: from then on edge by edge
        while (__builtin_popcount(some) > kFew) {
            const std::size_t count = crossings.count;
            append(crossings.a, count, a, some);
            append(crossings.b, count, b, some);
            append(crossings.row, count, row, some);
            crossings.count = append(crossings.layers, count, begun, some);
            if (crossings.count > Crossings::kRoom - kWide) addCrossings<N>(rows, crossings, layers);
            row = (row + 1) & (N - 1);
            more -= 1;
            some &= lanes(Mask{} - more);
        }
        for (; some; some &= some - 1) {
            const int lane = __builtin_ctz(some);
            for (std::int32_t r = 0; r < more[lane]; r += kWide) {
                const std::size_t count = crossings.count;
                store(crossings.a + count, splat(a[lane]));
                store(crossings.b + count, splat(b[lane]));
                store(crossings.row + count, (upwards() + row[lane] + r) & (N - 1));
                store(crossings.layers + count, Mask{} + begun[lane]);
                crossings.count += static_cast<std::size_t>(std::min(more[lane] - r, kWide));
                if (crossings.count > Crossings::kRoom - kWide) addCrossings<N>(rows, crossings, layers);
            }
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
        const std::size_t before = swept.count;
        for (int c = 0; c < 6; ++c) append(swept.column[c], before, *columns[c], some);
        swept.count = append(swept.rows, before, packed, some);
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
