// The arithmetic of sweep_bounds.cpp; core/wide.inl says where this is compiled.

/// Largest of `count` rows' elements, each of them; `length` is a multiple of 16.
void largest(float* to, const float* const* from, int count, int length) {
    for (int i = 0; i < length; i += kWide) {
        Floats all = load(from[0] + i);
        for (int k = 1; k < count; ++k) all = larger(load(from[k] + i), all);
        std::memcpy(to + i, &all, sizeof(all));
    }
}

float largestOf(const float* values, int length) {
    float all = values[0];
    for (int i = 0; i < length; ++i) all = values[i] > all ? values[i] : all;
    return all;
}

/// Largest of h10 + h01 − h00 − h11 and 0 of the patches below one another from each texel on; patches with a hole have 0.
void largestBends(float* to, const float* low, int stride, int patches, int length) {
    constexpr float kReal = 1e28f;
    for (int i = 0; i < length; i += kWide) {
        Floats upper = load(low + i + 1) - load(low + i), all = {};
        for (int k = 1; k <= patches; ++k) {
            const float* next = low + static_cast<std::ptrdiff_t>(k) * stride + i;
            const Floats lower = load(next + 1) - load(next), bend = upper - lower;
            all = larger(bend < kReal ? bend : bend - bend, all);
            upper = lower;
        }
        std::memcpy(to + i, &all, sizeof(all));
    }
}
