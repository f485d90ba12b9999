#include "transfer/proxy_shadow.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {
namespace {

std::size_t countOf(int order) { return static_cast<std::size_t>((order + 1) * (order + 1)); }

/// The frame whose turn undoes a receiver's.
Receiver inverse(const Receiver& r) {
    const glm::mat3 back = glm::transpose(glm::mat3(r.tangent, r.bitangent, r.normal));
    return {glm::vec3(0), back[0], back[1], back[2]};
}

/// A light's colours in three lanes, turned by the frame.
LightCoefficients turned(const HarmonicRotation& rotation, const LightCoefficients& light, const Receiver& frame) {
    const std::size_t count = light.size();
    std::vector<float> before(count * kLanes, 0.0f), after(3 * count);
    for (std::size_t i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c) before[i * kLanes + static_cast<std::size_t>(c)] = static_cast<float>(light[i][c]);
    const std::vector<Receiver> frames(3, frame);
    rotation.turn(frames.data(), 3, before.data(), after.data());
    LightCoefficients out(count);
    for (std::size_t i = 0; i < count; ++i) out[i] = {after[i], after[count + i], after[2 * count + i]};
    return out;
}

}  // namespace

ShadowProxy::ShadowProxy(const WeldedMesh& mesh, std::span<const glm::vec3> rest, std::size_t triangles) {
    level_ = makeBlockerLevels(mesh, rest, {.coarse = triangles}).levels.back();
    corners_ = cornersOfVertices(level_.triangles, mesh.vertexCount());
}

void ShadowProxy::move(std::span<const glm::vec3> positions) {
    const std::vector<glm::vec3> pushed = pushedPositions(level_, corners_, positions, extentOf(positions));
    blockers_.clear();
    centre_ = Vec3(0);
    for (const glm::uvec3& t : level_.triangles) {
        blockers_.push_back(blockerRow(pushed[t.x], pushed[t.y], pushed[t.z]));
        centre_ += (Vec3(pushed[t.x]) + Vec3(pushed[t.y]) + Vec3(pushed[t.z])) / 3.0;
    }
    centre_ /= static_cast<double>(std::max<std::size_t>(level_.triangles.size(), 1));
}

LightProjector::LightProjector(int order, int mask) : rotation_(order), mask_(mask) {
    maskKernel(mask);  // throws for sizes that no mask has
    for (int row = 0; row < mask; ++row)
        for (int step = 0; step < mask; ++step)
            for (int l = 0; l <= order; ++l)
                for (int m = -l; m <= l; ++m)
                    harmonics_.push_back(static_cast<float>(
                        harmonicAt(l, m, std::sqrt(1 - (step + 0.5) / mask), 2 * kPi * (row + 0.5) / mask)));
    for (int step = 0; step < mask; ++step)
        solidAngles_.push_back(2 * kPi / mask *
                               (std::sqrt(1 - double(step) / mask) - std::sqrt(1 - double(step + 1) / mask)));
}

void LightProjector::drawInto(std::vector<std::uint32_t>& mask, const Receiver& receiver,
                              const ShadowProxy& proxy) const {
    std::vector<std::uint32_t> indices(proxy.blockers().size() + kLanes);
    std::iota(indices.begin(), indices.end(), 0u);
    maskKernel(mask_).draw(*maskRows(mask_), proxy.blockers().data(), receiver, true, indices.data(),
                           proxy.blockers().size(), mask.data());
}

void LightProjector::addHidden(LightCoefficients& hidden, const LightCoefficients& light, const Receiver& receiver,
                               std::span<const std::uint32_t> mask) const {
    const std::size_t count = light.size(), size = static_cast<std::size_t>(mask_);
    const LightCoefficients here = turned(rotation_, light, inverse(receiver));
    LightCoefficients local(count, Rgb(0));
    for (std::size_t word = 0; word < mask.size(); ++word)
        for (std::uint32_t bits = mask[word]; bits != 0; bits &= bits - 1) {
            const std::size_t row = word % size,
                              step = word / size * 32 + static_cast<std::size_t>(std::countr_zero(bits));
            const float* y = &harmonics_[(row * size + step) * count];
            Rgb radiance(0);
            for (std::size_t i = 0; i < count; ++i) radiance += static_cast<double>(y[i]) * here[i];
            radiance *= solidAngles_[step];
            for (std::size_t i = 0; i < count; ++i) local[i] += static_cast<double>(y[i]) * radiance;
        }
    const LightCoefficients world = turned(rotation_, local, receiver);
    for (std::size_t i = 0; i < count; ++i) hidden[i] += world[i];
}

