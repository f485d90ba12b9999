// The arithmetic of sweep.hpp; core/wide.inl says where this is compiled.

constexpr int kVectors = kSweepLanes / kWide;

/// Heights around one chunk, above the ray's start.
struct Window {
    const float* first;
    int stride;
    NACRE_INLINE Window(const SweepGrid& grid, const SweepChunk& chunk, int x, int y)
        : first(grid.at(x + chunk.column, y + chunk.row)), stride(grid.stride()) {}
    /// Height between two texels above its start: differences first, which are exact where heights are alike.
    NACRE_INLINE Floats between(int from, int to, float share, const Floats& start, int v) const {
        const Floats other = load(first + from + v * kWide);
        return (other - start) + share * (load(first + to + v * kWide) - other);
    }
    NACRE_INLINE Floats entering(const SweepChunk& chunk, const Floats& start, int v) const {
        return between(0, chunk.share > 0 ? stride : 0, chunk.share, start, v);
    }
    NACRE_INLINE Floats leaving(const SweepStep& step, const Floats& start, int v) const {
        return between(step.from, step.to, step.share, start, v);
    }
    /// The surface above the ray is linear in t but for twist · cosine · sine · t².
    NACRE_INLINE Floats twist(const SweepStep& step, int v) const {
        const float *low = first + step.corner + v * kWide, *high = low + stride;
        const Floats t = (load(low) - load(low + 1)) - (load(high) - load(high + 1));
        constexpr float kReal = 1e28f;  // beyond: a corner is a hole, and there is no patch
        return (t < kReal) & (t > -kReal) ? t : t - t;
    }
};

/// The same with holes: which patches exist. A ray along a row of texels runs on the border of two patches, and either
/// will do.
template <bool holes>
struct Windows : Window {
    const float* before;  ///< the row above such a ray, or null
    NACRE_INLINE Windows(const SweepGrid& grid, const SweepChunk& chunk, int x, int y)
        : Window(grid, chunk, x, y),
          before(holes && !(grid.sine() > 0) ? grid.at(x + chunk.column, grid.rowBefore(y)) : nullptr) {}
    NACRE_INLINE static Mask real(const float* low, const float* high) {
        return smaller(smaller(load(low), load(low + 1)), smaller(load(high), load(high + 1))) > kHole / 2;
    }
    NACRE_INLINE Mask exists(const SweepStep& step, int v) const {
        const int corner = step.corner + v * kWide;
        const Mask patch = real(first + corner, first + corner + stride);
        return before ? patch | real(before + corner, first + corner) : patch;
    }
};

/// A patch rises above the chord along the ray by at most this times its bend: cosine · sine · length²/4, and
/// length ≤ 1/cosine.
NACRE_INLINE float largestLift(const SweepGrid& grid) { return static_cast<float>(grid.tangent() / 4); }

constexpr float kTolerance = 1e-3f;  // of a slope: smaller gains are not looked for

/// Largest slope within a step that bends down, c < 0: of A + B t + c t² at t² = A/c. Taken at that point of the patch, so
/// that rounding of A can't raise it.
NACRE_INLINE Floats bulge(const SweepStep& step, const Floats& f0, const Floats& f1, const Floats& c,
                          const Floats& slope) {
    const float length = step.t1 - step.t0;
    const Floats start = (f1 - f0) * (1 / length) - c * length;  // slope where the ray enters
    if (!(step.t0 > 0)) return larger(start, slope);              // it starts on the surface
    const Floats a = f0 - start * step.t0 + c * (step.t0 * step.t0), zero = a - a;
    const Mask inside = (c < 0) & (a >= c * (step.t1 * step.t1)) & (a <= c * (step.t0 * step.t0));
    const Floats t = root(larger(a / (inside ? c : zero - 1), zero)) - step.t0;
    const Floats kept = smaller(larger(t, zero), zero + length);
    const Floats best = (f0 + kept * (start + c * kept)) / (kept + step.t0);
    return inside & (best > slope) ? best : slope;
}

