// The arithmetic of harmonic_rotation.hpp for sixteen vertices; core/wide.inl says where this is compiled.
NACRE_INLINE Floats splat(float x) { return Floats{} + x; }

/// y_lm of (x, y, z) for l ≤ L, added into out times z(l). Recurrences in l, and in m for Re, Im (x + iy)^m.
template <int L, class Weight>
NACRE_INLINE void addHarmonics(const float* scales, const Floats& x, const Floats& y, const Floats& z, const Weight& weight,
                               Floats* out) {
    Floats re = splat(1), im{};
    for (int m = 0; m <= L; ++m) {
        Floats below{}, here = splat(1);  // P_lm / ((2m − 1)!! sin^m)
        for (int l = m; l <= L; ++l) {
            const Floats p = here * splat(scales[l * (l + 1) / 2 + m]) * weight(l);
            out[l * l + l + m] += p * re;
            if (m > 0) out[l * l + l - m] += p * im;
            const Floats next = (splat(static_cast<float>(2 * l + 1)) * z * here - splat(static_cast<float>(l + m)) * below) *
                                splat(1.0f / static_cast<float>(l + 1 - m));
            below = here;
            here = next;
        }
        const Floats turned = re * x - im * y;
        im = re * y + im * x;
        re = turned;
    }
}

/// \param frames  [9][16] columns tangent, bitangent, normal by component; \param local, world  [(L + 1)²][16]
template <int L>
void turn16(const float* scales, const float* directions, const float* weights, const float* frames, const float* local,
            float* world) {
    constexpr int kCount = (L + 1) * (L + 1), kDirections = 2 * L + 1;
    Floats out[kCount] = {};
    Floats f[9];
    for (int k = 0; k < 9; ++k) f[k] = load(frames + kWide * k);
    for (int j = 0; j < kDirections; ++j) {
        const float* d = directions + 3 * j;
        const Floats x = f[0] * splat(d[0]) + f[3] * splat(d[1]) + f[6] * splat(d[2]);
        const Floats y = f[1] * splat(d[0]) + f[4] * splat(d[1]) + f[7] * splat(d[2]);
        const Floats z = f[2] * splat(d[0]) + f[5] * splat(d[1]) + f[8] * splat(d[2]);
        Floats share[L + 1] = {};
        for (int l = 0; l <= L; ++l)
            for (int c = l * l; c < (l + 1) * (l + 1); ++c) share[l] += splat(weights[c * kDirections + j]) * load(local + kWide * c);
        addHarmonics<L>(scales, x, y, z, [&](int l) { return share[l]; }, out);
    }
    for (int c = 0; c < kCount; ++c) std::memcpy(world + kWide * c, &out[c], sizeof(Floats));
}