LightCoefficients LightProjector::shadowed(const LightCoefficients& light, const Vec3& at,
                                           std::span<const ShadowProxy* const> proxies) const {
    require(light.size() == countOf(rotation_.order()), "shadowed light: expected light of the projector's order");
    LightCoefficients hidden(light.size(), Rgb(0));
    // Both hemispheres of one axis, so that what several proxies hide counts once.
    Vec3 towards(0);
    for (const ShadowProxy* proxy : proxies) towards += proxy->centre() - at;
    const double distance = glm::length(towards);
    const glm::vec3 axis = distance > 0 ? glm::vec3(towards / distance) : glm::vec3(0, 1, 0);
    for (const glm::vec3& normal : {axis, -axis}) {
        const Receiver receiver = receiverAt(glm::vec3(at), normal);
        std::vector<std::uint32_t> mask(maskWords(mask_), 0);
        for (const ShadowProxy* proxy : proxies) drawInto(mask, receiver, *proxy);
        addHidden(hidden, light, receiver, mask);
    }
    LightCoefficients out = light;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] -= hidden[i];
    return out;
}

LightCoefficients LightGrid::at(const Vec3& point) const {
    int first[3];
    double share[3];
    for (int a = 0; a < 3; ++a) {
        const double extent = high[a] - low[a];
        const double x = extent > 0 ? (point[a] - low[a]) / extent * cells[a] - 0.5 : 0;
        first[a] = std::clamp(static_cast<int>(std::floor(x)), 0, std::max(cells[a] - 2, 0));
        share[a] = cells[a] > 1 ? std::clamp(x - first[a], 0.0, 1.0) : 0;
    }
    LightCoefficients out(lights[0].size(), Rgb(0));
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1;
        std::size_t index = 0, stride = 1;
        for (int a = 0; a < 3; ++a) {
            const int far = corner >> a & 1;
            weight *= far ? share[a] : 1 - share[a];
            index += stride * static_cast<std::size_t>(std::min(first[a] + far, cells[a] - 1));
            stride *= static_cast<std::size_t>(cells[a]);
        }
        if (weight == 0) continue;
        for (std::size_t i = 0; i < out.size(); ++i) out[i] += weight * lights[index][i];
    }
    return out;
}

LightGrid shadowedLights(const LightProjector& projector, const LightCoefficients& light,
                         std::span<const glm::vec3> positions, const glm::ivec3& cells,
                         std::span<const ShadowProxy* const> proxies, unsigned threads) {
    require(!positions.empty() && cells.x >= 1 && cells.y >= 1 && cells.z >= 1,
            "shadowed lights: expected positions, and at least one cell along each axis");
    LightGrid grid{positions[0], positions[0], cells, {}};
    for (const glm::vec3& p : positions)
        grid.low = glm::min(grid.low, Vec3(p)), grid.high = glm::max(grid.high, Vec3(p));
    grid.lights.resize(static_cast<std::size_t>(cells.x * cells.y * cells.z));
    projector.shadowed(light, grid.low, proxies);  // throws here, not in the loop
    parallelFor(grid.lights.size(), threads, [&](std::size_t i) {
        const int at = static_cast<int>(i);
        const Vec3 cell(at % cells.x, at / cells.x % cells.y, at / (cells.x * cells.y));
        grid.lights[i] =
            projector.shadowed(light, grid.low + (cell + 0.5) / Vec3(cells) * (grid.high - grid.low), proxies);
    });
    return grid;
}

std::vector<glm::vec3> exitantRadiance(std::span<const float> transfer, std::span<const glm::vec3> positions,
                                       const LightGrid& grid, const Rgb& albedo, unsigned threads) {
    require(!positions.empty() && transfer.size() == positions.size() * grid.lights.at(0).size(),
            "exitant radiance: expected as many coefficients a vertex as the grid's light has");
    std::vector<glm::vec3> out(positions.size());
    const std::size_t count = grid.lights[0].size();
    parallelFor(out.size(), threads, [&](std::size_t v) {
        const LightCoefficients light = grid.at(positions[v]);
        Rgb sum(0);
        for (std::size_t i = 0; i < count; ++i) sum += static_cast<double>(transfer[v * count + i]) * light[i];
        out[v] = albedo * sum;
    });
    return out;
}

}  // namespace nacre