/// Slopes of the patches' edges that the steps cross, and of what bends above them when `bends`. With holes only those
/// of patches that exist.
template <bool bends, bool holes>
NACRE_INLINE void climb(const SweepGrid& grid, const SweepPath& path, const SweepChunk& chunk,
                        const Windows<holes>& window, const Floats* start, const Floats* lift, Floats* slope) {
    const float bend = static_cast<float>(grid.cosine() * grid.sine());
    Floats f0[kVectors];
    for (int v = 0; v < kVectors; ++v) f0[v] = bends ? window.entering(chunk, start[v], v) : start[v];
    for (std::size_t k = chunk.begin; k < chunk.end; ++k) {
        const SweepStep& step = path.steps[k];
        const float far = step.far, length = step.t1 - step.t0, middle = 0.5f * (step.t0 + step.t1);
        for (int v = 0; v < kVectors; ++v) {
            const Floats f1 = window.leaving(step, start[v], v), before = slope[v];
            slope[v] = larger(f1 * far, slope[v]);
            if (holes && k > 0) slope[v] = larger(f0[v] * step.near, slope[v]);
            // Not above its ends by more than `lift`, nor above its control polygon: most steps end here.
            if (bends && any(larger(f0[v], f1) + lift[v] > (slope[v] + kTolerance) * step.t0)) {
                const Floats c = window.twist(step, v) * bend;
                const Floats control = 0.5f * (f0[v] + f1) - c * (0.5f * length * length);
                if (any(control > (slope[v] + kTolerance) * middle)) slope[v] = bulge(step, f0[v], f1, c, slope[v]);
            }
            if (holes) slope[v] = window.exists(step, v) ? slope[v] : before;
            f0[v] = f1;
        }
    }
}

/// What is known of the horizons of kSweepLanes texels.
struct Climb {
    Floats start[kVectors], slope[kVectors];
    Mask chunk[kVectors];  ///< where the slope was found
};

/// A chunk that may hold a higher slope: chords, and then bends where a patch could rise above them.
template <bool holes>
NACRE_INLINE void visit(const SweepGrid& grid, const SweepPath& path, std::size_t i, int x, int y, Climb& c) {
    const SweepChunk& chunk = path.chunks[i];
    const Windows<holes> window(grid, chunk, x, y);
    Floats found[kVectors], lift[kVectors];
    for (int v = 0; v < kVectors; ++v) {
        found[v] = c.slope[v];
        lift[v] = load(grid.chunkBend(x + chunk.column, y + chunk.row) + v * kWide) * largestLift(grid);
    }
    bool bends = holes;
    if (!holes) {
        Floats chords[kVectors];
        for (int v = 0; v < kVectors; ++v) chords[v] = window.entering(chunk, c.start[v], v) * chunk.near;
        climb<false>(grid, path, chunk, window, c.start, lift, chords);
        Mask bent = {};
        for (int v = 0; v < kVectors; ++v) {
            found[v] = larger(chords[v], found[v]);
            bent |= chords[v] + lift[v] * chunk.near > found[v] + kTolerance;
        }
        bends = any(bent);
    }
    if (bends) climb<true>(grid, path, chunk, window, c.start, lift, found);
    for (int v = 0; v < kVectors; ++v) {
        c.chunk[v] = found[v] > c.slope[v] ? c.chunk[v] - c.chunk[v] + static_cast<std::int32_t>(i) : c.chunk[v];
        c.slope[v] = found[v];
    }
}

/// Whether heights, one for each texel, this near [1/texels] could be above the horizons.
NACRE_INLINE bool mayRise(const float* high, float near, const Climb& c) {
    Mask open = {};
    for (int v = 0; v < kVectors; ++v)
        open |= (load(high + v * kWide) - c.start[v]) * near > c.slope[v] + kTolerance;
    return any(open);
}
NACRE_INLINE bool mayRise(float high, float near, const Climb& c) {
    Mask open = {};
    for (int v = 0; v < kVectors; ++v) open |= (high - c.start[v]) * near > c.slope[v] + kTolerance;
    return any(open);
}

