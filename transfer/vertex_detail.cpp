#include "transfer/vertex_detail.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nacre {
namespace {

constexpr double kDark = 0.1;  // of an open vertex's light

}  // namespace

MeasuredDetail::MeasuredDetail(std::size_t vertices)
    : off_(vertices, 0), least_(vertices, std::numeric_limits<float>::max()), dark_(vertices, 0) {}

void MeasuredDetail::add(std::span<const float> byAngle, std::span<const float> coarsest, double open) {
    const std::size_t size = byAngle.size() / off_.size();
    for (std::size_t v = 0; v < off_.size(); ++v) {
        float off = 0, light = 0;
        for (std::size_t c = size * v; c < size * (v + 1); ++c) {
            off += (coarsest[c] - byAngle[c]) * (coarsest[c] - byAngle[c]);
            light += byAngle[c] * byAngle[c];
        }
        off_[v] = std::max(off_[v], std::sqrt(off));
        least_[v] = std::min(least_[v], std::sqrt(light));
        if (byAngle[size * v] < kDark * open) dark_[v] = 1;
    }
}

std::vector<VertexDetail> MeasuredDetail::within(double error) const {
    std::vector<VertexDetail> out(off_.size(), VertexDetail::ByAngle);
    for (std::size_t v = 0; v < out.size(); ++v)
        if (dark_[v])
            out[v] = VertexDetail::Fine;
        else if (error > 0 && off_[v] <= static_cast<float>(error) * least_[v])
            out[v] = VertexDetail::Coarsest;
    return out;
}

}  // namespace nacre
