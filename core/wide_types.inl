// Vectors that any processor has (wide.inl).
constexpr int kWide = 16;
typedef float Floats __attribute__((vector_size(4 * kWide)));
typedef std::int32_t Mask __attribute__((vector_size(4 * kWide)));

NACRE_INLINE Floats load(const float* p) {
    Floats v;
    std::memcpy(&v, p, sizeof(v));
    return v;
}
NACRE_INLINE Floats larger(const Floats& a, const Floats& b) { return a > b ? a : b; }
NACRE_INLINE Floats smaller(const Floats& a, const Floats& b) { return a < b ? a : b; }
NACRE_INLINE Floats root(const Floats& v) {
    Floats r = v;
    for (int i = 0; i < kWide; ++i) r[i] = __builtin_sqrtf(v[i]);
    return r;
}
