// Method `homomorphic`: f = diffuse + C(1 − l·h) · exp(Q(h) + P(wi) + P(wo)) / (max(ni,no)^a (ni no)^b (l·h)^c).
// McCool, Ang & Ahmad 2001 factor ln f into p·q·p; a microfacet model's Fresnel term is a polynomial C, exact for
// Schlick's, its usual elevation factors are left to arithmetic, and its diffuse term never enters the product.
#include <fmt/format.h>
#include <Eigen/Dense>

#include "core/error.hpp"
#include "factorize/fit_samples.hpp"
#include "factorize/log_table_fit.hpp"
#include "factorize/mappings.hpp"
#include "factorize/methods.hpp"

namespace nacre {
namespace {

constexpr int kPolynomial = 9;    // coefficients of C, powers 0 to 8 of 1 − l·h
constexpr double kDarkLog = -30;  // stands for 0 in a logarithmic table

/// The part of f that costs no texture.
struct Arithmetic {
    double maxPower = 0, productPower = 0, cosPower = 0;  ///< a, b, c
    SmithShadowing shadowing = SmithShadowing::None;
    std::array<glm::vec3, kPolynomial> polynomial{};  ///< of 1 − l·h, lowest power first
};

struct Plan {
    Arithmetic arithmetic;
    bool elevations = false;  ///< has the texture P
    bool quadrant = true;     ///< f is mirror symmetric in x and in y
    glm::dvec2 width{0.3};
    bool color = false;  ///< Q and P hold RGB
};

glm::vec3 polynomialAt(const Arithmetic& a, float w) {
    glm::vec3 sum(0);
    for (int k = kPolynomial - 1; k >= 0; --k) sum = sum * w + a.polynomial[k];
    return sum;
}

glm::vec3 logOffset(const Plan& plan, const glm::vec3& wi, const glm::vec3& wo) {
    const Arithmetic& a = plan.arithmetic;
    const float w = halfGeometry(wi, wo).oneMinusLh;
    const double powers = a.maxPower * std::log(std::max(wi.z, wo.z)) + a.productPower * std::log(wi.z * wo.z) +
                          a.cosPower * std::log(1 - w) +
                          std::log(smithDenominator(a.shadowing, glm::vec2(plan.width), wi, wo));
    return glm::log(glm::max(polynomialAt(a, w), glm::vec3(1e-12f))) - static_cast<float>(powers);
}

/// Least-squares polynomial in w = 1 − cosθd of F(cosθd) · cosθd^c, nodes denser at both ends.
void fitPolynomial(const MicrofacetPieces& pieces, Arithmetic& a) {
    constexpr int kNodes = 96;
    Eigen::MatrixXd powers(kNodes, kPolynomial);
    Eigen::MatrixXd values(kNodes, 3);
    for (int i = 0; i < kNodes; ++i) {
        const double w = 0.5 - 0.5 * std::cos(kPi * (i + 0.5) / kNodes), cosD = 1 - w;
        const Rgb f = pieces.fresnel(cosD) * std::pow(cosD, a.cosPower);
        const double weight = (cosD + 0.02) / std::max(mean(f), 1e-9);  // relative error; grazing has little measure
        for (int k = 0; k < kPolynomial; ++k) powers(i, k) = weight * std::pow(w, k);
        for (int c = 0; c < 3; ++c) values(i, c) = weight * f[c];
    }
    const Eigen::MatrixXd x = powers.colPivHouseholderQr().solve(values);
    for (int k = 0; k < kPolynomial; ++k) a.polynomial[k] = glm::vec3(x(k, 0), x(k, 1), x(k, 2));
}

LogTableModel makeModel(const Plan& plan, const TextureSizes& sizes) {
    const std::vector<glm::vec3> colors =
        plan.color ? std::vector<glm::vec3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}} : std::vector<glm::vec3>{glm::vec3(1)};
    LogTableModel model;
    model.tables.emplace_back(sizes.first.x, sizes.first.y, colors);
    model.lookupCount = 1;
    if (plan.elevations) {
        model.tables.emplace_back(sizes.second.x, sizes.second.y, colors);
        model.lookupCount = 3;
    }
    const glm::vec2 inverse(1.0 / plan.width);
    model.lookups = [=](const FitSample& s, std::span<FitLookup> out) {
        const glm::vec3 wi(s.wi), wo(s.wo);
        out[0] = {0, mapScaledSlope(halfGeometry(wi, wo).h, inverse, plan.quadrant), glm::vec4(1)};
        if (!plan.elevations) return;
        out[1] = {1, mapLambertDisk(wi, plan.quadrant), glm::vec4(1)};
        out[2] = {1, mapLambertDisk(wo, plan.quadrant), glm::vec4(1)};
    };
    return model;
}

