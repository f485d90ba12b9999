// Compiles a file of vector arithmetic for each instruction set, each in a namespace of its own: the compiler lowers a
// vector for the set that is in force where a function is written. To be included inside an anonymous namespace, with
// NACRE_KERNEL the file's name; NACRE_WIDEST(f) is then the f of the widest set that this processor has. All give the
// same bits where the compiler fuses nothing of its own accord (the CMakeLists.txt of the rooms that include it).
//
// Each namespace has: Floats (16), Mask, load, larger, smaller, root, fused, any.
#define NACRE_INLINE inline __attribute__((always_inline))

#define NACRE_SET 1
namespace plain {
#include "core/wide_types.inl"
inline bool any(const Mask& m) {
    std::int64_t parts[kWide / 2], all = 0;
    std::memcpy(parts, &m, sizeof(m));
    for (const std::int64_t part : parts) all |= part;
    return all != 0;
}
NACRE_INLINE Floats fused(const Floats& a, const Floats& b, const Floats& c) {
    Floats out;
    for (int k = 0; k < kWide; ++k) out[k] = __builtin_fmaf(a[k], b[k], c[k]);
    return out;
}
#include NACRE_KERNEL
}  // namespace plain
#undef NACRE_SET

#if defined(__x86_64__)
#pragma GCC push_options
#pragma GCC target("avx2,fma")
#define NACRE_SET 2
namespace avx2 {
#include "core/wide_types.inl"
NACRE_INLINE bool any(const Mask& m) {
    __m256i halves[2];
    std::memcpy(halves, &m, sizeof(m));
    const __m256i both = _mm256_or_si256(halves[0], halves[1]);
    return !_mm256_testz_si256(both, both);
}
NACRE_INLINE Floats fused(const Floats& a, const Floats& b, const Floats& c) {
    __m256 x[2], y[2], z[2];
    std::memcpy(x, &a, sizeof(a));
    std::memcpy(y, &b, sizeof(b));
    std::memcpy(z, &c, sizeof(c));
    for (int k = 0; k < 2; ++k) z[k] = _mm256_fmadd_ps(x[k], y[k], z[k]);
    Floats out;
    std::memcpy(&out, z, sizeof(out));
    return out;
}
#include NACRE_KERNEL
}  // namespace avx2
#undef NACRE_SET
#pragma GCC pop_options

#pragma GCC push_options
#pragma GCC target("fma,avx512f,avx512dq,avx512bw,avx512vl,prefer-vector-width=512")
#define NACRE_SET 512
namespace avx512 {
#include "core/wide_types.inl"
NACRE_INLINE bool any(const Mask& m) {
    __m512i bits;
    std::memcpy(&bits, &m, sizeof(m));
    return _mm512_test_epi32_mask(bits, bits) != 0;
}
NACRE_INLINE Floats fused(const Floats& a, const Floats& b, const Floats& c) {
    __m512 x, y, z;
    std::memcpy(&x, &a, sizeof(a));
    std::memcpy(&y, &b, sizeof(b));
    std::memcpy(&z, &c, sizeof(c));
    z = _mm512_fmadd_ps(x, y, z);
    Floats out;
    std::memcpy(&out, &z, sizeof(out));
    return out;
}
#include NACRE_KERNEL
}  // namespace avx512
#undef NACRE_SET
#pragma GCC pop_options

inline bool hasAvx512() {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
}
inline bool hasAvx2() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }
#define NACRE_WIDEST(f) (hasAvx512() ? avx512::f : hasAvx2() ? avx2::f : plain::f)
#else
#define NACRE_WIDEST(f) (plain::f)
#endif
