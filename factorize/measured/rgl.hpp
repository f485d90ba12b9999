// The RGL material database's RGB `.bsdf` files (Dupuy & Jakob 2018, "An adaptive parameterization for efficient
// material acquisition and rendering"), isotropic and anisotropic.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "factorize/measured/grid_warp.hpp"
#include "factorize/reflectance.hpp"

namespace nacre {

/// Directions are stored as u = (√(2θ/π), (φ + π)/2π). phi_i, theta_i: the incident directions of the slices.
struct RglTable {
    std::vector<float> phiI, thetaI;  ///< ascending [rad]
    bool isotropic = true;            ///< one or two phi_i: then azimuths are relative to the incident one
    bool mirrored = false;            ///< `values` and the warp are symmetric in azimuth: mirrorValues
    int symmetry = 1;                 ///< 1, 2, 4: phi_i spans 2π, π (turned by π), π/2 (also mirrored)
    SlicedGrid sigma, ndf;            ///< one slice: projected area of the microsurface; its normals
    GridWarp visibleNormals;          ///< vndf, a slice an incident direction
    std::vector<Rgb> values;          ///< `rgb` on valueSize², at points of [0,1]² that visibleNormals warps to
    std::size_t valueWidth = 0, valueHeight = 0;
    std::string description;  ///< as in the file, any bytes; may be empty
    DataReport data;          ///< entries: numbers of rgb, ndf and vndf
};

/// Reads fields phi_i, theta_i, sigma, ndf, vndf, rgb, description. (luminance and jacobian serve sampling alone, and
/// the published files disagree about what a bit of `valid` means.)
/// \param bytes  a whole file   \param name  used in messages
/// \throws nacre::Error naming file, field, expected and found
RglTable parseRgl(std::span<const std::uint8_t> bytes, const std::string& name);

/// Elevation of wo beyond which the division by its cosine stops growing: the interpolated f·cosθo is not quite 0 at
/// the horizon, where nothing was measured.
inline constexpr double kRglGrazing = 87 * kPi / 180;

/// Averages `values` over mirrored azimuths, where that is the same as averaging evaluations: isotropic data whose ndf
/// and vndf are symmetric (the published files are, to rounding). Otherwise changes nothing.
void mirrorValues(RglTable& table);

/// The data as measured [1/sr], not reciprocal: light from wi. With m = (wi + wo)/|wi + wo| and v = the point that the
/// sampling of vndf(wi) turns into m,
///   f = max(0, rgb(wi, v)) · ndf(m) / (4 sigma(wi) cosθo),   θo held at kRglGrazing beyond it
/// (Dupuy & Jakob 2018, eq. 8 to 10; rgb holds f cosθo over the microfacet factor, as the published samples of a white
/// paper show: its f is reciprocal to 4 % with the cosine, and differs by 42 % without).
/// 0 when either direction is at or below the horizon.
Rgb evaluateRaw(const RglTable& table, const Vec3& wi, const Vec3& wo);

/// What Reflectance::f answers: the mean of evaluateRaw for (wi, wo) and (wo, wi), and, for isotropic data, of the same
/// two mirrored in azimuth (which costs nothing in a mirrored table): reciprocal, and a function of
/// (thetaH, thetaD, cos²phiD) alone.
Rgb evaluateSymmetric(const RglTable& table, const Vec3& wi, const Vec3& wo);

/// \throws nacre::Error naming file, expected and found
Reflectance openRgl(const std::filesystem::path& path);

}  // namespace nacre
