// How much of the unit disk an ellipse misjudges; core/wide.inl says where this is compiled.

/// \param lit  radius of the lit part towards each azimuth, `count` of them, a multiple of kWide
/// \param c, s  cosines and sines of the azimuths
/// \param e  m11, m12, m22, o1, o2 of HorizonEllipse
/// \return Σ over azimuths of ∫ r dr over the r in [0, 1] that are lit or in the ellipse, but not both; times 2
float misjudged(const float* lit, const float* c, const float* s, int count, const float* e) {
    Floats sum = {};
    const float rest = e[3] * e[3] + e[4] * e[4] - 1;
    for (int k = 0; k < count; k += kWide) {
        const Floats x = load(c + k), y = load(s + k), edge = load(lit + k);
        // |r M (x, y) + o|² ≤ 1  ⇔  a r² + 2 b r + rest ≤ 0
        const Floats mx = e[0] * x + e[1] * y, my = e[1] * x + e[2] * y;
        const Floats a = mx * mx + my * my + 1e-12f, b = mx * e[3] + my * e[4];
        const Floats square = b * b - a * rest, zero = a - a, one = zero + 1;
        const Floats half = root(larger(square, zero));
        Floats low = smaller(larger((-b - half) / a, zero), one), high = smaller(larger((half - b) / a, zero), one);
        high = square > 0 ? high : zero;
        low = square > 0 ? low : zero;
        const Floats top = smaller(high, edge), both = larger(top * top - low * low, zero);
        sum += edge * edge + (high * high - low * low) - 2 * both;
    }
    float out = 0;
    for (int i = 0; i < kWide; ++i) out += sum[i];
    return out;
}
