// Which levels of detail a vertex needs to see, by what they are off by where that was measured.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace nacre {

/// Of what isn't near: the coarsest level wherever it is, levels by lodAngle, or by kFineAngle of that.
enum class VertexDetail : std::uint8_t { Coarsest, ByAngle, Fine };
inline constexpr float kFineAngle = 0.4f;

/// Gathers poses: one may be dark, or badly hidden, where others show nothing of it.
class MeasuredDetail {
public:
    explicit MeasuredDetail(std::size_t vertices);
    /// \param byAngle, coarsest  [vertex][coefficients] of a pose \param open  first coefficient of an open vertex
    void add(std::span<const float> byAngle, std::span<const float> coarsest, double open);
    /// [vertex] Fine where some pose leaves less than a tenth of an open vertex's light, as errors count relative to
    /// that; else Coarsest where it is never off by more than `error` of the least light.
    std::vector<VertexDetail> within(double error) const;

private:
    std::vector<float> off_, least_;
    std::vector<std::uint8_t> dark_;
};

}  // namespace nacre
