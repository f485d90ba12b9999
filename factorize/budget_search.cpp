#include "factorize/budget_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/error.hpp"

namespace nacre {
namespace {

/// Storage rounding can make a larger table a little worse than a smaller one.
constexpr double kNoise = 1.1;
/// No table's error falls faster with the texels' size than with this power of it; bilinear filters have 2.
constexpr double kFastest = 4;
/// Misses by more than this even so: not worth a bake.
constexpr double kFarOff = 10;

/// What bakes have taught of the candidates of one ladder.
struct Ladder {
    double bytesPerBound = 1;  ///< true bytes over BudgetCandidate::bytes
    double order = 2;          ///< of the error in the texels' size: the bilinear filter's until two bakes tell
    double lastBytes = 0, lastError = 0;
    bool dropped = false, tooManyFetches = false;

    /// The error at `bytes` if it falls with that power of the texels' size.
    double errorAt(double bytes, double power) const { return lastError * std::pow(lastBytes / bytes, power / 2); }
    void learn(double bytes, double error) {
        if (lastBytes > 0 && bytes > lastBytes && error > 0)
            order = std::clamp(2 * std::log(lastError / error) / std::log(bytes / lastBytes), 0.0, kFastest);
        lastBytes = bytes;
        lastError = error;
    }
};

struct Tried {
    FactoredBrdf brdf;
    bool fits = false;  ///< within bytes and fetches
    double error = std::numeric_limits<double>::infinity();
};

struct Rung {
    BudgetCandidate candidate;
    std::optional<Tried> tried{};
};

class BudgetSearch {
public:
    /// Leaves out what the lower bounds rule out.
    BudgetSearch(std::vector<BudgetCandidate> candidates, const FactorizeOptions& options) : options_(options) {
        std::stable_sort(candidates.begin(), candidates.end(),
                         [](const BudgetCandidate& a, const BudgetCandidate& b) { return a.bytes < b.bytes; });
        for (BudgetCandidate& c : candidates) {
            leastBytes_ = std::min(leastBytes_, c.bytes);
            leastFetches_ = std::min(leastFetches_, c.fetches);
            if ((!options.maxBytes || c.bytes <= *options.maxBytes) &&
                (!options.maxFetches || c.fetches <= *options.maxFetches))
                rungs_.push_back({std::move(c)});
        }
    }

    const Tried* largestThatFits() {
        for (auto rung = rungs_.rbegin(); rung != rungs_.rend(); ++rung)
            if (open(*rung) && attempt(*rung).fits) return &*rung->tried;
        return nullptr;
    }

    const Tried* smallestThatMeets() {
        for (Rung& rung : rungs_) {
            if (!open(rung) || passOver(rung)) continue;
            const Tried& t = attempt(rung);
            if (t.fits && t.error <= *options_.maxError) return &t;
            if (t.fits) giveUpWhenHopeless(rung);
        }
        nameTheUsual();
        return nullptr;
    }

    std::string nearestText() const {
        if (std::isfinite(nearest_.error))
            return fmt::format("nearest tried: {} with error {:.4g}, {} bytes, {} fetches", nearest_.brdf.method,
                               nearest_.error, nearest_.brdf.bytes(), nearest_.brdf.fetches);
        if (!nearest_.brdf.textures.empty())
            return fmt::format("nearest tried: {} with {} bytes, {} fetches", nearest_.brdf.method,
                               nearest_.brdf.bytes(), nearest_.brdf.fetches);
        return fmt::format("of the sizes tried the smallest takes {} bytes or more, and a lookup {} fetches or more",
                           leastBytes_, leastFetches_);
    }

private:
    double estimate(const Rung& rung) {
        return static_cast<double>(rung.candidate.bytes) * ladders_[rung.candidate.ladder].bytesPerBound;
    }

    bool affordable(const Rung& rung) {
        return !options_.maxBytes || estimate(rung) <= static_cast<double>(*options_.maxBytes);
    }

