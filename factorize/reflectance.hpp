// A reflectance is what goes into a factorization: a BRDF as a function, what is known of where it came from, and, for
// analytic models, the pieces it is made of (HSE section 1.1, eq. 1).
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "core/math.hpp"

namespace nacre {

/// BRDF f(wi, wo) [1/sr], without the cosine; 0 when either direction is at or below the horizon; finite, ≥ 0.
/// Safe to call from several threads.
using BrdfFunction = std::function<Rgb(const Vec3& wi, const Vec3& wo)>;

/// A model of microfacet shape: f = diffuse(wi, wo) + fresnel(cosθd) · distribution(h) · visibility(wi, wo), where
/// visibility is everything that depends on the elevations (G / (4 cosα cosβ) and its like) and is symmetric.
struct MicrofacetPieces {
    std::function<Rgb(double cosThetaD)> fresnel;       ///< every factor of cosθd alone, specular colour too
    std::function<double(const Vec3& h)> distribution;  ///< may overflow towards +inf nowhere
    std::function<double(const Vec3& wi, const Vec3& wo)> visibility;
    std::function<Rgb(const Vec3& wi, const Vec3& wo)> diffuse;  ///< always set; may return 0
    double alphaX = 0, alphaY = 0;      ///< slope widths of the distribution along x and y; equal when isotropic
    bool visibilityIsIsotropic = true;  ///< visibility depends on the two elevations alone
    bool diffuseIsConstant = true;      ///< diffuse(wi, wo) is the same for all directions
};

/// A model with one lobe about one direction (HSE section 1.1, single-texture forms): f = diffuse + lobe(s).
/// Half: s = n·h. Axis: s = axis.x wi.x wo.x + axis.y wi.y wo.y + axis.z wi.z wo.z (Phong has axis (-1,-1,1)), s ≤ 1.
struct SingleLobePieces {
    enum class Argument { Half, Axis };
    Argument argument = Argument::Half;
    Vec3 axis{-1, -1, 1};
    std::function<Rgb(double s)> lobe;  ///< 0 for s ≤ 0
    double exponent = 0;                ///< of the lobe: how sharp it is
    Rgb diffuse{0}, ambient{0};         ///< diffuse: f of the diffuse term [1/sr]; ambient: radiance added to f·cosα
};

/// Banks 1994 (HSE eq. 4 without its cosα): f = value(t·wi, t·wo), t = the tangent (x axis).
struct TangentPieces {
    std::function<Rgb(double tDotWi, double tDotWo)> value;
    double exponent = 0;
};

/// What a reader of measured data found and did. Nothing is repaired silently.
struct DataReport {
    std::uint64_t entries = 0, missing = 0, negative = 0, nonFinite = 0;
    std::uint64_t distinct = 0;  ///< scattered samples alone: pairs of directions, those of one place counted once
    /// Scattered samples alone: √(Σ w |f̂−f|² / Σ w f²) of samples predicted without those at and about them, w = cosθi
    /// cosθo, pairs below 80° where there are any. What the errors of a bake can't say: how near the gridding is to the
    /// surface. NaN when nothing could be left out.
    double holdoutL2Rel = std::numeric_limits<double>::quiet_NaN();
    std::string rule;  ///< one sentence: how those entries are handled
};

struct Reflectance {
    std::string source;  ///< canonical textual form of a model, or the path as given
    std::string kind;    ///< analytic, merl, rgl, samples, micro
    std::string hash;    ///< contentHash of the file, or of the canonical text
    BrdfFunction f;
    bool isotropic = true;
    DataReport data;
    /// E_L2 of the raw data against itself with wi and wo swapped; NaN where the source is reciprocal by construction.
    double reciprocityResidual = std::numeric_limits<double>::quiet_NaN();
    /// ∫ f² dμ over θi, θo ≤ 80° (dμ = cosθi cosθo dωi dωo, channels summed) from a table's own cells. NaN where nobody
    /// counted: formulas, and tables with cells so wide that no sampling misses one.
    double energy = std::numeric_limits<double>::quiet_NaN();
    /// Analytic models fill those that apply.
    std::optional<MicrofacetPieces> microfacet;
    std::optional<SingleLobePieces> singleLobe;
    std::optional<TangentPieces> tangent;
};

/// Opens any source: a model (`torrance-sparrow:alpha=0.1`), a published fit (`sgd:gold-paint`), a file
/// (.binary MERL, .bsdf RGL, .csv samples), or a simulated micro-geometry (`micro:ridges,slope=1`).
/// \throws std::invalid_argument for an unknown model or parameter (lists the known ones); nacre::Error for a bad file
Reflectance openReflectance(const std::string& source);

}  // namespace nacre
