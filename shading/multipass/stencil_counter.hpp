// What the values of the stencil buffer mean (PR94 "Recursion", MPR 7.3): the lower half counts specular recursion, the
// upper half the surfaces of shadow volumes.
//
// PR94 draws wherever the value is 0, and adds one everywhere else on the way down. Here a view of level d draws where
// the value is d, which is the same count seen from the other end: masks add one, and no pass over the whole picture is
// needed. Outside of the view's own pixels all values are other levels', so that one test finds them.
#pragma once

namespace nacre {

struct StencilCounter {
    int bits = 8;

    constexpr int range() const { return 1 << bits; }
    constexpr int shadowMin() const { return range() / 2; }       ///< SHAD_MIN: what is below counts recursion
    constexpr int shadowZero() const { return 3 * range() / 4; }  ///< SHAD_ZERO: no shadow volume entered or left
    constexpr int deepest() const { return shadowMin() - 1; }     ///< levels of recursion there is room for
    /// Volumes that may be entered, or left, between two resets.
    constexpr int mostVolumes() const { return range() / 4 - 1; }
};

}  // namespace nacre
