// What is said of a source's data before anything is made of it.
#pragma once

#include "factorize/reflectance.hpp"

namespace nacre::cli {

/// One line on standard error when entries of measured data had to be handled by a rule.
void tellDataReport(const Reflectance& reflectance);

}  // namespace nacre::cli
