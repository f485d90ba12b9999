// The arithmetic of sweep.hpp; bump/wide.inl says where this is compiled.

constexpr int kVectors = kSweepLanes / kWide;

/// Heights around one step, above the ray's start.
struct Corners {
    const float *low, *high;
    NACRE_INLINE Corners(const SweepGrid& grid, const SweepStep& step, int x, int y)
        : low(grid.at(x + step.column, y + step.row)), high(grid.at(x + step.column, y + step.row + 1)) {}
    /// Height where the ray leaves above its start: differences first, which are exact where heights are alike.
    NACRE_INLINE Floats leaving(const SweepStep& step, const Floats& start, int v) const {
        if (step.share == 1) return load(high + v * kWide + 1) - start;  // a corner: the other may be a hole
        const float* other = (step.right ? low + 1 : high) + v * kWide;
        const Floats from = load(other);
        return (from - start) + step.share * (load(high + v * kWide + 1) - from);
    }
    /// The surface above the ray is linear in t but for twist · cosine · sine · t².
    NACRE_INLINE Floats twist(int v) const {
        const Floats t = (load(low + v * kWide) - load(low + v * kWide + 1)) -
                         (load(high + v * kWide) - load(high + v * kWide + 1));
        constexpr float kReal = 1e28f;  // beyond: a corner is a hole, and there is no patch
        return (t < kReal) & (t > -kReal) ? t : t - t;
    }
};

/// Whether the step's patch exists. A ray along a row or column of texels runs on two patches' border: either will do.
NACRE_INLINE Mask exists(const SweepGrid& grid, const SweepStep& step, int x, int y, int v) {
    const auto patch = [&](int row) {
        const float* low = grid.at(x + step.column, y + row) + v * kWide;
        const float* high = grid.at(x + step.column, y + row + 1) + v * kWide;
        return smaller(smaller(load(low), load(low + 1)), smaller(load(high), load(high + 1))) > kHole / 2;
    };
    return grid.sine() > 0 ? patch(step.row) : patch(step.row) | patch(grid.rowBefore(y, step.row) - y);
}

/// A patch rises above the chord along the ray by at most this times its twist: cosine · sine · length²/4, and
/// length ≤ 1/cosine.
NACRE_INLINE float largestLift(const SweepGrid& grid) { return static_cast<float>(grid.sine() / grid.cosine() / 4); }

