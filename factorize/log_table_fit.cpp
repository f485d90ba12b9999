#include "factorize/log_table_fit.hpp"

#include <cmath>

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {
namespace {

constexpr std::size_t kChunks = 16;  // fixed, so that sums do not depend on the number of threads
constexpr double kEpsilon = 1e-3;    // ε of E_log [1/sr]
constexpr double kLogWeight = 0.3;   // of E_log² beside E_L2²
constexpr float kRidge = 1e-3f;      // pull of every texel to its anchor, beside the smoothness
constexpr float kMaxExponent = 60;   // e^60 is far above any BRDF and far below float overflow when squared

using Floats = std::vector<float>;

/// A lookup with its texels resolved: first element of each of the four texels in the parameter vector, and weights.
struct Tap {
    std::array<int, 4> texel;
    std::array<float, 4> bilinear;
    glm::vec4 weight;
    const FitTable* table;
};

Tap resolve(const FitLookup& lookup, const FitTable& table, int offset) {
    const float x = std::clamp(lookup.uv.x, 0.0f, 1.0f) * static_cast<float>(table.width - 1);
    const float y = std::clamp(lookup.uv.y, 0.0f, 1.0f) * static_cast<float>(table.height - 1);
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const int x1 = std::min(x0 + 1, table.width - 1), y1 = std::min(y0 + 1, table.height - 1);
    const float a = x - static_cast<float>(x0), b = y - static_cast<float>(y0);
    const auto at = [&](int i, int j) { return offset + (j * table.width + i) * table.channels; };
    return {{at(x0, y0), at(x1, y0), at(x0, y1), at(x1, y1)},
            {(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b},
            lookup.weight,
            &table};
}

/// The fit's state: parameters in one vector, taps per sample, and the current linearisation.
class Problem {
public:
    Problem(LogTableModel& model, std::span<const FitSample> samples, unsigned threads)
        : model_(model), samples_(samples), threads_(threads) {
        int size = 0;
        for (const FitTable& table : model.tables) {
            offsets_.push_back(size);
            size += static_cast<int>(table.texels.size());
        }
        parameters = size;
        gather();
        resolveTaps();
        curvature_.resize(samples.size());
        gradient_.resize(samples.size());
        for (const FitSample& s : samples) {
            sumMeasure_ += 3.0 * s.measure;
            sumSquare_ += s.measure * static_cast<double>(glm::dot(s.value, s.value));
        }
        sumSquare_ = std::max(sumSquare_, 1e-30);  // an all-black BRDF has no L2 scale
    }

    /// Loss at the current texels; keeps the Gauss–Newton curvature and gradient of every sample and channel, and where
    /// lookups multiply, each one's derivative: the other's value.
    double linearise() {
        return parallelSum(kChunks, threads_, [&](std::size_t chunk) {
            double sum = 0;
            for (std::size_t i = begin(chunk); i < begin(chunk + 1); ++i) {
                const FitSample& s = samples_[i];
                const glm::vec3 y = (model_.products ? multiply(i) : forward(i, values)) + s.offset;
                const double logScale = kLogWeight * s.measure / sumMeasure_, l2Scale = s.measure / sumSquare_;
                for (int c = 0; c < 3; ++c) {
                    const double e = model_.exponential ? std::exp(std::min(y[c], kMaxExponent)) : y[c];
                    const double slope = model_.exponential ? e : 1;  // df̂/dy
                    const double f = s.base[c] + e, truth = s.value[c], seen = std::max(f, 0.0) + kEpsilon;
                    const double logSlope = slope / seen;
                    // Below 0 the logarithm goes on along its tangent at 0.
                    const double logGap = std::log(seen / (truth + kEpsilon)) + std::min(f, 0.0) / kEpsilon;
                    const double gap = f - truth;
                    curvature_[i][c] = static_cast<float>(logScale * logSlope * logSlope + l2Scale * slope * slope);
                    gradient_[i][c] = static_cast<float>(-(logScale * logSlope * logGap + l2Scale * slope * gap));
                    sum += logScale * logGap * logGap + l2Scale * gap * gap;
                }
            }
            return sum;
        });
    }

    /// Jᵀ·gradient.
    Floats rightSide() const {
        return accumulate([&](std::size_t i, Floats& out) { scatter(i, gradient_[i], out); });
    }
    /// JᵀCJ·p.
    Floats normal(const Floats& p) const {
        return accumulate([&](std::size_t i, Floats& out) { scatter(i, curvature_[i] * forward(i, p), out); });
    }
    /// diag(JᵀCJ).
    Floats diagonal() const {
        return accumulate([&](std::size_t i, Floats& out) {
            for (const Tap& tap : taps(i))
                for (int ch = 0; ch < tap.table->channels; ++ch) {
                    const glm::vec3 j = tap.table->color[ch] * tap.weight[ch];
                    const float d = glm::dot(curvature_[i], j * j);
                    for (int k = 0; k < 4; ++k) out[tap.texel[k] + ch] += d * tap.bilinear[k] * tap.bilinear[k];
                }
        });
    }

    /// out += λ·(Laplacian + ridge)·p: texels nobody samples follow their neighbours instead of drifting.
    void addSmoothness(const Floats& p, float lambda, Floats& out) const {
        for (std::size_t t = 0; t < model_.tables.size(); ++t) {
            const FitTable& table = model_.tables[t];
            const int row = table.width * table.channels;
            const auto edge = [&](int i, int j) {
                const float d = lambda * (p[i] - p[j]);
                out[i] += d;
                out[j] -= d;
            };
            for (int y = 0; y < table.height; ++y)
                for (int k = 0; k < row; ++k) {
                    const int i = offsets_[t] + y * row + k;
                    if (k + table.channels < row) edge(i, i + table.channels);
                    if (y + 1 < table.height) edge(i, i + row);
                    out[i] += kRidge * lambda * p[i];
                }
        }
    }

    void store() {
        for (std::size_t t = 0; t < model_.tables.size(); ++t)
            std::copy_n(values.begin() + offsets_[t], model_.tables[t].texels.size(), model_.tables[t].texels.begin());
    }

    int parameters = 0;
    Floats values;

private:
    void gather() {
        for (const FitTable& table : model_.tables)
            values.insert(values.end(), table.texels.begin(), table.texels.end());
    }
    void resolveTaps() {
        const std::size_t n = static_cast<std::size_t>(model_.lookupCount);
        taps_.resize(samples_.size() * n);
        parallelFor(kChunks, threads_, [&](std::size_t chunk) {
            std::vector<FitLookup> lookups(n);
            for (std::size_t i = begin(chunk); i < begin(chunk + 1); ++i) {
                model_.lookups(samples_[i], lookups);
                for (std::size_t k = 0; k < n; ++k)
                    taps_[i * n + k] = resolve(lookups[k], model_.tables[lookups[k].table], offsets_[lookups[k].table]);
            }
        });
    }
    std::size_t begin(std::size_t chunk) const { return samples_.size() * chunk / kChunks; }
    std::span<const Tap> taps(std::size_t i) const {
        const std::size_t n = static_cast<std::size_t>(model_.lookupCount);
        return std::span<const Tap>(taps_).subspan(i * n, n);
    }
    static float filtered(const Tap& tap, int ch, const Floats& p) {
        float value = 0;
        for (int k = 0; k < 4; ++k) value += tap.bilinear[k] * p[tap.texel[k] + ch];
        return value;
    }
    glm::vec3 forward(std::size_t i, const Floats& p) const {
        glm::vec3 y(0);
        for (const Tap& tap : taps(i))
            for (int ch = 0; ch < tap.table->channels; ++ch)
                y += filtered(tap, ch, p) * tap.weight[ch] * tap.table->color[ch];
        return y;
    }
    /// Σ a·b·color of sample i; d(ab) = b da + a db goes into the taps' weights.
    glm::vec3 multiply(std::size_t i) {
        const std::size_t n = static_cast<std::size_t>(model_.lookupCount);
        glm::vec3 y(0);
        for (std::size_t k = 0; k + 1 < n; k += 2) {
            Tap &a = taps_[i * n + k], &b = taps_[i * n + k + 1];
            for (int ch = 0; ch < a.table->channels; ++ch) {
                b.weight[ch] = filtered(a, ch, values);
                a.weight[ch] = filtered(b, ch, values);
                y += a.weight[ch] * b.weight[ch] * a.table->color[ch];
            }
        }
        return y;
    }
    void scatter(std::size_t i, const glm::vec3& z, Floats& out) const {
        for (const Tap& tap : taps(i))
            for (int ch = 0; ch < tap.table->channels; ++ch) {
                const float value = glm::dot(z, tap.table->color[ch]) * tap.weight[ch];
                for (int k = 0; k < 4; ++k) out[tap.texel[k] + ch] += value * tap.bilinear[k];
            }
    }
    template <class Add>
    Floats accumulate(Add add) const {
        std::vector<Floats> parts(kChunks);
        parallelFor(kChunks, threads_, [&](std::size_t chunk) {
            parts[chunk].assign(parameters, 0.0f);
            for (std::size_t i = begin(chunk); i < begin(chunk + 1); ++i) add(i, parts[chunk]);
        });
        for (std::size_t chunk = 1; chunk < kChunks; ++chunk)
            for (int k = 0; k < parameters; ++k) parts[0][k] += parts[chunk][k];
        return std::move(parts[0]);
    }

    LogTableModel& model_;
    std::span<const FitSample> samples_;
    unsigned threads_;
    std::vector<int> offsets_;
    std::vector<Tap> taps_;
    std::vector<glm::vec3> curvature_, gradient_;
    double sumMeasure_ = 0, sumSquare_ = 0;
};

double dot(const Floats& a, const Floats& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i]) * b[i];
    return sum;
}

/// Solves (JᵀCJ + λL + damping·D) x = b by conjugate gradients with the Jacobi preconditioner.
Floats solve(const Problem& problem, float lambda, float damping, Floats diagonal, Floats b, int steps) {
    for (float& d : diagonal) d = d * (1 + damping) + 4 * lambda + 1e-12f;
    Floats x(b.size(), 0.0f), r = std::move(b), z(r.size());
    const auto precondition = [&] {
        for (std::size_t i = 0; i < r.size(); ++i) z[i] = r[i] / diagonal[i];
    };
    precondition();
    Floats p = z;
    double rz = dot(r, z);
    const double enough = 1e-6 * rz;
    for (int step = 0; step < steps && rz > enough; ++step) {
        Floats q = problem.normal(p);
        problem.addSmoothness(p, lambda, q);
        for (std::size_t i = 0; i < q.size(); ++i) q[i] += damping * diagonal[i] * p[i];
        const float along = static_cast<float>(rz / dot(p, q));
        for (std::size_t i = 0; i < x.size(); ++i) {
            x[i] += along * p[i];
            r[i] -= along * q[i];
        }
        precondition();
        const double next = dot(r, z);
        const float beta = static_cast<float>(next / rz);
        rz = next;
        for (std::size_t i = 0; i < p.size(); ++i) p[i] = z[i] + beta * p[i];
    }
    return x;
}

}  // namespace

