// Light probes: the whole surrounding in a disk.
#pragma once

#include <vector>

#include "core/environment.hpp"

namespace nacre {

/// Point (u, v) of the disk in [−1, 1]², v up, r² = u² + v², φ = the angle from +z, which is in the middle:
///   Angular     φ = π r: (u, v) = (Dx, Dy) acos(Dz) / (π √(Dx² + Dy²)), from Debevec 1998's light probe gallery, whose
///               angmap.cal has +z (backward) in the middle.
///   MirrorBall  r = sin(φ/2): a mirrored ball seen by a distant camera at +z that looks along −z; the middle shows the
///               camera. Equal-area.
enum class ProbeKind { Angular, MirrorBall };

/// Direction of a point with r ≤ 1.
Vec3 probeDirection(ProbeKind kind, double u, double v);
/// Inverse of probeDirection; the direction −z is the whole rim, of which the point (1, 0) is given.
glm::dvec2 probePoint(ProbeKind kind, const Vec3& direction);

/// Solid angle of each texel of an N × N probe [sr], by its centre; 0 outside the disk.
std::vector<double> probeSolidAngles(ProbeKind kind, int size);

/// A cube of half the probe's edge, at least 1: four times as many texels as the disk has in its middle. Each is the
/// mean of the probe's texels at 8 × 8 points.
/// \throws std::invalid_argument unless the image is square with three channels
EnvMap cubeFromProbe(const Image& probe, ProbeKind kind, unsigned threads = 0);

}  // namespace nacre
