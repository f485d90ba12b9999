// How a model file declares what it offers. models.cpp collects them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "factorize/models/parameters.hpp"
#include "factorize/reflectance.hpp"

namespace nacre {

struct ModelSpec {
    std::string name, summary, source;
    std::vector<ParameterSpec> parameters;
    /// Fills f, isotropic and the pieces; source, kind and hash are makeModel's.
    std::function<Reflectance(const ParameterValues&)> build;
    std::string bare = {};  ///< the parameter that a lone word after the colon sets (`sgd:gold-paint`); empty for none
};

/// Below this elevation cosine a direction counts as at the horizon, where f = 0. A unit vector in double precision has
/// an absolute error of 1e-16, so there the cosine has lost its digits; the bound also keeps every quotient finite.
inline constexpr double kHorizon = 1e-12;

inline bool aboveHorizon(const Vec3& wi, const Vec3& wo) { return wi.z > kHorizon && wo.z > kHorizon; }

/// Puts f = diffuse(wi, wo) + fresnel(cosθd) · distribution(h) · visibility(wi, wo) together, as one function and as
/// pieces. cosθd = |wi + wo|/2 and h = (wi + wo)/|wi + wo|: no acos, and the same bits when wi and wo are swapped.
template <class Fresnel, class Distribution, class Visibility, class Diffuse>
MicrofacetPieces setMicrofacet(Reflectance& out, Fresnel fresnel, Distribution distribution, Visibility visibility,
                               Diffuse diffuse) {
    out.f = [=](const Vec3& wi, const Vec3& wo) -> Rgb {
        if (!aboveHorizon(wi, wo)) return Rgb(0);
        const Vec3 sum = wi + wo;
        const double length = glm::length(sum);
        return diffuse(wi, wo) +
               fresnel(std::min(1.0, 0.5 * length)) * (distribution(sum / length) * visibility(wi, wo));
    };
    MicrofacetPieces pieces;
    pieces.fresnel = fresnel;
    pieces.distribution = distribution;
    pieces.visibility = visibility;
    pieces.diffuse = diffuse;
    return pieces;
}

/// Lambert's constant term as a diffuse piece: value = kd/π.
struct ConstantDiffuse {
    Rgb value;
    Rgb operator()(const Vec3&, const Vec3&) const { return value; }
};

// One function a file in this folder.
std::vector<ModelSpec> phongModels();       // phong.cpp: lambert, phong, blinn-phong, cosine-lobe
std::vector<ModelSpec> microfacetModels();  // microfacet.cpp: torrance-sparrow, cook-torrance, ggx
ModelSpec schlickModel();                   // schlick.cpp
ModelSpec banksModel();                     // banks.cpp
ModelSpec sgdModel();                       // sgd.cpp
ModelSpec wardModel();                      // ward.cpp
ModelSpec ashikhminShirleyModel();          // ashikhmin_shirley.cpp

}  // namespace nacre