FitTable::FitTable(int w, int h, std::vector<glm::vec3> channelColors)
    : width(w), height(h), channels(static_cast<int>(channelColors.size())) {
    std::copy(channelColors.begin(), channelColors.end(), color.begin());
    texels.assign(static_cast<std::size_t>(w) * h * channels, 0.0f);
}

Image FitTable::image() const {
    Image out(width, height, channels);
    out.data() = texels;
    return out;
}

void FitTable::resize(int w, int h) {
    const Image old = image();
    const auto centre = [](int i, int size, int from) {  // texel i of the new table as a coordinate of the old one
        const float t = size > 1 ? static_cast<float>(i) / static_cast<float>(size - 1) : 0.0f;
        return (t * static_cast<float>(from - 1) + 0.5f) / static_cast<float>(from);
    };
    Image next(w, h, channels);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const glm::vec4 value = sampleBilinear(old, centre(x, w, width), centre(y, h, height));
            for (int c = 0; c < channels; ++c) next.at(x, y, c) = value[c];
        }
    width = w;
    height = h;
    texels = next.data();
}

double fitLogTables(LogTableModel& model, std::span<const FitSample> samples, const FitOptions& options) {
    require(!samples.empty(), "fitLogTables: no samples");
    Problem problem(model, samples, options.threads);
    const Floats anchor = options.anchored ? problem.values : Floats(problem.values.size(), 0.0f);
    float damping = 1e-4f;
    double loss = problem.linearise();
    for (int step = 0; step < options.newtonSteps; ++step) {
        Floats diagonal = problem.diagonal(), b = problem.rightSide();
        double trace = 0;
        for (float d : diagonal) trace += d;
        const float lambda = static_cast<float>(options.smoothness * trace / problem.parameters);
        Floats pull(b.size(), 0.0f), correction = problem.values;
        for (std::size_t i = 0; i < b.size(); ++i) correction[i] -= anchor[i];
        problem.addSmoothness(correction, lambda, pull);
        for (std::size_t i = 0; i < b.size(); ++i) b[i] -= pull[i];
        const Floats x = solve(problem, lambda, damping, std::move(diagonal), std::move(b), options.conjugateSteps);

        const Floats before = problem.values;
        const double lossBefore = loss;
        float length = 1;
        for (int attempt = 0; attempt < 6; ++attempt, length *= 0.4f) {
            for (std::size_t i = 0; i < x.size(); ++i) problem.values[i] = before[i] + length * x[i];
            loss = problem.linearise();
            if (loss < lossBefore) break;
        }
        if (!(loss < lossBefore)) {  // no shorter step helps: stay, trust the model less
            problem.values = before;
            loss = problem.linearise();
            damping *= 10;
        } else if (lossBefore - loss < 1e-3 * lossBefore) {
            break;
        }
    }
    problem.store();
    return loss;
}

}  // namespace nacre