/// Q starts as ln D, or as the logarithm of f at mirror-like pairs of that half vector.
void fillSlopes(const Reflectance& r, const Plan& plan, FitTable& q) {
    for (int y = 0; y < q.height; ++y)
        for (int x = 0; x < q.width; ++x) {
            const glm::dvec2 uv(x / std::max(1.0, q.width - 1.0), y / std::max(1.0, q.height - 1.0));
            const Vec3 h = inverseScaledSlope(uv, plan.width, plan.quadrant);
            const Rgb value = r.microfacet ? Rgb(r.microfacet->distribution(h)) : r.f(h, h) + 1e-3;
            for (int c = 0; c < q.channels; ++c)
                q.texels[(static_cast<std::size_t>(y) * q.width + x) * q.channels + c] =
                    static_cast<float>(value[c] > 0 ? std::max(std::log(value[c]), kDarkLog) : kDarkLog);
        }
}

struct Fitted {
    Plan plan;
    LogTableModel model;
    double loss = std::numeric_limits<double>::infinity();
};

Fitted fitPlan(const Reflectance& r, const Plan& plan, const TextureSizes& sizes, std::vector<FitSample> samples,
               const FitOptions& fit) {
    for (FitSample& s : samples) {
        s.offset = logOffset(plan, glm::vec3(s.wi), glm::vec3(s.wo));
        if (r.microfacet) s.base = glm::vec3(r.microfacet->diffuse(s.wi, s.wo));
    }
    Fitted out{plan, makeModel(plan, sizes)};
    fillSlopes(r, plan, out.model.tables[0]);
    out.loss = fitLogTables(out.model, samples, fit);
    return out;
}

/// Which arithmetic suits a microfacet model, by coarse fits; P only where it earns its two fetches.
Plan choosePlan(const Reflectance& r, Plan plan, const std::vector<FitSample>& samples,
                const FactorizeOptions& options) {
    constexpr auto kNone = SmithShadowing::None;
    const TextureSizes coarse{{32, 32}, {16, 16}};
    Fitted best, bestWithP;
    for (const Arithmetic& a : {Arithmetic{0, 0, 0, kNone, {}},
                                {1, 0, 0, kNone, {}},
                                {0, 1, 0, kNone, {}},
                                {0, 0.5, 0, kNone, {}},
                                {1, 0, 1, kNone, {}},
                                {0, 0, 2, kNone, {}},
                                {0, 0, 0, SmithShadowing::Correlated, {}},
                                {0, 0, 0, SmithShadowing::Separable, {}}}) {
        plan.arithmetic = a;
        fitPolynomial(*r.microfacet, plan.arithmetic);
        const FitOptions fit{
            .newtonSteps = 3, .conjugateSteps = 15, .smoothness = 1e-5f, .anchored = true, .threads = options.threads};
        plan.elevations = false;
        if (Fitted tried = fitPlan(r, plan, coarse, samples, fit); tried.loss < best.loss) best = std::move(tried);
        plan.elevations = true;
        if (Fitted tried = fitPlan(r, plan, coarse, samples, fit); tried.loss < bestWithP.loss)
            bestWithP = std::move(tried);
        report(options.progress, "choosing factors", 0.2);
    }
    constexpr double kGoodEnough = 3e-5;  // loss of about 0.5 % error: the coarse tables' own
    const bool fetchesAllowed = !options.maxFetches || *options.maxFetches >= 3 + !r.microfacet->diffuseIsConstant;
    return fetchesAllowed && best.loss > kGoodEnough && best.loss > 4 * bestWithP.loss ? bestWithP.plan : best.plan;
}

