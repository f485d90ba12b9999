// A BRDF from scattered samples: a CSV file of direction pairs and values, gridded for lookups. Isotropic.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/directions.hpp"
#include "factorize/reflectance.hpp"

namespace nacre {

struct BrdfSample {
    DirectionPair pair;
    Rgb f;  ///< [1/sr], finite, ≥ 0
};

struct ParsedSamples {
    std::vector<BrdfSample> samples;
    DataReport data;  ///< entries: lines with numbers; the others: lines left out for that reason
};

/// Reads CSV with a header line: `wix,wiy,wiz,wox,woy,woz,r,g,b` (unit vectors), `theta_i,phi_i,theta_o,phi_o,r,g,b`
/// [rad] or the same with `_deg` behind the four angles [degrees]. Empty lines and lines that start with # are passed
/// over. Lines with a negative or non-finite value, and lines with a direction at the horizon (`missing`), are counted
/// and left out. \throws nacre::Error naming file, line, expected and found: unknown header, wrong number of columns, a
/// column that is
///         no number, a direction that is not unit to 1 % or lies below the horizon; also when no sample is left
ParsedSamples parseSamples(std::string_view text, const std::string& name);

/// Logarithms on a grid over x = √(2θh/π), y = 2θd/π, z = φd folded to [0, π/2] over π/2 (isotropy's mirror symmetry
/// and reciprocity): vertices from 0 to 1 inclusive, z fastest.
struct SampleGrid {
    static constexpr int kX = 32, kY = 24, kZ = 12;
    static constexpr double kOffset = 1e-4;  ///< stored: ln(f + kOffset) [1/sr], so that 0 is a value
    std::vector<glm::vec3> logs;
};

/// Each vertex takes a locally linear regression of the logarithm over its 24 nearest samples: tricube weights that end
/// at the farthest of them, a ridge of 1 % on the slopes, and the result held between the least and the largest of
/// their values. Distances in (x, y, x y z), because φd means nothing where θh or θd is 0.
/// Limits: isotropic only; detail below 1/32 of √θh or 1/24 of θd is lost; where samples are sparse the 24 nearest lie
/// far away and the result is smooth guesswork. O(vertices · samples): 1 s of one core for 50000 samples.
/// \throws std::invalid_argument for no samples
SampleGrid gridSamples(const std::vector<BrdfSample>& samples, unsigned threads = 0);

/// How well samples foretell each other: sets `distinct` and `holdoutL2Rel` of `data`. Places (grid coordinates, to
/// 1e-6) are dealt out to five groups, or one group each when there are fewer than 100; up to 2000 are predicted by
/// gridSamples' regression over the samples of the other groups. O(min(samples, 2000) · samples)
void holdOut(const std::vector<BrdfSample>& samples, DataReport& data, unsigned threads = 0);

/// f(wi, wo) [1/sr], trilinear in the logarithm; 0 at or below the horizon. Reciprocal.
Rgb evaluate(const SampleGrid& grid, const Vec3& wi, const Vec3& wo);

/// \throws nacre::Error as parseSamples
Reflectance openSamples(const std::filesystem::path& path);

}  // namespace nacre