constexpr float kTolerance = 1e-3f;      // of a slope: smaller gains are not looked for
constexpr float kBendTolerance = 4e-3f;  // nor are these, of patches that bend above their chords: rarer, and dearer

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
NACRE_INLINE void climb(const SweepGrid& grid, const SweepPath& path, const SweepChunk& chunk, int x, int y,
                        const Floats* start, const Floats* entry, float lift, Floats* slope) {
    const float bend = static_cast<float>(grid.cosine() * grid.sine());
    Floats f0[kVectors];
    for (int v = 0; v < kVectors; ++v) f0[v] = entry[v];
    for (std::size_t k = chunk.begin; k < chunk.end; ++k) {
        const SweepStep& step = path.steps[k];
        const Corners corners(grid, step, x, y);
        const float far = step.far, length = step.t1 - step.t0, middle = 0.5f * (step.t0 + step.t1);
        for (int v = 0; v < kVectors; ++v) {
            const Floats f1 = corners.leaving(step, start[v], v), before = slope[v];
            slope[v] = larger(f1 * far, slope[v]);
            if (holes && k > 0) slope[v] = larger(f0[v] * (1 / step.t0), slope[v]);
            // Not above its ends by more than `lift`, nor above its control polygon: most steps end here.
            if (bends && any(larger(f0[v], f1) + lift > slope[v] * step.t0)) {
                const Floats c = corners.twist(v) * bend;
                const Floats control = 0.5f * (f0[v] + f1) - c * (0.5f * length * length);
                if (any(control > slope[v] * middle)) slope[v] = bulge(step, f0[v], f1, c, slope[v]);
            }
            if (holes) slope[v] = exists(grid, step, x, y, v) ? slope[v] : before;
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
NACRE_INLINE void visit(const SweepGrid& grid, const SweepPath& path, std::size_t i, int x, int y, float lift,
                        Climb& c) {
    const SweepChunk& chunk = path.chunks[i];
    Floats found[kVectors], entry[kVectors];
    for (int v = 0; v < kVectors; ++v) found[v] = c.slope[v];
    bool bends = holes;
    if (!holes) {
        Floats chords[kVectors];
        for (int v = 0; v < kVectors; ++v) chords[v] = c.slope[v] - c.slope[v];
        climb<false, false>(grid, path, chunk, x, y, c.start, entry, 0, chords);
        Mask bent = {};
        for (int v = 0; v < kVectors; ++v) {
            found[v] = larger(chords[v], found[v]);
            bent |= chords[v] + lift * chunk.near > found[v] + kBendTolerance;
        }
        bends = any(bent);
    }
    if (bends) {
        const SweepStep& before = path.steps[chunk.begin - 1];
        const Corners corners(grid, before, x, y);
        for (int v = 0; v < kVectors; ++v) entry[v] = corners.leaving(before, c.start[v], v);
        climb<true, holes>(grid, path, chunk, x, y, c.start, entry, lift, found);
    }
    for (int v = 0; v < kVectors; ++v) {
        c.chunk[v] = found[v] > c.slope[v] ? c.chunk[v] - c.chunk[v] + static_cast<std::int32_t>(i) : c.chunk[v];
        c.slope[v] = found[v];
    }
}

NACRE_INLINE bool mayRise(float high, float near, const Climb& c) {
    Mask open = {};
    for (int v = 0; v < kVectors; ++v) open |= (high - c.start[v]) * near > c.slope[v] + kTolerance;
    return any(open);
}

/// The chunks that hold the horizons, each once, as many as there is room for.
NACRE_INLINE void remember(const Climb& c, SweepHints& hints) {
    hints.count = 0;
    std::int32_t chunks[kSweepLanes];
    std::memcpy(chunks, c.chunk, sizeof(chunks));
    for (const std::int32_t i : chunks) {
        if (i == 0 || hints.count == SweepHints::kMost || hints.has(i)) continue;
        hints.chunks[hints.count++] = i;
    }
}

template <bool holes>
NACRE_INLINE void horizonOf(const SweepGrid& grid, const SweepPath& path, int x, int y, SweepHints& hints,
                            float* slopes) {
    Climb c;
    Floats entry[kVectors];
    for (int v = 0; v < kVectors; ++v) {
        c.start[v] = load(grid.at(x, y) + v * kWide);
        c.slope[v] = entry[v] = c.start[v] - c.start[v];
        c.chunk[v] = Mask{};
    }
    const float liftOfTwist = largestLift(grid);
    const auto boundOf = [&](std::size_t i) -> const SweepBound& {
        return grid.bound(x + path.chunks[i].column, y + path.chunks[i].row);
    };
    climb<true, holes>(grid, path, path.chunks[0], x, y, c.start, entry, boundOf(0).twist * liftOfTwist, c.slope);
    // What the row before found first: the rest then has to rise above that.
    for (int k = 0; k < hints.count; ++k) {
        const std::size_t i = static_cast<std::size_t>(hints.chunks[k]);
        visit<holes>(grid, path, i, x, y, boundOf(i).twist * liftOfTwist, c);
    }
    for (std::size_t i = 1; i < path.chunks.size(); ++i) {
        const SweepChunk& chunk = path.chunks[i];
        if (i % kSweepGroup == 0) {  // a group of chunks at once
            if (!mayRise(grid.highest(), chunk.near, c)) break;
            if (!mayRise(grid.farHighest(x + chunk.column, y + chunk.row), chunk.near, c)) {
                i += kSweepGroup - 1;
                continue;
            }
        }
        const SweepBound& bound = boundOf(i);
        if (!mayRise(bound.highest, chunk.near, c) || hints.has(static_cast<int>(i))) continue;
        visit<holes>(grid, path, i, x, y, bound.twist * liftOfTwist, c);
    }
    remember(c, hints);
    std::memcpy(slopes, c.slope, sizeof(c.slope));
}

void horizon(const SweepGrid& grid, const SweepPath& path, int x, int y, SweepHints& hints, float* slopes) {
    if (grid.holes()) return horizonOf<true>(grid, path, x, y, hints, slopes);
    horizonOf<false>(grid, path, x, y, hints, slopes);
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
    const float liftOfTwist = largestLift(grid);
    Floats start[kVectors], f0[kVectors], distance[kVectors];
    Mask done[kVectors];
    for (int v = 0; v < kVectors; ++v) {
        start[v] = load(grid.at(x, y) + v * kWide);
        f0[v] = start[v] - start[v];
        distance[v] = f0[v] - 1;
        done[v] = start[v] < kHole / 2;
    }
    for (const SweepChunk& chunk : path.chunks) {
        const float near = path.steps[chunk.begin].t0;
        if (chunk.begin > 0) {
            const float lowest = rise * (rise < 0 ? path.steps[chunk.end - 1].t1 : near);
            const float high = grid.bound(x + chunk.column, y + chunk.row).highest - lowest;
            const float highAnywhere = grid.highest() - lowest;
            Mask open = {}, openAnywhere = {};
            for (int v = 0; v < kVectors; ++v) {
                open |= ~done[v] & (high > start[v]);
                openAnywhere |= ~done[v] & (highAnywhere > start[v]);
            }
            if (!any(openAnywhere)) break;
            if (!any(open)) continue;
            const SweepStep& before = path.steps[chunk.begin - 1];
            const Corners corners(grid, before, x, y);
            for (int v = 0; v < kVectors; ++v) f0[v] = corners.leaving(before, start[v], v) - rise * near;
        }
        const float lift = grid.bound(x + chunk.column, y + chunk.row).twist * liftOfTwist;
        Hit hits[kVectors] = {};
        for (std::size_t k = chunk.begin; k < chunk.end; ++k) {
            const SweepStep& step = path.steps[k];
            const Corners corners(grid, step, x, y);
            const float length = step.t1 - step.t0;
            for (int v = 0; v < kVectors; ++v) {
                const Floats f1 = corners.leaving(step, start[v], v) - rise * step.t1;
                if (!any(~done[v] & (larger(f0[v], f1) + lift > 0))) {  // as in climb
                    f0[v] = f1;
                    continue;
                }
                const Floats c = corners.twist(v) * bend;
                // Above the ray's end, or where the patch bends down, above its middle: at −β/2C, by −β²/4C.
                const Floats beta = (f1 - f0[v]) * (1 / length) - c * length;
                const Mask peak =
                    (c < 0) & (beta > 0) & (beta + 2 * length * c < 0) & (4 * c * f0[v] < beta * beta);
                Mask now = ~done[v] & ((f0[v] > 0) | (f1 > 0) | peak);
                if (holes) now &= exists(grid, step, x, y, v);
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