/// Tabulated input: the slope map's width by coarse fits.
Plan chooseWidth(const Reflectance& r, Plan plan, const FactorizeOptions& options) {
    plan.elevations = plan.color = true;
    plan.arithmetic.polynomial[0] = glm::vec3(1);
    Fitted best;
    for (const double width : {std::clamp(lobeHalfWidth(r.f), 0.02, 1.0), 0.15, 0.4, 1.0}) {
        plan.width = glm::dvec2(width);
        const FitSampleOptions sampling{40000, plan.width, false, 1.5, options.threads};
        Fitted tried = fitPlan(r, plan, {{24, 24}, {24, 24}}, fitSamples(r.f, sampling),
                               {.newtonSteps = 4, .conjugateSteps = 15, .threads = options.threads});
        if (tried.loss < best.loss) best = std::move(tried);
        report(options.progress, "choosing coordinates", 0.2);
    }
    return best.plan;
}

Plan makePlan(const Reflectance& r, const FactorizeOptions& options) {
    Plan plan;
    plan.quadrant = isQuadrantSymmetric(r.f);
    if (!r.microfacet) return chooseWidth(r, plan, options);
    plan.width = glm::dvec2(std::clamp(r.microfacet->alphaX, 1e-4, 2.0), std::clamp(r.microfacet->alphaY, 1e-4, 2.0));
    FitSampleOptions sampling{40000, plan.width, false, 1.5, options.threads};
    return choosePlan(r, plan, fitSamples(r.f, sampling), options);
}

AssetTexture diffuseTexture(const MicrofacetPieces& pieces, TexelFormat format) {
    constexpr int kEdge = 16;
    Image image(kEdge, kEdge, 3);
    for (int y = 0; y < kEdge; ++y)
        for (int x = 0; x < kEdge; ++x) {
            const ElevationPair e = inverseElevations(x / (kEdge - 1.0), y / (kEdge - 1.0));
            const auto at = [](double c) { return Vec3(std::sqrt(1 - c * c), 0, std::max(c, 1e-6)); };
            image.setRgb(x, y, pieces.diffuse(at(e.cosMin), at(e.cosMax)));
        }
    return makeTexture("diffuse", "elevations", image, format);
}

}  // namespace

FactoredBrdf factorizeHomomorphic(const Reflectance& r, const TextureSizes& sizes, const FactorizeOptions& options) {
    const Plan plan = makePlan(r, options);
    report(options.progress, "fitting", 0.4);
    FitSampleOptions sampling{400000, plan.width, false, 1.55, options.threads};
    const Fitted fitted = fitPlan(r, plan, sizes, fitSamples(r.f, sampling),
                                  {.newtonSteps = r.microfacet ? 5 : 10,
                                   .conjugateSteps = 25,
                                   .smoothness = r.microfacet ? 1e-5f : 1e-3f,
                                   .anchored = r.microfacet.has_value(),
                                   .threads = options.threads});
    report(options.progress, "fitted", 1);

    FactoredBrdf out;
    out.form = FactoredForm::Homomorphic;
    out.method = "homomorphic";
    const bool diffuseTextured = r.microfacet && !r.microfacet->diffuseIsConstant;
    const Arithmetic& a = plan.arithmetic;
    out.params[0] = {1 / plan.width.x, 1 / plan.width.y, plan.quadrant, plan.elevations};
    out.params[1] = {a.maxPower, a.productPower, diffuseTextured, a.cosPower};
    if (r.microfacet && !diffuseTextured)
        out.params[2] = glm::vec4(glm::vec3(r.microfacet->diffuse(Vec3(0, 0, 1), Vec3(0, 0, 1))), 0);
    out.params[2].w = static_cast<float>(a.shadowing);
    for (int k = 0; k < kPolynomial; ++k) out.params[3 + k] = glm::vec4(a.polynomial[k], 0);
    for (int k = 0; k < 3; ++k) {  // colour columns: RGB, or one channel for all three
        const glm::vec4 grey = k == 0 ? glm::vec4(1, 1, 1, 0) : glm::vec4(0);
        glm::vec4 color(0);
        color[k] = 1;
        out.params[12 + k] = plan.color ? color : grey;
    }
    out.textures.push_back(makeTexture("q", "scaled_slope", fitted.model.tables[0].image(), options.format));
    if (plan.elevations)
        out.textures.push_back(makeTexture("p", "lambert_disk", fitted.model.tables[1].image(), options.format));
    if (diffuseTextured) out.textures.push_back(diffuseTexture(*r.microfacet, options.format));
    out.fetches = 1 + 2 * plan.elevations + diffuseTextured;
    return out;
}

}  // namespace nacre
