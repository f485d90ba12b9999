// What one of several renderers draws of a picture that is the sum of all their images (HYBRID section 4.4).
#pragma once

#include <cmath>
#include <cstddef>

namespace nacre {

/// Of things that are numbered, those whose place in [0, 1) is in [begin, end): multiples of the golden ratio without
/// their whole part, which any such part has its share of. The one that begins at 0 also takes what can't be shared.
struct DrawShare {
    double begin = 0, end = 1;
    /// \param part  0 to parts − 1, of equal ones
    static DrawShare equal(int part, int parts) { return {double(part) / parts, double(part + 1) / parts}; }
    bool takes(std::size_t index) const {
        const double turns = (static_cast<double>(index) + 0.5) * 0.6180339887498949, place = turns - std::floor(turns);
        return place >= begin && place < end;
    }
    bool first() const { return begin == 0; }
};

}  // namespace nacre
