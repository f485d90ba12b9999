#include "factorize/factorize.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "factorize/budget_search.hpp"
#include "factorize/fit_samples.hpp"
#include "factorize/methods.hpp"

namespace nacre {
namespace {

/// One thing to try: a method at given sizes, with what it will cost.
struct Candidate {
    std::string method;
    TextureSizes sizes;
    HalfDiffLayout layout = HalfDiffLayout::Harmonics;
    int terms = 0;  ///< of svd; 0 = the method's own choice
};

FactoredBrdf bake(const Reflectance& r, const Candidate& c, const FactorizeOptions& options) {
    if (c.method == "cosine") return factorizeCosine(r, c.sizes, options);
    if (c.method == "analytic") return factorizeAnalytic(r, c.sizes, options);
    if (c.method == "fit") return factorizeFit(r, c.layout, c.sizes, options);
    if (c.method == "homomorphic") return factorizeHomomorphic(r, c.sizes, options);
    if (c.method == "svd") {
        FactorizeOptions own = options;
        own.terms = c.terms;
        if (options.method == "auto" && own.parametrization.empty()) own.parametrization = "symmetric";  // see suitable
        return factorizeSeparable(r, c.sizes, own);
    }
    if (c.method == "single-lobe") return factorizeSingleLobe(r, c.sizes, options);
    return factorizeTangent(r, c.sizes, options);
}

TextureSizes square(int first, int second) { return {{first, first}, {second, second}}; }

/// Sizes from small to large: what a budget search walks through. The smallest are about the least that is worth a
/// name; the largest have as many texels as the samples of a fit can fill.
std::vector<TextureSizes> ladder(const Candidate& kind) {
    std::vector<TextureSizes> out;
    const auto squares = [&](std::initializer_list<int> edges, int divisor = 1) {
        for (const int edge : edges) out.push_back(square(edge, std::max(2, edge / divisor)));
    };
    if (kind.method == "fit" && kind.layout == HalfDiffLayout::Compact) {
        squares({4, 8, 12, 16, 24, 32, 48, 64});
    } else if (kind.method == "fit") {
        out = {{{12, 8}, {6, 4}},    {{20, 12}, {8, 6}},   {{28, 16}, {12, 8}},
               {{40, 24}, {16, 12}}, {{48, 36}, {32, 24}}, {{64, 48}, {40, 32}},
               square(64, 64),       square(96, 64),       square(128, 128)};
    } else if (kind.method == "analytic" || kind.method == "cosine") {
        squares({4, 8, 12, 16, 24, 32, 48, 64, 96, 128, 256});
    } else if (kind.method == "homomorphic") {
        squares({6, 12, 16, 24, 32, 48, 64, 96, 128}, 2);
    } else if (kind.method == "svd") {
        squares({4, 8, 12, 16, 24, 32, 48, 64});
    } else {  // single-lobe has two rows whatever the second size
        squares({4, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 512, 1024});
    }
    return out;
}

/// The method's own choice when nobody asks for a size.
Candidate usual(const std::string& method, const Reflectance& r) {
    Candidate c{method, square(64, 64)};
    if (method == "svd") c.sizes = square(32, 32);
    if (method == "homomorphic") c.sizes = r.microfacet ? square(64, 32) : square(48, 48);
    if (method == "single-lobe") c.sizes = square(256, 2);
    if (method == "tangent") c.sizes = square(128, 128);
    if (method == "analytic" && r.microfacet && r.microfacet->alphaX < 0.03) c.sizes = square(128, 128);
    return c;
}

/// Terms decide the layout of the fit.
Candidate withTerms(Candidate c, const FactorizeOptions& options) {
    if (c.method == "fit" && options.terms == 1) c.layout = HalfDiffLayout::Compact;
    if (c.method == "fit" && options.terms == 2) c.layout = HalfDiffLayout::Grazing;
    if (c.method == "svd") c.terms = options.terms;
    return c;
}

/// What a budget chooses among for one method, at its usual size; with more fetches before those with fewer.
std::vector<Candidate> variants(const std::string& method, const Reflectance& r, const FactorizeOptions& options) {
    const Candidate first = withTerms(usual(method, r), options);
    if (options.terms != 0 || (method != "fit" && method != "svd")) return {first};
    Candidate second = first;
    if (method == "fit") {
        second.layout = HalfDiffLayout::Compact;
        second.sizes = square(32, 1);
    }
    second.terms = method == "svd" ? 1 : 0;
    return {first, second};
}

Candidate ofSize(const std::string& method, const FactorizeOptions& options) {
    const int n = options.size;
    Candidate c{method, square(n, method == "homomorphic" ? std::max(2, n / 2) : n)};
    return withTerms(c, options);
}

/// Methods that fit the input, best first. `analytic` and the special forms are exact but for interpolation; `fit`
/// takes any isotropic input; `homomorphic` everything, but relief seen in two colours is a sum of products, which
/// `svd` over (wi, wo) follows: where neither is known to fit, both are tried.
std::vector<std::string> suitable(const Reflectance& r, const FactorizeOptions& options) {
    std::vector<std::string> out;
    if (r.tangent) out.push_back("tangent");
    if (r.singleLobe) out.push_back("single-lobe");
    if (r.isotropic && r.microfacet && r.microfacet->diffuseIsConstant && r.microfacet->visibilityIsIsotropic)
        out.push_back("analytic");
    if (r.isotropic)
        out.push_back("fit");
    else
        out.push_back("homomorphic");
    if (!r.isotropic && !r.microfacet && options.terms <= 2 && options.size <= kLargestSeparable) out.push_back("svd");
    return out;
}

int fetchesOf(const Candidate& c, const Reflectance& r) {
    if (c.method == "fit") return c.layout == HalfDiffLayout::Compact ? 1 : 2;
    if (c.method == "svd") return 2 * (c.terms == 0 ? 2 : c.terms);
    if (c.method == "single-lobe" || c.method == "tangent") return 1;
    if (c.method == "homomorphic") return r.microfacet ? 1 + !r.microfacet->diffuseIsConstant : 3;  // at least
    return 2;
}

/// Texels' bytes before anything is baked: a lower bound, in the same proportion to the exact figure for every size of
/// a ladder. Short of it by colour in `analytic` and `cosine`, by P and the diffuse texture of a model's `homomorphic`.
std::size_t bytesOf(const Candidate& c, const FactorizeOptions& options, const Reflectance& r) {
    const std::size_t unit = bytesPerChannel(options.format);
    const std::size_t first = static_cast<std::size_t>(c.sizes.first.x) * c.sizes.first.y;
    const std::size_t second = static_cast<std::size_t>(c.sizes.second.x) * c.sizes.second.y;
    if (c.method == "fit") {
        const std::size_t secondChannels = c.layout == HalfDiffLayout::Compact   ? 0
                                           : c.layout == HalfDiffLayout::Grazing ? 3
                                                                                 : 4;
        return unit * (4 * first + secondChannels * second);
    }
    if (c.method == "analytic" || c.method == "cosine") return unit * (first + second);
    const bool symmetric =
        options.parametrization.empty() ? options.method == "auto" : options.parametrization == "symmetric";
    if (c.method == "svd") return unit * first * (c.terms == 1 ? 1 : 2) * (symmetric ? 4 : 6);
    if (c.method == "single-lobe") return unit * static_cast<std::size_t>(c.sizes.first.x) * 2 * 3;
    if (c.method == "tangent") return unit * first * 3;
    return r.microfacet ? unit * first : unit * 3 * (first + second);
}

/// √(0.3 E_log² + E_L2²) below 80°, the loss of the fits.
double lossOf(const FactoredBrdf& brdf, const Reflectance& r, unsigned threads) {
    FitSampleOptions sampling{40000, glm::dvec2(lobeHalfWidth(r.f)), r.isotropic, 80 * kPi / 180, threads};
    constexpr double kEpsilon = 1e-3;
    double gap = 0, square = 0, logGap = 0, measure = 0;
    for (const FitSample& s : fitSamples(r.f, sampling)) {
        const Rgb f = glm::max(evaluate(brdf, s.wi, s.wo), Rgb(0)), truth(s.value);
        const Rgb d = f - truth, l = glm::log((f + kEpsilon) / (truth + kEpsilon));
        gap += s.measure * glm::dot(d, d);
        square += s.measure * glm::dot(truth, truth);
        logGap += s.measure * glm::dot(l, l);
        measure += 3.0 * s.measure;
    }
    return std::sqrt(0.3 * logGap / measure + gap / std::max(square, 1e-30));
}

/// The one nearer to the truth; a later one, with more fetches, must be nearer by a fifth.
FactoredBrdf nearest(std::vector<FactoredBrdf> baked, const Reflectance& r, const FactorizeOptions& options) {
    constexpr double kWorthAFetch = 0.8;
    std::size_t best = 0;
    for (std::size_t i = 1; i < baked.size(); ++i)
        if (lossOf(baked[i], r, options.threads) < kWorthAFetch * lossOf(baked[best], r, options.threads)) best = i;
    return std::move(baked[best]);
}

void addLadder(std::vector<BudgetCandidate>& candidates, const Reflectance& r, const Candidate& kind,
               const FactorizeOptions& options) {
    const std::size_t usualBytes = bytesOf(kind, options, r);
    for (const TextureSizes& sizes : ladder(kind)) {
        Candidate c = kind;
        c.sizes = sizes;
        const std::size_t bytes = bytesOf(c, options, r);
        candidates.push_back({fmt::format("{} {} {}", c.method, static_cast<int>(c.layout), c.terms), bytes,
                              fetchesOf(c, r), bytes <= usualBytes, [&r, &options, c] { return bake(r, c, options); }});
    }
}

FactoredBrdf withinBudget(const Reflectance& r, const std::vector<Candidate>& kinds, const FactorizeOptions& options) {
    std::vector<BudgetCandidate> candidates;
    for (const Candidate& kind : kinds) addLadder(candidates, r, kind, options);
    return searchBudget(r.source, std::move(candidates), options);
}

std::vector<Candidate> variantsOfAll(const std::vector<std::string>& methods, const Reflectance& r,
                                     const FactorizeOptions& options) {
    std::vector<Candidate> out;
    for (const std::string& method : methods)
        for (const Candidate& kind : variants(method, r, options)) out.push_back(kind);
    return out;
}

/// Nothing when `kind` has too many fetches, or no size within the bytes. Without a bound on bytes its usual size.
std::optional<FactoredBrdf> largestWithinBudget(const Reflectance& r, const Candidate& kind,
                                                const FactorizeOptions& options) {
    if (options.maxFetches && fetchesOf(kind, r) > *options.maxFetches) return {};
    if (!options.maxBytes) {
        FactoredBrdf baked = bake(r, kind, options);
        if (options.maxFetches && baked.fetches > *options.maxFetches) return {};
        return baked;
    }
    try {
        return withinBudget(r, {kind}, options);
    } catch (const Error&) {  // another may be small enough
        return {};
    }
}

/// Bytes and fetches alone: of the first method that has anything within them (of all when `together`) each variant's
/// largest, and the nearest of those. A table that outgrows the fit's samples is no nearer, hence the usual size too.
FactoredBrdf nearestWithinBudget(const Reflectance& r, const std::vector<std::string>& methods,
                                 const FactorizeOptions& options, bool together) {
    std::vector<FactoredBrdf> baked;
    for (const std::string& method : methods) {
        const std::vector<Candidate> kinds = variants(method, r, options);
        for (auto kind = kinds.rbegin(); kind != kinds.rend(); ++kind) {  // fewer fetches first, as nearest() asks
            if (!options.maxBytes && kind != kinds.rend() - 1 && fetchesOf(kinds.front(), r) <= *options.maxFetches)
                continue;  // as without a budget
            std::optional<FactoredBrdf> largest = largestWithinBudget(r, *kind, options);
            if (!largest) continue;
            const bool overgrown = method == "svd" && largest->bytes() > bytesOf(*kind, options, r);
            if (overgrown) baked.push_back(bake(r, *kind, options));
            baked.push_back(std::move(*largest));
        }
        if (!baked.empty() && !together) break;
    }
    if (baked.empty()) return withinBudget(r, variantsOfAll(methods, r, options), options);  // says how near it came
    return nearest(std::move(baked), r, options);
}

/// An option that not every method has.
struct SpecialOption {
    std::string name;
    std::vector<std::string> methods;  ///< that use it
    bool isSet;
    bool isUsedBy(const std::string& method) const {
        return std::find(methods.begin(), methods.end(), method) != methods.end();
    }
    std::string complaint(const std::string& found) const {
        return fmt::format("{}: only {} {} it, found method {}", name, fmt::join(methods, " and "),
                           methods.size() == 1 ? "takes" : "take", found);
    }
};

std::vector<SpecialOption> specialOptions(const FactorizeOptions& o) {
    return {{"terms", {"fit", "svd"}, o.terms != 0}, {"parametrization", {"svd"}, !o.parametrization.empty()}};
}

/// The method asked for; for auto those that fit the input and use every option that is set.
std::vector<std::string> methodsFor(const Reflectance& r, const FactorizeOptions& options) {
    if (options.method != "auto") return {options.method};
    std::vector<std::string> out = suitable(r, options);
    for (const SpecialOption& option : specialOptions(options)) {
        if (!option.isSet) continue;
        const std::string considered = fmt::format("auto, which chooses among {} here", fmt::join(out, ", "));
        std::erase_if(out, [&](const std::string& method) { return !option.isUsedBy(method); });
        require(!out.empty(), option.complaint(considered));
    }
    return out;
}

void checkOptions(const FactorizeOptions& options) {
    require(options.size == 0 || (options.size >= 2 && options.size <= 4096),
            fmt::format("factorize: size must be 2 to 4096, found {}", options.size));
    require(options.terms >= 0 && options.terms <= 3,
            fmt::format("factorize: terms must be 1 to 3, found {}", options.terms));
    require(!options.maxError || options.measure, "factorize: a bound on the error needs a measure");
    const std::optional<std::string> unused = unusedOption(options);
    require(!unused, unused.value_or(""));
    if (options.method == "auto") return;
    std::string known = "auto";
    for (const FactorizeMethod& m : factorizeMethods()) {
        if (m.name == options.method) return;
        known += ", " + m.name;
    }
    throw std::invalid_argument(fmt::format("unknown method '{}'; known: {}", options.method, known));
}

}  // namespace

std::vector<FactorizeMethod> factorizeMethods() {
    return {
        {"analytic", "F·D and G/(4 cos cos) as logarithms in adaptive coordinates, refined through the filter",
         "isotropic microfacet models"},
        {"cosine", "the same factors linear in the cosines, as HSE section 1.1 prints them",
         "isotropic microfacet models"},
        {"fit", "logarithmic tables over half and difference angle with harmonics in the azimuth", "isotropic input"},
        {"homomorphic", "diffuse + exp(P(wi) + Q(h) + P(wo)) with Fresnel and elevations as arithmetic", "any input"},
        {"svd", "sum of products of two textures, half/difference, in/out or symmetric", "any input"},
        {"single-lobe", "one texture with specular, diffuse and ambient terms", "phong, blinn-phong, cosine-lobe"},
        {"tangent", "one texture over the two angles to the tangent", "banks"}};
}

std::optional<std::string> unusedOption(const FactorizeOptions& options) {
    if (options.method == "auto") return {};
    for (const SpecialOption& option : specialOptions(options))
        if (option.isSet && !option.isUsedBy(options.method)) return option.complaint(options.method);
    return {};
}

FactoredBrdf factorize(const Reflectance& r, const FactorizeOptions& options) {
    checkOptions(options);
    const std::vector<std::string> methods = methodsFor(r, options);
    // The methods before others are the better ones, but for svd, which auto only names where neither is known to be.
    const bool together = methods.back() == "svd";
    if (options.size == 0) {
        if (options.maxError) return withinBudget(r, variantsOfAll(methods, r, options), options);
        if (options.maxBytes || options.maxFetches) return nearestWithinBudget(r, methods, options, together);
    }
    std::vector<FactoredBrdf> baked;
    for (const std::string& method : methods) {
        const Candidate c = options.size != 0 ? ofSize(method, options) : withTerms(usual(method, r), options);
        if (options.maxBytes && bytesOf(c, options, r) > *options.maxBytes)
            throw Error(fmt::format("{}: expected at most {} bytes, found {} or more for size {}", r.source,
                                    *options.maxBytes, bytesOf(c, options, r), options.size));
        baked.push_back(bake(r, c, options));
        if (!together) break;
    }
    return nearest(std::move(baked), r, options);
}

}  // namespace nacre
