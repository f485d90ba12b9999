// The MERL BRDF database's `.binary` tables (Matusik et al. 2003): isotropic, 90 x 90 x 180 half/difference angles.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "factorize/reflectance.hpp"

namespace nacre {

inline constexpr int kMerlThetaH = 90, kMerlThetaD = 90, kMerlPhiD = 180;
inline constexpr std::size_t kMerlCells = std::size_t{90} * 90 * 180;

/// One value per cell, f in 1/sr. Cell (i, j, k) has its centre at thetaH = (π/2) ((i + 0.5)/90)², thetaD =
/// (π/2) (j + 0.5)/90, phiD = π (k + 0.5)/180: the original reader floors the same coordinates, so that a cell's value
/// is the mean over the cell, and its centre is where it is most accurate.
struct MerlTable {
    std::vector<glm::vec3> cells;  ///< kMerlCells, [thetaH][thetaD][phiD]; finite, ≥ 0
    DataReport data;               ///< entries are numbers in the file: three a cell
    /// E_L2 of the raw cells against their mirror images, φd → π − φd, within 80°: exchanging the two elevations of a
    /// pair is that mirror, for φd + π is the same cell by format.
    double mirrorResidual = 0;
    double energy = 0;  ///< Reflectance::energy of the trilinear function, exact within a block of eight centres
};

/// Parses a file's bytes: int32 90, 90, 180, then three channels of kMerlCells little-endian doubles, to be multiplied
/// by 1/1500, 1.15/1500, 1.66/1500. A cell is usable when its three numbers are finite and ≥ 0 and its centre pair is
/// above the horizon. The other cells are filled before any lookup: in rounds, each open cell with usable or already
/// filled neighbours (±1 in thetaH, thetaD, and phiD modulo π) takes the mean of those neighbours.
/// \param name  used in messages   \throws nacre::Error on wrong dimensions or size, or when no cell is usable
MerlTable parseMerl(std::span<const std::uint8_t> bytes, const std::string& name);

/// f(wi, wo) [1/sr]: trilinear between cell centres in (√thetaH, thetaD, phiD), constant beyond the outermost centres,
/// periodic in phiD with period π, which is reciprocity. 0 at or below the horizon. Costs 0.15 µs, 0.3 µs when the
/// table isn't in the cache.
Rgb evaluate(const MerlTable& table, const Vec3& wi, const Vec3& wo);

/// \throws nacre::Error naming file, expected and found
Reflectance openMerl(const std::filesystem::path& path);

}  // namespace nacre
