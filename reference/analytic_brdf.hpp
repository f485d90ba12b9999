// The analytic models once more, as their papers print them: angles and trigonometry, no shortcuts. The truth against
// which `nacre factorize` measures, and the check of factorize/models/, which uses other formulas.
#pragma once

#include <optional>
#include <string>

#include "factorize/reflectance.hpp"

namespace nacre {

/// lambert, phong, blinn-phong, cosine-lobe, torrance-sparrow, cook-torrance, ggx, ward, ashikhmin-shirley, schlick and
/// banks; formulas and sources stand beside each in analytic_brdf.cpp and microfacet_terms.hpp. Costs below 1 µs a
/// call. \param canonicalSource  Reflectance::source of makeModel: the model's name with every parameter \return
/// nothing for models that are not in this list, and for files \throws std::invalid_argument when a parameter is
/// missing or is no number
std::optional<BrdfFunction> referenceBrdf(const std::string& canonicalSource);

}  // namespace nacre