/// The chunks that hold the horizons, each once, as many as there is room for.
NACRE_INLINE void remember(const Climb& c, SweepHints& hints) {
    hints.count = 0;
    std::int32_t chunks[kSweepLanes], last = 0;
    std::memcpy(chunks, c.chunk, sizeof(chunks));
    for (int lane = 1; lane < kSweepLanes && hints.count < SweepHints::kMost; lane += 2) {  // who stands alone may wait
        const std::int32_t i = chunks[lane];
        if (i != last && i != 0 && !hints.has(i)) hints.chunks[hints.count++] = i;
        last = i;
    }
}

template <bool holes>
NACRE_INLINE void horizonOf(const SweepGrid& grid, const SweepPath& path, int x, int y, SweepHints& hints,
                            float* slopes) {
    constexpr float kNever = 1e30f;  // nothing rises above the horizon of a hole
    Climb c;
    Floats lift[kVectors];
    for (int v = 0; v < kVectors; ++v) {
        c.start[v] = load(grid.at(x, y) + v * kWide);
        const Floats zero = c.start[v] - c.start[v];
        c.slope[v] = holes ? c.start[v] < kHole / 2 ? zero + kNever : zero : zero;
        c.chunk[v] = Mask{};
        lift[v] = load(grid.chunkBend(x, y) + v * kWide) * largestLift(grid);
    }
    const Windows<holes> own(grid, path.chunks[0], x, y);
    climb<true>(grid, path, path.chunks[0], own, c.start, lift, c.slope);
    // What the row before found first: the rest then has to rise above that.
    for (int k = 0; k < hints.count; ++k)
        visit<holes>(grid, path, static_cast<std::size_t>(hints.chunks[k]), x, y, c);
    const std::size_t count = path.chunks.size();
    for (std::size_t first = 0; first < count; first += kSweepGroup) {
        const SweepChunk& group = path.chunks[first];
        if (first % (4 * kSweepGroup) == 0 && first > 0 && !mayRise(grid.highest(), group.near, c)) break;
        if (first > 0 && !mayRise(grid.groupHighest(x + group.column, y + group.row), group.near, c)) continue;
        for (std::size_t i = std::max<std::size_t>(first, 1); i < std::min(first + kSweepGroup, count); ++i) {
            const SweepChunk& chunk = path.chunks[i];
            if (!mayRise(grid.chunkHighest(x + chunk.column, y + chunk.row), chunk.near, c)) continue;
            if (!hints.has(static_cast<int>(i))) visit<holes>(grid, path, i, x, y, c);
        }
    }
    remember(c, hints);
    for (int v = 0; holes && v < kVectors; ++v)
        c.slope[v] = c.start[v] < kHole / 2 ? c.start[v] - c.start[v] : c.slope[v];
    std::memcpy(slopes, c.slope, sizeof(c.slope));
}

void horizon(const SweepGrid& grid, const SweepPath& path, int x, int y, SweepHints& hints, float* slopes) {
    if (grid.holes()) return horizonOf<true>(grid, path, x, y, hints, slopes);
    horizonOf<false>(grid, path, x, y, hints, slopes);
}

/// atan(x), x ≥ 0, to 1e-7 (Abramowitz & Stegun 4.4.49).
void angles(float* slopes) {
    for (int v = 0; v < kVectors; ++v) {
        const Floats x = load(slopes + v * kWide), one = x - x + 1, t = x > 1 ? one / x : x, s = t * t;
        Floats sum = x - x + 0.0028662257f;
        for (const float c : {-0.0161657367f, 0.0429096138f, -0.0752896400f, 0.1065626393f, -0.1420889944f,
                              0.1999355085f, -0.3333314528f, 1.0f})
            sum = sum * s + c;
        const Floats angle = sum * t, out = x > 1 ? static_cast<float>(kPi / 2) - angle : angle;
        std::memcpy(slopes + v * kWide, &out, sizeof(out));
    }
}

/// The last step before a hit, lane by lane.
struct Hit {
    Floats t0, length, f0, f1, c;
    Mask found;
};

/// Where the surface's height above the ray, f0 at the step's start and f1 at its end, first leaves 0 upwards.
NACRE_INLINE Floats hitDistance(const Hit& h, bool first) {
    const Floats beta = (h.f1 - h.f0) / h.length - h.c * h.length;
    const Floats square = beta * beta - 4 * h.c * h.f0, zero = beta - beta;
    const Floats below = -2 * h.f0 / (beta + root(larger(square, zero)));
    // A ray starts on the surface: it is below at once, or falls below it where the patch bends up.
    const Floats own = beta > 0 ? zero : -beta / h.c;
    const Floats tau = first ? own : h.f0 < 0 ? below : zero;
    return h.t0 + larger(tau > h.length ? h.length : tau, zero);
}

