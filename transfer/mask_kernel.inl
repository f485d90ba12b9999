// The arithmetic of mask_kernel.hpp; core/wide.inl says where this is compiled.
#include "transfer/vector_parts.inl"

/// atan2(y, x) in rows of N; 1e-5 rad off at most (Abramowitz & Stegun 4.4.49).
template <int N>
NACRE_INLINE Floats azimuthRow(const Floats& x, const Floats& y) {
    const Floats ax = absolute(x), ay = absolute(y);
    const Mask steep = ay > ax;
    const Floats q = choose(steep, ax, ay) / (choose(steep, ay, ax) + splat(1e-37f)), s = q * q;
    Floats a = q * (splat(0.9998660f) +
                    s * (splat(-0.3302995f) + s * (splat(0.1801410f) + s * (splat(-0.0851330f) + s * splat(0.0208351f)))));
    a = choose(steep, splat(1.57079633f) - a, a);
    a = choose(x < Floats{}, splat(3.14159265f) - a, a);
    a = choose(y < Floats{}, -a, a);
    return a * splat(N / 6.2831853f);
}

template <int N>
NACRE_INLINE Floats shorterWay(const Floats& d) {
    return choose(d > splat(N / 2), d - splat(N), choose(d < splat(-N / 2), d + splat(N), d));
}

/// Bits [first, end) of each row as words: those whose cotangent is within [lo, hi], both ≥ 0.
template <int N>
struct RowBits {
    Bits words[(N + 31) / 32];
    NACRE_INLINE RowBits(const Floats& lo, const Floats& hi, const Floats& dither) {
        const Floats one = splat(1), steps = splat(N);
        const Mask end = whole(steps / (one + lo * lo) + dither), first = whole(steps / (one + hi * hi) + dither);
        words[0] = onesFrom(first) & ~onesFrom(end);
        for (int w = 1; w < (N + 31) / 32; ++w) {
            const Mask from = first - 32 * w, to = end - 32 * w;
            words[w] = onesFrom(from > 0 ? from : Mask{}) & ~onesFrom(to > 0 ? to : Mask{});
        }
    }
};

/// Sixteen triangles' edges as cotangents q = a cosφ + b sinφ, sorted: of edges 0 and 1 the first bounds cotθ from below
/// wherever one does, edge 2 from above. `lo` and `hi` are 0 for the bound that an edge is and ∓1e30 for the other.
struct Edges {
    alignas(64) float a[3][kWide], b[3][kWide], lo[3][kWide], hi[3][kWide];
    alignas(64) std::int32_t row[kWide];  ///< first row of the window
    unsigned half, narrow, wide;          ///< lanes: within half a window; within one; those that need all rows
};