    bool open(const Rung& rung) { return !ladders_[rung.candidate.ladder].dropped && affordable(rung); }

    bool passOver(const Rung& rung) {
        const Ladder& ladder = ladders_[rung.candidate.ladder];
        return !rung.tried && ladder.lastBytes > 0 &&
               ladder.errorAt(estimate(rung), kFastest) > kNoise * *options_.maxError;
    }

    /// Ladders given up as far off were only tried at their smallest, which says little of how near they come.
    void nameTheUsual() {
        std::set<std::string> named;
        for (auto rung = rungs_.rbegin(); rung != rungs_.rend(); ++rung) {
            const BudgetCandidate& c = rung->candidate;
            const Ladder& ladder = ladders_[c.ladder];
            if (!c.usual || ladder.tooManyFetches || !affordable(*rung) || !named.insert(c.ladder).second) continue;
            attempt(*rung);
        }
    }

    const Tried& attempt(Rung& rung) {
        if (rung.tried) return *rung.tried;
        Tried& t = rung.tried.emplace();
        t.brdf = rung.candidate.bake();
        Ladder& ladder = ladders_[rung.candidate.ladder];
        ladder.bytesPerBound = static_cast<double>(t.brdf.bytes()) / static_cast<double>(rung.candidate.bytes);
        if (options_.maxFetches && t.brdf.fetches > *options_.maxFetches)
            ladder.dropped = ladder.tooManyFetches = true;  // at every size
        t.fits = !ladder.tooManyFetches && (!options_.maxBytes || t.brdf.bytes() <= *options_.maxBytes);
        if (t.fits && options_.maxError) t.error = options_.measure(t.brdf);
        const bool smaller = nearest_.brdf.textures.empty() || t.brdf.bytes() < nearest_.brdf.bytes();
        if (t.error < nearest_.error || (!std::isfinite(nearest_.error) && smaller)) nearest_ = t;
        return t;
    }

    void giveUpWhenHopeless(const Rung& rung) {
        Ladder& ladder = ladders_[rung.candidate.ladder];
        ladder.learn(static_cast<double>(rung.tried->brdf.bytes()), rung.tried->error);
        Rung& top = *std::find_if(rungs_.rbegin(), rungs_.rend(), [&](const Rung& other) {
            return other.candidate.ladder == rung.candidate.ladder && open(other);
        });  // `rung` itself is open
        if (ladder.errorAt(estimate(top), kFastest) > kFarOff * *options_.maxError) ladder.dropped = true;
        if (ladder.dropped || ladder.errorAt(estimate(top), ladder.order) <= *options_.maxError) return;
        const Tried& probe = attempt(top);
        if (probe.fits && probe.error > kNoise * *options_.maxError) ladder.dropped = true;
    }

    const FactorizeOptions& options_;
    std::vector<Rung> rungs_;  ///< of all ladders, by bytes
    std::map<std::string, Ladder> ladders_;
    Tried nearest_;
    std::size_t leastBytes_ = std::numeric_limits<std::size_t>::max();
    int leastFetches_ = std::numeric_limits<int>::max();
};

std::string budgetText(const FactorizeOptions& o) {
    std::string text;
    if (o.maxError) text += fmt::format(" error <= {}", *o.maxError);
    if (o.maxBytes) text += fmt::format(" bytes <= {}", *o.maxBytes);
    if (o.maxFetches) text += fmt::format(" fetches <= {}", *o.maxFetches);
    return text;
}

}  // namespace

FactoredBrdf searchBudget(const std::string& source, std::vector<BudgetCandidate> candidates,
                          const FactorizeOptions& options) {
    BudgetSearch search(std::move(candidates), options);
    const Tried* found = options.maxError ? search.smallestThatMeets() : search.largestThatFits();
    if (found) return found->brdf;
    throw Error(fmt::format("{}: no representation within{}; {}", source, budgetText(options), search.nearestText()));
}

}  // namespace nacre
