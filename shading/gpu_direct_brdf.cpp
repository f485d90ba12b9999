#include "shading/gpu_direct_brdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <sstream>

#include "core/error.hpp"
#include "factorize/models/sgd.hpp"

namespace nacre {
namespace {

/// The canonical text taken apart: makeModel wrote it, so every parameter is there and in range.
class Canonical {
public:
    explicit Canonical(const std::string& text) : name_(text.substr(0, text.find(':'))) {
        if (name_.size() == text.size()) return;
        std::istringstream pairs(text.substr(name_.size() + 1));
        for (std::string pair; std::getline(pairs, pair, ',');) {
            const std::size_t equals = std::min(pair.find('='), pair.size() - 1);
            values_[pair.substr(0, equals)] = pair.substr(equals + 1);
        }
    }
    const std::string& name() const { return name_; }
    const std::string& text(const std::string& key) const {
        const auto at = values_.find(key);
        if (at == values_.end()) throw std::invalid_argument(fmt::format("directBrdf: {} has no {}", name_, key));
        return at->second;
    }
    /// One number, or three separated by '/'.
    Rgb color(const std::string& key) const {
        std::istringstream parts(text(key));
        std::vector<double> out;
        for (std::string part; std::getline(parts, part, '/');) {
            double value = 0;
            const auto end = std::from_chars(part.data(), part.data() + part.size(), value).ptr;
            require(end == part.data() + part.size(), fmt::format("directBrdf: {}={} is no number", key, text(key)));
            out.push_back(value);
        }
        require(out.size() == 1 || out.size() == 3, fmt::format("directBrdf: {}={} is no color", key, text(key)));
        return out.size() == 3 ? Rgb(out[0], out[1], out[2]) : Rgb(out[0]);
    }
    double number(const std::string& key) const { return color(key).x; }
    /// PREFIX_VALUE in capitals with '_' for '-'.
    std::string macro(const std::string& prefix, const std::string& key) const {
        std::string out = prefix + text(key);
        for (char& c : out) c = c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        return out;
    }

private:
    std::string name_;
    std::map<std::string, std::string> values_;
};

/// The shader's constants by meaning (bind/direct_brdf.glsl).
struct Constants {
    Vec4 first{0};
    Rgb diffuse{0}, ks{0}, eta{0}, k{0};
};

GpuDirectBrdf make(ShaderDefines defines, const Constants& c) {
    std::array<glm::vec4, kDirectParams> params{};
    params[0] = glm::vec4(c.first);
    params[1] = glm::vec4(glm::vec3(c.diffuse), 0);
    params[2] = glm::vec4(glm::vec3(c.ks), 0);
    params[3] = glm::vec4(glm::vec3(c.eta), 0);
    params[4] = glm::vec4(glm::vec3(c.k), 0);
    return {std::move(defines), params};
}

GpuDirectBrdf singleLobe(const Canonical& text, const SingleLobePieces& pieces) {
    Constants c;
    c.diffuse = pieces.diffuse;
    if (text.name() == "lambert") return make({{"NACRE_DIRECT", "NACRE_DIRECT_LAMBERT"}}, c);
    c.first.x = pieces.exponent;
    c.ks = pieces.lobe(1);  // scale · 1^n
    c.eta = pieces.axis;
    const bool half = pieces.argument == SingleLobePieces::Argument::Half;
    return make({{"NACRE_DIRECT", half ? "NACRE_DIRECT_BLINN_PHONG" : "NACRE_DIRECT_COSINE_LOBE"}}, c);
}

GpuDirectBrdf microfacet(const Canonical& text, const MicrofacetPieces& pieces) {
    Constants c;
    const std::string fresnel = text.text("f"), d = text.name() == "ggx" ? "NACRE_D_GGX" : text.macro("NACRE_D_", "d");
    c.first = {pieces.alphaX, pieces.alphaY, 0, text.name() == "cook-torrance" ? 4 / kPi : 1};
    if (d == "NACRE_D_GAUSSIAN") c.first.z = pieces.distribution(Vec3(0, 0, 1));  // its normalisation
    c.diffuse = text.color("kd") / kPi;
    c.ks = text.color("ks");
    c.eta = text.color(fresnel == "schlick" ? "f0" : "eta");
    c.k = text.color("k");
    ShaderDefines defines{{"NACRE_DIRECT", "NACRE_DIRECT_MICROFACET"},
                          {"NACRE_D", d},
                          {"NACRE_G", text.macro("NACRE_G_", "g")},
                          {"NACRE_F", text.macro("NACRE_F_", "f")}};
    if (c.eta == Rgb(c.eta.x) && (fresnel != "conductor" || c.k == Rgb(c.k.x)))
        defines.push_back({"NACRE_F_GRAY", "1"});
    return make(std::move(defines), c);
}

GpuDirectBrdf ward(const Canonical& text) {
    Constants c;
    c.first = {text.number("alphax"), text.number("alphay"), 0, 0};
    c.diffuse = text.color("kd") / kPi;
    c.ks = text.color("ks");
    const std::string& variant = text.text("variant");
    const char* macro = variant == "ward1992" ? "NACRE_WARD_1992"
                        : variant == "duer"   ? "NACRE_WARD_DUER"
                                              : "NACRE_WARD_GMD";
    return make({{"NACRE_DIRECT", "NACRE_DIRECT_WARD"}, {"NACRE_WARD", macro}}, c);
}

GpuDirectBrdf ashikhminShirley(const Canonical& text) {
    Constants c;
    const double nu = text.number("nu"), nv = text.number("nv");
    c.first = {nu, nv, std::sqrt((nu + 1) * (nv + 1)) / (2 * kPi), 0};
    c.eta = text.color("rs");
    c.diffuse = 28 / (23 * kPi) * text.color("rd") * (Rgb(1) - c.eta);
    return make({{"NACRE_DIRECT", "NACRE_DIRECT_ASHIKHMIN_SHIRLEY"}}, c);
}

GpuDirectBrdf schlick(const Canonical& text) {
    Constants c;
    c.first = {text.number("r"), text.number("p"), 0, 0};
    c.diffuse = text.color("kd") / kPi;
    c.eta = text.color("f0");
    return make({{"NACRE_DIRECT", "NACRE_DIRECT_SCHLICK"}}, c);
}

GpuDirectBrdf banks(const Canonical& text) {
    Constants c;
    c.first.x = text.number("n");
    c.diffuse = text.color("kd");
    c.ks = text.color("ks");
    return make({{"NACRE_DIRECT", "NACRE_DIRECT_BANKS"}}, c);
}

GpuDirectBrdf sgd(const Canonical& text) {
    const auto materials = sgdMaterials();
    const auto at = std::find_if(materials.begin(), materials.end(), [&text](const SgdMaterial& material) {
        return material.name == text.text("material");
    });
    require(at != materials.end(), "directBrdf: unknown material " + text.text("material"));
    const Rgb values[] = {Rgb(0), at->rhoD / kPi, at->rhoS,   at->alpha, at->p, at->f0,
                          at->f1, at->kap,        at->lambda, at->c,     at->k, at->theta0};
    std::array<glm::vec4, kDirectParams> params{};
    for (std::size_t i = 0; i < std::size(values); ++i) params[i] = glm::vec4(glm::vec3(values[i]), 0);
    return {{{"NACRE_DIRECT", "NACRE_DIRECT_SGD"}}, params};
}

}  // namespace

std::optional<GpuDirectBrdf> directBrdf(const Reflectance& reflectance) {
    if (reflectance.kind != "analytic") return {};
    const Canonical text(reflectance.source);
    if (reflectance.singleLobe) return singleLobe(text, *reflectance.singleLobe);
    if (text.name() == "torrance-sparrow" || text.name() == "cook-torrance" || text.name() == "ggx")
        return microfacet(text, reflectance.microfacet.value());
    if (text.name() == "ward") return ward(text);
    if (text.name() == "ashikhmin-shirley") return ashikhminShirley(text);
    if (text.name() == "schlick") return schlick(text);
    if (text.name() == "banks") return banks(text);
    if (text.name() == "sgd") return sgd(text);
    return {};
}

}  // namespace nacre
