// The arithmetic of mask_kernel.hpp; core/wide.inl says where this is compiled.
typedef std::uint32_t Bits __attribute__((vector_size(4 * kWide)));
typedef std::int16_t Shorts __attribute__((vector_size(2 * kWide)));

NACRE_INLINE Floats splat(float x) { return Floats{} + x; }
NACRE_INLINE Floats choose(const Mask& m, const Floats& a, const Floats& b) { return m ? a : b; }
NACRE_INLINE Floats absolute(const Floats& v) { return v < Floats{} ? -v : v; }
/// Towards zero.
NACRE_INLINE Mask whole(const Floats& v) { return __builtin_convertvector(v, Mask); }
template <class V>
NACRE_INLINE void store(void* to, const V& v) {
    std::memcpy(to, &v, sizeof(v));
}

/// Ones from bit `count` on; none from 32 on. \param count  ≥ 0
NACRE_INLINE Bits onesFrom(const Mask& count) {
#if NACRE_SET == 512
    __m512i c;
    std::memcpy(&c, &count, sizeof(c));
    c = _mm512_sllv_epi32(_mm512_set1_epi32(-1), c);
    Bits bits;
    std::memcpy(&bits, &c, sizeof(c));
    return bits;
#elif NACRE_SET == 2
    __m256i c[2];
    std::memcpy(c, &count, sizeof(c));
    for (__m256i& half : c) half = _mm256_sllv_epi32(_mm256_set1_epi32(-1), half);
    Bits bits;
    std::memcpy(&bits, c, sizeof(c));
    return bits;
#else
    const Bits c = reinterpret_cast<const Bits&>(count);
    return reinterpret_cast<const Bits&>(static_cast<const Mask&>(count < 32)) & (~Bits{} << (c & 31));
#endif
}

/// The lanes' signs as bits.
NACRE_INLINE unsigned lanes(const Mask& m) {
#if NACRE_SET == 512
    __m512i v;
    std::memcpy(&v, &m, sizeof(v));
    return _mm512_movepi32_mask(v);
#elif NACRE_SET == 2
    __m256 v[2];
    std::memcpy(v, &m, sizeof(v));
    return static_cast<unsigned>(_mm256_movemask_ps(v[0])) | static_cast<unsigned>(_mm256_movemask_ps(v[1])) << 8;
#else
    unsigned bits = 0;
    for (int i = 0; i < kWide; ++i) bits |= static_cast<unsigned>(m[i] < 0) << i;
    return bits;
#endif
}

/// Appends first, first + 1, … of the lanes in `bits`. \return the new count
NACRE_INLINE int append(std::uint32_t* out, int count, std::uint32_t first, unsigned bits) {
#if NACRE_SET == 512
    const __m512i all = _mm512_add_epi32(_mm512_set1_epi32(static_cast<int>(first)),
                                         _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
    _mm512_storeu_si512(out + count, _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), all));
    return count + __builtin_popcount(bits);
#else
    for (; bits; bits &= bits - 1) out[count++] = first + static_cast<unsigned>(__builtin_ctz(bits));
    return count;
#endif
}

/// The nine coordinates of sixteen triangles.
NACRE_INLINE void gather(const float* byTriangle, const std::uint32_t* indices, Floats* v) {
#if NACRE_SET == 512
    const float* from[16];
    for (int k = 0; k < 16; ++k) from[k] = byTriangle + 12 * std::size_t{indices[k]};
    for (int part = 0; part < 3; ++part) {  // four numbers of each: rows of four quarters, then turned within quarters
        __m512 z[4];
        for (int k = 0; k < 4; ++k) {
            z[k] = _mm512_castps128_ps512(_mm_loadu_ps(from[k] + 4 * part));
            z[k] = _mm512_insertf32x4(z[k], _mm_loadu_ps(from[k + 4] + 4 * part), 1);
            z[k] = _mm512_insertf32x4(z[k], _mm_loadu_ps(from[k + 8] + 4 * part), 2);
            z[k] = _mm512_insertf32x4(z[k], _mm_loadu_ps(from[k + 12] + 4 * part), 3);
        }
        const __m512d low01 = _mm512_castps_pd(_mm512_unpacklo_ps(z[0], z[1]));
        const __m512d high01 = _mm512_castps_pd(_mm512_unpackhi_ps(z[0], z[1]));
        const __m512d low23 = _mm512_castps_pd(_mm512_unpacklo_ps(z[2], z[3]));
        const __m512d high23 = _mm512_castps_pd(_mm512_unpackhi_ps(z[2], z[3]));
        const __m512d turned[4] = {_mm512_unpacklo_pd(low01, low23), _mm512_unpackhi_pd(low01, low23),
                                   _mm512_unpacklo_pd(high01, high23), _mm512_unpackhi_pd(high01, high23)};
        for (int c = 0; c < 4 && 4 * part + c < 9; ++c) std::memcpy(&v[4 * part + c], &turned[c], sizeof(Floats));
    }
#else
    for (int k = 0; k < kWide; ++k)
        for (int c = 0; c < 9; ++c) v[c][k] = byTriangle[12 * std::size_t{indices[k]} + static_cast<std::size_t>(c)];
#endif
}

struct Columns {
    Floats x, y, z;
};
NACRE_INLINE Floats dot(const glm::vec3& a, const Columns& b) { return splat(a.x) * b.x + splat(a.y) * b.y + splat(a.z) * b.z; }

