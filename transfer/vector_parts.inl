// What the kernels of this room share; core/wide.inl says where this is compiled.
typedef std::uint32_t Bits __attribute__((vector_size(4 * kWide)));
typedef std::int16_t Shorts __attribute__((vector_size(2 * kWide)));

NACRE_INLINE Floats splat(float x) { return Floats{} + x; }
NACRE_INLINE Floats choose(const Mask& m, const Floats& a, const Floats& b) { return m ? a : b; }
/// Towards zero.
NACRE_INLINE Mask whole(const Floats& v) { return __builtin_convertvector(v, Mask); }
template <class V>
NACRE_INLINE void store(void* to, const V& v) {
    std::memcpy(to, &v, sizeof(v));
}

template <class To, class From>
NACRE_INLINE To as(const From& v) {
    To out;
    std::memcpy(&out, &v, sizeof(out));
    return out;
}

NACRE_INLINE Floats absolute(const Floats& v) { return as<Floats>(as<Bits>(v) & 0x7fffffffu); }

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

/// Appends the values of the lanes in `bits`; writes up to sixteen. \return the new count
template <class V>
NACRE_INLINE std::size_t append(void* out, std::size_t count, const V& values, unsigned bits) {
#if NACRE_SET == 512
    __m512i v;
    std::memcpy(&v, &values, sizeof(v));
    _mm512_storeu_si512(static_cast<std::uint32_t*>(out) + count, _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), v));
    return count + static_cast<std::size_t>(__builtin_popcount(bits));
#else
    std::uint32_t v[kWide];
    std::memcpy(v, &values, sizeof(v));
    for (; bits; bits &= bits - 1) static_cast<std::uint32_t*>(out)[count++] = v[__builtin_ctz(bits)];
    return count;
#endif
}

/// Sixteen rows of numbers as columns: the first Count numbers of each.
template <int Count>
NACRE_INLINE void gather(const float* const (&from)[kWide], Floats* columns) {
#if NACRE_SET == 512
    for (int part = 0; 4 * part < Count; ++part) {  // four numbers of each: four quarters a vector, then turned within them
        __m512 z[4];
        for (int k = 0; k < 4; ++k) {
            z[k] = _mm512_castps128_ps512(_mm_load_ps(from[k] + 4 * part));
            z[k] = _mm512_insertf32x4(z[k], _mm_load_ps(from[k + 4] + 4 * part), 1);
            z[k] = _mm512_insertf32x4(z[k], _mm_load_ps(from[k + 8] + 4 * part), 2);
            z[k] = _mm512_insertf32x4(z[k], _mm_load_ps(from[k + 12] + 4 * part), 3);
        }
        const __m512d low01 = _mm512_castps_pd(_mm512_unpacklo_ps(z[0], z[1]));
        const __m512d high01 = _mm512_castps_pd(_mm512_unpackhi_ps(z[0], z[1]));
        const __m512d low23 = _mm512_castps_pd(_mm512_unpacklo_ps(z[2], z[3]));
        const __m512d high23 = _mm512_castps_pd(_mm512_unpackhi_ps(z[2], z[3]));
        const __m512d turned[4] = {_mm512_unpacklo_pd(low01, low23), _mm512_unpackhi_pd(low01, low23),
                                   _mm512_unpacklo_pd(high01, high23), _mm512_unpackhi_pd(high01, high23)};
        for (int c = 0; c < 4 && 4 * part + c < Count; ++c) std::memcpy(&columns[4 * part + c], &turned[c], sizeof(Floats));
    }
#else
    for (int k = 0; k < kWide; ++k)
        for (int c = 0; c < Count; ++c) columns[c][k] = from[k][c];
#endif
}
template <int Count>
NACRE_INLINE void gather(const BlockerRow* rows, const std::uint32_t* indices, Floats* columns) {
    const float* from[kWide];
    for (int k = 0; k < kWide; ++k) from[k] = rows[indices[k]].corners;
    gather<Count>(from, columns);
}

struct Columns {
    Floats x, y, z;
};
NACRE_INLINE Floats dot(const glm::vec3& a, const Columns& b) { return fused(splat(a.z), b.z, fused(splat(a.y), b.y, splat(a.x) * b.x)); }
NACRE_INLINE Floats dot(const Columns& a, const Columns& b) { return fused(a.z, b.z, fused(a.y, b.y, a.x * b.x)); }
NACRE_INLINE Columns cross(const Columns& a, const Columns& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
NACRE_INLINE Columns operator-(const Columns& a, const Columns& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
NACRE_INLINE Columns operator-(const Columns& a, const glm::vec3& b) { return {a.x - splat(b.x), a.y - splat(b.y), a.z - splat(b.z)}; }
NACRE_INLINE Floats lengthOf(const Columns& v) { return root(v.x * v.x + v.y * v.y + v.z * v.z); }
