// One texel's horizon ellipse from its horizons.
#pragma once

#include <vector>

#include "bump/horizon_ellipses.hpp"

namespace nacre {

/// Fits ellipses to lit parts of the unit disk that are given by their radius towards evenly spaced azimuths. Radii: by
/// the number of directions misjudged, one an azimuth, as in the paper. Full: by the area misjudged.
class EllipseFitter {
public:
    static constexpr int kRound = 16;  ///< directions are rounded up to a multiple of it

    EllipseFitter(int directions, EllipseFit fit);

    int directions() const { return static_cast<int>(cosines_.size()); }

    /// \param lit  in [0, 1], directions() of them: azimuths 2πk/directions()
    HorizonEllipse fit(const std::vector<float>& lit) const;

private:
    HorizonEllipse fitPoints(const std::vector<float>& lit) const;
    HorizonEllipse fitArea(const std::vector<float>& lit) const;

    EllipseFit fit_;
    std::vector<float> cosines_, sines_;  ///< of the azimuths
    std::vector<float> radii_;            ///< of one direction each, spread evenly over the disk
};

}  // namespace nacre