template <int N>
NACRE_INLINE void findEdges(const BlockerRow* blockers, const Receiver& receiver, bool bothSides, const std::uint32_t* indices,
                            unsigned used, Edges& edges) {
    Floats v[9];
    gather<9>(blockers, indices, v);
    const Floats zero{}, big = splat(1e30f);
    Columns corner[3], edge[3];
    for (int c = 0; c < 3; ++c) {
        const Columns d = Columns{v[3 * c], v[3 * c + 1], v[3 * c + 2]} - receiver.point;
        corner[c] = {dot(receiver.tangent, d), dot(receiver.bitangent, d), dot(receiver.normal, d)};
    }
    for (int e = 0; e < 3; ++e) {  // the plane through the eye and an edge; a shared edge gives its negative exactly
        const Columns &p = corner[(e + 1) % 3], &q = corner[e];
        edge[e] = {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
    }
    const Floats volume = edge[0].x * corner[2].x + edge[0].y * corner[2].y + edge[0].z * corner[2].z;
    Mask drawn = volume > zero;  // false when the eye lies in the triangle's plane: no solid angle
    if (bothSides) {
        const Mask back = volume < zero;
        for (Columns& e : edge) e = {choose(back, -e.x, e.x), choose(back, -e.y, e.y), choose(back, -e.z, e.z)};
        drawn = volume != zero;
    }
    // Rows r with start ≤ r ≤ end, + 2N to be positive. Arcs that don't pass a pole turn the shorter way.
    const Floats first = azimuthRow<N>(corner[0].x, corner[0].y);
    const Floats turn1 = shorterWay<N>(azimuthRow<N>(corner[1].x, corner[1].y) - first);
    const Floats turn2 = shorterWay<N>(azimuthRow<N>(corner[2].x, corner[2].y) - first);
    constexpr float kMargin = 0.02f;
    const Mask begin = whole(first + smaller(smaller(turn1, turn2), zero) + splat(2 * N + 0.5f - kMargin));
    const Mask last = whole(first + larger(larger(turn1, turn2), zero) + splat(2 * N - 0.5f + kMargin));
    const Mask count = last - begin + 1;

    Floats a[3], b[3];
    Mask below[3];  // bounds cotθ from below
    for (int e = 0; e < 3; ++e) {
        below[e] = edge[e].z >= zero;
        const Floats least = splat(1e-7f) * (absolute(edge[e].x) + absolute(edge[e].y)) + splat(1e-37f);  // vertical planes
        const Floats z = larger(absolute(edge[e].z), least);
        const Floats inverse = splat(-1) / choose(below[e], z, -z);
        a[e] = edge[e].x * inverse;
        b[e] = edge[e].y * inverse;
    }
    // Around a pole there is no shorter way.
    Mask wide = (below[0] & below[1] & below[2]) | ~(below[0] | below[1] | below[2]) | (count > kWide) |
                (larger(absolute(turn1), absolute(turn2)) > splat(0.47f * N));
    for (const Columns& c : corner) wide |= absolute(c.x) + absolute(c.y) <= splat(1e-6f) * absolute(c.z);
    drawn &= wide | (count > 0);

    const auto swapIf = [&](const Mask& k, int i, int j) {
        const Floats ai = a[i], bi = b[i];
        const Mask si = below[i];
        a[i] = choose(k, a[j], ai);
        a[j] = choose(k, ai, a[j]);
        b[i] = choose(k, b[j], bi);
        b[j] = choose(k, bi, b[j]);
        below[i] = k ? below[j] : si;
        below[j] = k ? si : below[j];
    };
    swapIf(~below[0] & below[1], 0, 1);
    swapIf(~below[0] & below[2], 0, 2);
    swapIf(below[2] & ~below[1], 1, 2);
    for (int e = 0; e < 3; ++e) {
        store(edges.a[e], a[e]);
        store(edges.b[e], b[e]);
        store(edges.lo[e], choose(below[e], zero, -big));
        store(edges.hi[e], choose(below[e], big, zero));
    }
    store(edges.row, begin & (N - 1));
    used &= lanes(drawn);
    edges.wide = used & lanes(wide);
    edges.half = used & ~edges.wide & lanes(count <= kWide / 2);
    edges.narrow = used & ~edges.wide & ~edges.half;
}

/// The bits of narrow triangles in some rows: the last three lines of MaskRows' comment for edges that findEdges sorted.
template <int N>
NACRE_INLINE RowBits<N> narrowBits(const Floats (&q)[3], const Floats& lo1, const Floats& hi1, const Floats& dither) {
    const Floats zero{};
    return RowBits<N>(larger(larger(q[0], zero), q[1] + lo1), larger(smaller(q[2], q[1] + hi1), zero), dither);
}

template <int N>
NACRE_INLINE void drawInWindow(const MaskRows& rows, const Edges& edges, int lane, Bits (*bits)[N / kWide]) {
    const MaskRows::Window& window = rows.windows[static_cast<std::size_t>(edges.row[lane])];
    const Floats c = load(window.cosPhi), s = load(window.sinPhi);
    Floats q[3];
    for (int e = 0; e < 3; ++e) q[e] = splat(edges.a[e][lane]) * c + splat(edges.b[e][lane]) * s;
    const RowBits<N> row = narrowBits<N>(q, splat(edges.lo[1][lane]), splat(edges.hi[1][lane]), load(window.dither));
    for (int block = 0; block < N / kWide; ++block) {
        const Bits in = as<Bits>(window.inBlock[block]);
        for (int w = 0; w < (N + 31) / 32; ++w) bits[w][block] |= row.words[w] & in;
    }
}

template <int N>
NACRE_INLINE void drawInAllRows(const MaskRows& rows, const Edges& edges, int lane, Bits (*bits)[N / kWide]) {
    for (int block = 0; block < N / kWide; ++block) {
        const Floats c = load(rows.cosPhi + kWide * block), s = load(rows.sinPhi + kWide * block);
        Floats lo{}, hi = splat(1e15f);
        for (int e = 0; e < 3; ++e) {
            const Floats q = splat(edges.a[e][lane]) * c + splat(edges.b[e][lane]) * s;
            lo = larger(lo, q + splat(edges.lo[e][lane]));
            hi = smaller(hi, q + splat(edges.hi[e][lane]));
        }
        const RowBits<N> row(lo, larger(hi, Floats{}), load(rows.dither + kWide * block));
        for (int w = 0; w < (N + 31) / 32; ++w) bits[w][block] |= row.words[w];
    }
}

#if NACRE_SET == 512
/// Two triangles of at most eight rows each, side by side.
template <int N>
NACRE_INLINE void drawPair(const MaskRows& rows, const Edges& edges, int first, int second, Bits (*bits)[N / kWide]) {
    const MaskRows::HalfWindow& a = rows.halves[static_cast<std::size_t>(edges.row[first])];
    const MaskRows::HalfWindow& b = rows.halves[static_cast<std::size_t>(edges.row[second])];
    const auto both = [](const float* low, const float* high) {
        const __m512 v = _mm512_insertf32x8(_mm512_castps256_ps512(_mm256_load_ps(low)), _mm256_load_ps(high), 1);
        return as<Floats>(v);
    };
    const __m512i which = _mm512_mask_set1_epi32(_mm512_set1_epi32(first), 0xff00, second);
    const auto ofBoth = [&](const float* column) {
        const __m512 v = _mm512_permutexvar_ps(which, _mm512_load_ps(column));
        return as<Floats>(v);
    };
    const Floats c = both(a.cosPhi, b.cosPhi), s = both(a.sinPhi, b.sinPhi);
    Floats q[3];
    for (int e = 0; e < 3; ++e) q[e] = ofBoth(edges.a[e]) * c + ofBoth(edges.b[e]) * s;
    const RowBits<N> row = narrowBits<N>(q, ofBoth(edges.lo[1]), ofBoth(edges.hi[1]), both(a.dither, b.dither));
    for (int w = 0; w < (N + 31) / 32; ++w) {
        const __m512i r = as<__m512i>(row.words[w]);
        const Bits low = as<Bits>(_mm512_shuffle_i64x2(r, r, 0x44)), high = as<Bits>(_mm512_shuffle_i64x2(r, r, 0xee));
        for (int block = 0; block < N / kWide; ++block) {
            const Bits inA = as<Bits>(a.inBlock[block]), inB = as<Bits>(b.inBlock[block]);
            bits[w][block] |= (low & inA) | (high & inB);
        }
    }
}
#endif

template <int N>
NACRE_INLINE bool isFull(const Bits (*bits)[N / kWide]) {
    Bits all = ~Bits{};
    for (int w = 0; w < (N + 31) / 32; ++w)
        for (int block = 0; block < N / kWide; ++block) all &= bits[w][block];
    constexpr std::uint32_t kRow = N < 32 ? (1u << (N % 32)) - 1 : ~0u;
    const auto missing = static_cast<Mask>((all & kRow) != kRow);
    return !any(missing);
}

template <int N>
void draw(const MaskRows& rows, const BlockerRow* blockers, const Receiver& receiver, bool bothSides,
          std::uint32_t* indices, std::size_t count, std::uint32_t* mask) {
    Bits bits[(N + 31) / 32][N / kWide];
    std::memcpy(bits, mask, sizeof(bits));
    Edges edges;
    for (std::size_t k = count; k % kWide; ++k) indices[k] = indices[count - 1];
    for (std::size_t i = 0; i < count; i += kWide) {
        const unsigned used = count - i >= kWide ? 0xffffu : (1u << (count - i)) - 1;
        findEdges<N>(blockers, receiver, bothSides, indices + i, used, edges);
#if NACRE_SET == 512
        for (unsigned left = edges.half; left;) {
            const int first = __builtin_ctz(left);
            left &= left - 1;
            const int second = left ? __builtin_ctz(left) : first;
            left &= left - 1;
            drawPair<N>(rows, edges, first, second, bits);
        }
#else
        edges.narrow |= edges.half;
#endif
        for (unsigned left = edges.narrow; left; left &= left - 1)
            drawInWindow<N>(rows, edges, __builtin_ctz(left), bits);
        for (unsigned left = edges.wide; left; left &= left - 1)
            drawInAllRows<N>(rows, edges, __builtin_ctz(left), bits);
        if (isFull<N>(bits)) break;
    }
    std::memcpy(mask, bits, sizeof(bits));
}

template <int N>
void integrate(const MaskIntegrals& tables, const std::uint32_t* mask, float* sums) {
    constexpr std::size_t kWords = (N + 31) / 32, kFours = N < 32 ? N / 4 : 8;
    const std::size_t stride = static_cast<std::size_t>(tables.groups) * kWide;
    for (std::size_t group = 0; group < static_cast<std::size_t>(tables.groups); ++group) {
        const std::int16_t* fours = tables.fours.data() + group * kWide;
        Floats cosines{}, sines{};
        for (std::size_t r = 0; r < N; ++r) {
            Floats row{};
            for (std::size_t w = 0; w < kWords; ++w) {
                std::uint32_t word = mask[w * N + r];
                Shorts sum{};
                for (std::size_t four = 0; four < kFours; ++four, word >>= 4) {
                    Shorts part;
                    std::memcpy(&part, fours + ((w * 8 + four) * 16 + (word & 15)) * stride, sizeof(part));
                    sum += part;
                }
                row += __builtin_convertvector(sum, Floats);
            }
            cosines += row * load(&tables.rowCos[r * stride + group * kWide]);
            sines += row * load(&tables.rowSin[r * stride + group * kWide]);
        }
        store(sums + 2 * kWide * group, cosines);
        store(sums + 2 * kWide * group + kWide, sines);
    }
}
