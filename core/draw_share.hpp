// What one of several renderers draws of a picture that is the sum of all their images (HYBRID section 4.4).
#pragma once

#include <cstddef>

namespace nacre {

/// Takes every parts-th thing. The first also takes what can't be shared.
struct DrawShare {
    int part = 0, parts = 1;
    bool takes(std::size_t index) const { return index % static_cast<std::size_t>(parts) == std::size_t(part); }
    bool first() const { return part == 0; }
};

}  // namespace nacre
