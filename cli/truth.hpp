// The truth that a bake is measured against.
#pragma once

#include "factorize/reflectance.hpp"

namespace nacre::cli {

/// For analytic models the independent implementation of reference/, where there is one; else the reflectance itself.
BrdfFunction truthOf(const Reflectance& reflectance);

/// One line on standard error when entries of measured data had to be handled by a rule.
void tellDataReport(const Reflectance& reflectance);

}  // namespace nacre::cli