template <bool holes>
NACRE_INLINE void raysOf(const SweepGrid& grid, const SweepPath& path, float rise, int x, int y, float* distances) {
    const float bend = static_cast<float>(grid.cosine() * grid.sine());
    Floats start[kVectors], f0[kVectors], distance[kVectors];
    Mask done[kVectors];
    for (int v = 0; v < kVectors; ++v) {
        start[v] = load(grid.at(x, y) + v * kWide);
        f0[v] = start[v] - start[v];
        distance[v] = f0[v] - 1;
        done[v] = start[v] < kHole / 2;
    }
    for (const SweepChunk& chunk : path.chunks) {
        const Windows<holes> window(grid, chunk, x, y);
        const float near = path.steps[chunk.begin].t0;
        if (chunk.begin > 0) {
            const float lowest = rise * (rise < 0 ? path.steps[chunk.end - 1].t1 : near);
            const float* high = grid.chunkHighest(x + chunk.column, y + chunk.row);
            const float highAnywhere = grid.highest() - lowest;
            Mask open = {}, openAnywhere = {};
            for (int v = 0; v < kVectors; ++v) {
                open |= ~done[v] & (load(high + v * kWide) - lowest > start[v]);
                openAnywhere |= ~done[v] & (highAnywhere > start[v]);
            }
            if (!any(openAnywhere)) break;
            if (!any(open)) continue;
            for (int v = 0; v < kVectors; ++v) f0[v] = window.entering(chunk, start[v], v) - rise * near;
        }
        const float* bends = grid.chunkBend(x + chunk.column, y + chunk.row);
        Hit hits[kVectors] = {};
        for (std::size_t k = chunk.begin; k < chunk.end; ++k) {
            const SweepStep& step = path.steps[k];
            const float length = step.t1 - step.t0;
            for (int v = 0; v < kVectors; ++v) {
                const Floats f1 = window.leaving(step, start[v], v) - rise * step.t1;
                if (!any(~done[v] & (larger(f0[v], f1) + load(bends + v * kWide) * largestLift(grid) > 0))) {  // as in climb
                    f0[v] = f1;
                    continue;
                }
                const Floats c = window.twist(step, v) * bend;
                // Above the ray's end, or where the patch bends down, above its middle: at −β/2C, by −β²/4C.
                const Floats beta = (f1 - f0[v]) * (1 / length) - c * length;
                const Mask peak =
                    (c < 0) & (beta > 0) & (beta + 2 * length * c < 0) & (4 * c * f0[v] < beta * beta);
                Mask now = ~done[v] & ((f0[v] > 0) | (f1 > 0) | peak);
                if (holes) now &= window.exists(step, v);
                Hit& h = hits[v];
                h.t0 = now ? step.t0 + (f1 - f1) : h.t0;
                h.length = now ? length + (f1 - f1) : h.length;
                h.f0 = now ? f0[v] : h.f0;
                h.f1 = now ? f1 : h.f1;
                h.c = now ? c : h.c;
                h.found |= now;
                done[v] |= now;
                f0[v] = f1;
            }
            if (k > 0) continue;
            for (int v = 0; v < kVectors; ++v) {  // the step that starts on the surface
                distance[v] = hits[v].found ? hitDistance(hits[v], true) : distance[v];
                hits[v] = Hit{};
            }
        }
        for (int v = 0; v < kVectors; ++v)
            if (any(hits[v].found)) distance[v] = hits[v].found ? hitDistance(hits[v], false) : distance[v];
    }
    std::memcpy(distances, distance, sizeof(distance));
}

void rays(const SweepGrid& grid, const SweepPath& path, float rise, int x, int y, float* distances) {
    if (grid.holes()) return raysOf<true>(grid, path, rise, x, y, distances);
    raysOf<false>(grid, path, rise, x, y, distances);
}
