// A virtual gonioreflectometer: the BRDF of a coloured relief seen from afar, by masking, shadowing and interreflection
// (Westin, Arvo & Torrance 1992; the figure to remake is HSE figure 4).
#pragma once

#include <span>

#include "factorize/micro/direction_table.hpp"
#include "factorize/micro/height_field.hpp"

namespace nacre {

struct GonioreflectometerOptions {
    int resolution = 24;   ///< of the table, ≥ 2
    int bounces = 3;       ///< of light between facets after the first, ≥ 0
    int rays = 64;         ///< a facet, for the light between facets, ≥ 1
    unsigned threads = 0;  ///< 0 = all cores; same bits for any
};

/// Facets p with area a_p are Lambertian, and light and view are the same all over a facet: with
///   w_p(d) = a_p max(0, n_p·d) escapes(centre_p, d),  W(d) = Σ_p w_p(d)  (the projected area, A cosθ in the limit),
///   E_p(wi) = w_p(wi)/a_p + Σ_q F_pq B_q, B_q = ρ_q E_q  (F: share of p's cosine-weighted rays that hit q first),
///   f(wi, wo) = A/(W(wi) W(wo)) Σ_p w_p(wo) B_p(wi)/π,   A = Σ_p a_p n_p.z.
/// Dividing by W and not by A cosθ makes a flat relief exactly ρ/π, and keeps few facets seen at grazing angles from
/// brightening. Where no facet is seen at all (W = 0) f is 0. The table is the mean of f(wi, wo) and f(wo, wi).
/// O(facets · (resolution² + rays) rays + facets · resolution⁴).
/// \throws std::invalid_argument for no facets or options out of range
DirectionTable simulateReflectance(std::span<const Facet> facets, const SurfaceTracer& tracer,
                                   const GonioreflectometerOptions& options);

}  // namespace nacre