int cull(const BlockerList& list, const Receiver& receiver, float above, bool bothSides, std::uint32_t* out) {
    const glm::vec3& p = receiver.point;
    const glm::vec3& n = receiver.normal;
    const Floats height = splat(n.x * p.x + n.y * p.y + n.z * p.z + above);
    int count = 0;
    for (std::size_t i = 0; i < list.count; i += kWide) {
        Floats highest{};
        for (int c = 0; c < 3; ++c) {
            const std::vector<float>* xyz = list.corners + 3 * c;
            const Floats z = dot(n, {load(&xyz[0][i]), load(&xyz[1][i]), load(&xyz[2][i])});
            highest = c == 0 ? z : larger(highest, z);
        }
        Mask keep = highest > height;
        if (!bothSides)
            keep &= dot(p, {load(&list.plane[0][i]), load(&list.plane[1][i]), load(&list.plane[2][i])}) > load(&list.plane[3][i]);
        const std::size_t left = list.count - i;
        const unsigned used = left >= kWide ? 0xffffu : (1u << left) - 1;
        count = append(out, count, static_cast<std::uint32_t>(i), lanes(keep) & used);
    }
    return count;
}

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
    unsigned narrow, wide;                ///< lanes: within a window; those that need all rows
};

template <int N>
NACRE_INLINE void findEdges(const float* byTriangle, const Receiver& receiver, bool bothSides, const std::uint32_t* indices,
                            unsigned used, Edges& edges) {
    Floats v[9];
    gather(byTriangle, indices, v);
    const Floats zero{}, big = splat(1e30f);
    Columns corner[3], edge[3];
    for (int c = 0; c < 3; ++c) {
        const Columns d = {v[3 * c] - splat(receiver.point.x), v[3 * c + 1] - splat(receiver.point.y),
                           v[3 * c + 2] - splat(receiver.point.z)};
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
    edges.narrow = used & ~edges.wide;
}

template <int N>
void draw(const MaskRows& rows, const float* byTriangle, const Receiver& receiver, bool bothSides, std::uint32_t* indices,
          int count, std::uint32_t* mask) {
    constexpr int kWords = (N + 31) / 32, kBlocks = N / kWide;
    Bits bits[kWords][kBlocks];
    std::memcpy(bits, mask, sizeof(bits));
    const Floats zero{};
    Edges edges;
    for (int k = count; k % kWide; ++k) indices[k] = indices[count - 1];
    for (int i = 0; i < count; i += kWide) {
        findEdges<N>(byTriangle, receiver, bothSides, indices + i, count - i >= kWide ? 0xffffu : (1u << (count - i)) - 1,
                     edges);
        for (unsigned left = edges.narrow; left; left &= left - 1) {
            const int lane = __builtin_ctz(left);
            const MaskRows::Window& window = rows.windows[static_cast<std::size_t>(edges.row[lane])];
            const Floats c = load(window.cosPhi), s = load(window.sinPhi);
            const Floats middle = splat(edges.a[1][lane]) * c + splat(edges.b[1][lane]) * s;
            const Floats lo = larger(larger(splat(edges.a[0][lane]) * c + splat(edges.b[0][lane]) * s, zero),
                                     middle + splat(edges.lo[1][lane]));
            const Floats hi = larger(smaller(splat(edges.a[2][lane]) * c + splat(edges.b[2][lane]) * s,
                                             middle + splat(edges.hi[1][lane])), zero);
            const RowBits<N> row(lo, hi, load(window.dither));
            for (int block = 0; block < kBlocks; ++block) {
                Bits in;
                std::memcpy(&in, window.inBlock[block], sizeof(in));
                for (int w = 0; w < kWords; ++w) bits[w][block] |= row.words[w] & in;
            }
        }
        for (unsigned left = edges.wide; left; left &= left - 1) {
            const int lane = __builtin_ctz(left);
            for (int block = 0; block < kBlocks; ++block) {
                const Floats c = load(rows.cosPhi + kWide * block), s = load(rows.sinPhi + kWide * block);
                Floats lo = zero, hi = splat(1e15f);
                for (int e = 0; e < 3; ++e) {
                    const Floats q = splat(edges.a[e][lane]) * c + splat(edges.b[e][lane]) * s;
                    lo = larger(lo, q + splat(edges.lo[e][lane]));
                    hi = smaller(hi, q + splat(edges.hi[e][lane]));
                }
                const RowBits<N> row(lo, larger(hi, zero), load(rows.dither + kWide * block));
                for (int w = 0; w < kWords; ++w) bits[w][block] |= row.words[w];
            }
        }
    }
    std::memcpy(mask, bits, sizeof(bits));
}

template <int N>
void integrate(const MaskIntegrals& tables, const std::uint32_t* mask, float* sums) {
    constexpr int kWords = (N + 31) / 32, kBytes = N < 32 ? N / 8 : 4;
    const std::size_t lanesOf = static_cast<std::size_t>(tables.groups) * kWide;
    for (int group = 0; group < tables.groups; ++group) {
        Floats cosines{}, sines{};
        for (std::size_t r = 0; r < N; ++r) {
            Floats row{};
            for (std::size_t w = 0; w < kWords; ++w) {
                std::uint32_t word = mask[w * N + r];
                Shorts sum{};
                for (std::size_t byte = 0; byte < kBytes; ++byte, word >>= 8) {
                    Shorts part;
                    std::memcpy(&part, &tables.bytes[((w * 4 + byte) * 256 + (word & 255)) * lanesOf + group * kWide], sizeof(part));
                    sum += part;
                }
                row += __builtin_convertvector(sum, Floats);
            }
            cosines += row * load(&tables.rowCos[r * lanesOf + group * kWide]);
            sines += row * load(&tables.rowSin[r * lanesOf + group * kWide]);
        }
        store(sums + 2 * kWide * group, cosines);
        store(sums + 2 * kWide * group + kWide, sines);
    }
}
