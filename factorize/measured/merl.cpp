#include "factorize/measured/merl.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <numeric>

#include "core/directions.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/parallel.hpp"

namespace nacre {

static constexpr std::size_t kHeaderBytes = 12;
static constexpr std::size_t kFileBytes = kHeaderBytes + kMerlCells * 3 * sizeof(double);
static constexpr std::array<double, 3> kChannelScale = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
static constexpr double kMissingMark = -1;  // what the database's files hold where nothing was measured

static std::size_t cellIndex(int h, int d, int p) {
    return (static_cast<std::size_t>(h) * kMerlThetaD + static_cast<std::size_t>(d)) * kMerlPhiD +
           static_cast<std::size_t>(p);
}

static void checkSize(std::span<const std::uint8_t> bytes, const std::string& name) {
    if (bytes.size() < kHeaderBytes)
        throw Error(fmt::format("{}: expected a MERL table of {} bytes, found {}", name, kFileBytes, bytes.size()));
    std::array<std::int32_t, 3> dims{};
    std::memcpy(dims.data(), bytes.data(), kHeaderBytes);
    if (dims != std::array<std::int32_t, 3>{kMerlThetaH, kMerlThetaD, kMerlPhiD})
        throw Error(fmt::format("{}: expected MERL dimensions {} {} {}, found {} {} {} in a file of {} bytes", name,
                                kMerlThetaH, kMerlThetaD, kMerlPhiD, dims[0], dims[1], dims[2], bytes.size()));
    if (bytes.size() != kFileBytes)
        throw Error(fmt::format("{}: expected {} bytes for MERL dimensions {} {} {}, found {}", name, kFileBytes,
                                kMerlThetaH, kMerlThetaD, kMerlPhiD, bytes.size()));
}

/// Both directions of the cell's centre above the horizon. With phi_h = 0 and d = (sinθd cosφd, ·, cosθd) the pair's
/// heights are cosθh cosθd ∓ sinθh sinθd cosφd.
static bool centreAboveHorizon(int h, int d, int p) {
    const double thetaH = kPi / 2 * sqr((h + 0.5) / kMerlThetaH), thetaD = kPi / 2 * (d + 0.5) / kMerlThetaD;
    const double phiD = kPi * (p + 0.5) / kMerlPhiD;
    return std::cos(thetaH) * std::cos(thetaD) > std::sin(thetaH) * std::sin(thetaD) * std::abs(std::cos(phiD));
}

enum CellState : std::uint8_t { Open, Usable };

/// Reads, scales and counts; cells that are not usable stay Open.
static std::vector<std::uint8_t> readCells(std::span<const std::uint8_t> bytes, MerlTable& table) {
    std::vector<std::uint8_t> state(kMerlCells, Usable);
    table.cells.resize(kMerlCells);
    table.data.entries = 3 * kMerlCells;
    const std::uint8_t* next = bytes.data() + kHeaderBytes;
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < kMerlCells; ++i, next += sizeof(double)) {
            double value;
            std::memcpy(&value, next, sizeof value);
            const double scaled = value * kChannelScale[c];
            // Large doubles would become infinite in single precision.
            const bool nonFinite = !(std::abs(scaled) <= std::numeric_limits<float>::max());
            if (nonFinite)
                ++table.data.nonFinite;
            else if (value == kMissingMark)
                ++table.data.missing;
            else if (value < 0)
                ++table.data.negative;
            if (nonFinite || value < 0)
                state[i] = Open;
            else
                table.cells[i][static_cast<int>(c)] = static_cast<float>(scaled);
        }
    return state;
}

/// Closes cells below the horizon, whatever they hold. \return  cells above it that have no usable value
static std::size_t closeBelowHorizon(std::vector<std::uint8_t>& state) {
    std::size_t holes = 0;
    for (int h = 0; h < kMerlThetaH; ++h)
        for (int d = 0; d < kMerlThetaD; ++d)
            for (int p = 0; p < kMerlPhiD / 2; ++p) {  // |cosφd| is symmetric about π/2
                const std::size_t i = cellIndex(h, d, p), mirrored = cellIndex(h, d, kMerlPhiD - 1 - p);
                if (centreAboveHorizon(h, d, p))
                    holes += (state[i] == Open) + (state[mirrored] == Open);
                else
                    state[i] = state[mirrored] = Open;
            }
    return holes;
}

struct Neighbours {
    std::array<std::size_t, 6> index;
    int count = 0;
    void add(std::size_t i) { index[static_cast<std::size_t>(count++)] = i; }
};

static Neighbours neighboursOf(std::size_t cell) {
    const int p = static_cast<int>(cell % kMerlPhiD), d = static_cast<int>(cell / kMerlPhiD % kMerlThetaD),
              h = static_cast<int>(cell / kMerlPhiD / kMerlThetaD);
    Neighbours out;
    if (h > 0) out.add(cellIndex(h - 1, d, p));
    if (h < kMerlThetaH - 1) out.add(cellIndex(h + 1, d, p));
    if (d > 0) out.add(cellIndex(h, d - 1, p));
    if (d < kMerlThetaD - 1) out.add(cellIndex(h, d + 1, p));
    out.add(cellIndex(h, d, (p + kMerlPhiD - 1) % kMerlPhiD));
    out.add(cellIndex(h, d, (p + 1) % kMerlPhiD));
    return out;
}

static glm::vec3 meanOfUsable(const MerlTable& table, const std::vector<std::uint8_t>& state, std::size_t cell) {
    const Neighbours near = neighboursOf(cell);
    Rgb sum(0);
    int count = 0;
    for (int n = 0; n < near.count; ++n) {
        const std::size_t i = near.index[static_cast<std::size_t>(n)];
        if (state[i] != Usable) continue;
        sum += Rgb(table.cells[i]);
        ++count;
    }
    return glm::vec3(sum / static_cast<double>(count));
}

/// The rounds of parseMerl's filling rule. A round's values depend on earlier rounds alone, so order plays no part.
static void fillOpenCells(MerlTable& table, std::vector<std::uint8_t>& state) {
    constexpr std::uint8_t kQueued = 2;
    std::vector<std::size_t> front, next;
    const auto queueOpenAround = [&](std::size_t cell, std::vector<std::size_t>& queue) {
        const Neighbours near = neighboursOf(cell);
        for (int n = 0; n < near.count; ++n) {
            const std::size_t i = near.index[static_cast<std::size_t>(n)];
            if (state[i] != Open) continue;
            state[i] = kQueued;
            queue.push_back(i);
        }
    };
    for (std::size_t i = 0; i < kMerlCells; ++i)
        if (state[i] == Usable) queueOpenAround(i, front);
    for (; !front.empty(); front.swap(next), next.clear()) {
        for (const std::size_t i : front) table.cells[i] = meanOfUsable(table, state, i);
        for (const std::size_t i : front) state[i] = Usable;
        for (const std::size_t i : front) queueOpenAround(i, next);
    }
}

/// Averages every cell with its mirror image, φd → π − φd, and keeps how far apart they were. A surface that has no
/// direction of its own looks the same in a mirror; with the table's own φd + π that makes f the same for exchanged
/// elevations, which the raw values are not.
static void symmetrise(MerlTable& table, const std::vector<std::uint8_t>& measured) {
    double gap = 0, total = 0;
    for (int h = 0; h < kMerlThetaH; ++h)
        for (int d = 0; d < kMerlThetaD; ++d) {
            const double u = (h + 0.5) / kMerlThetaH, thetaH = kPi / 2 * u * u,
                         thetaD = kPi / 2 * (d + 0.5) / kMerlThetaD;
            for (int p = 0; p < kMerlPhiD / 2; ++p) {
                const std::size_t i = cellIndex(h, d, p), j = cellIndex(h, d, kMerlPhiD - 1 - p);
                const glm::vec3 a = table.cells[i], b = table.cells[j];
                table.cells[i] = table.cells[j] = 0.5f * (a + b);
                const double rise = std::cos(thetaH) * std::cos(thetaD),
                             tilt = std::sin(thetaH) * std::sin(thetaD) * std::cos(kPi * (p + 0.5) / kMerlPhiD);
                if (rise - std::abs(tilt) < std::cos(80 * kPi / 180) || !measured[i] || !measured[j]) continue;
                // dμ of a cell: cosθi cosθo · 4 cosθd · sinθh sinθd, dθh ∝ u.
                const double measure =
                    (rise * rise - tilt * tilt) * std::cos(thetaD) * std::sin(thetaH) * std::sin(thetaD) * u;
                gap += 2 * measure * glm::dot(Vec3(a - b), Vec3(a - b));
                total += measure * (glm::dot(Vec3(a), Vec3(a)) + glm::dot(Vec3(b), Vec3(b)));
            }
        }
    table.mirrorResidual = total > 0 ? std::sqrt(gap / total) : 0;
}

/// Mean of |f|² over a block between eight centres, f trilinear: along one axis (a² + ab + b²)/3, hence
/// Σ_ij v_i·v_j / (27 · 2^(axes on which i and j differ)).
static double meanSquare(const std::array<glm::vec3, 8>& corner) {
    double sum = 0;
    for (unsigned i = 0; i < 8; ++i)
        for (unsigned j = 0; j < 8; ++j)
            sum += glm::dot(corner[i], corner[j]) / static_cast<float>(1 << std::popcount(i ^ j));
    return sum / 27;
}

/// The blocks between the centres `h` and `h` + 1 of θh. dωi dωo = 4 cosθd sinθh sinθd dθh dφh dθd dφd, θh = (π/2)u².
static double energyOfRow(const MerlTable& table, int h) {
    const double u = (h + 1.0) / kMerlThetaH, thetaH = kPi / 2 * u * u;
    const double volume = kPi * u / kMerlThetaH * (kPi / 2 / kMerlThetaD) * (kPi / kMerlPhiD) * 2 * kPi;
    double sum = 0;
    for (int d = 0; d + 1 < kMerlThetaD; ++d)
        for (int p = 0; p < kMerlPhiD; ++p) {
            const double thetaD = kPi / 2 * (d + 1.0) / kMerlThetaD, phiD = kPi * (p + 1.0) / kMerlPhiD;
            const double rise = std::cos(thetaH) * std::cos(thetaD),
                         tilt = std::sin(thetaH) * std::sin(thetaD) * std::cos(phiD);
            if (rise - std::abs(tilt) < std::cos(80 * kPi / 180)) continue;
            std::array<glm::vec3, 8> corner;
            for (int i = 0; i < 8; ++i)
                corner[static_cast<std::size_t>(i)] =
                    table.cells[cellIndex(h + (i & 1), d + (i >> 1 & 1), (p + (i >> 2)) % kMerlPhiD)];
            sum += (rise * rise - tilt * tilt) * 4 * std::cos(thetaD) * std::sin(thetaH) * std::sin(thetaD) *
                   meanSquare(corner);
        }
    return 2 * volume * sum;  // φd runs over 2π, the table over π
}

static double energyOf(const MerlTable& table) {
    std::vector<double> rows(kMerlThetaH - 1);
    parallelFor(rows.size(), 0, [&](std::size_t h) { rows[h] = energyOfRow(table, static_cast<int>(h)); });
    return std::accumulate(rows.begin(), rows.end(), 0.0);
}

MerlTable parseMerl(std::span<const std::uint8_t> bytes, const std::string& name) {
    checkSize(bytes, name);
    MerlTable table;
    std::vector<std::uint8_t> state = readCells(bytes, table);
    const std::size_t holes = closeBelowHorizon(state);
    if (std::find(state.begin(), state.end(), Usable) == state.end())
        throw Error(
            fmt::format("{}: expected a finite value ≥ 0 above the horizon, found none in {} cells", name, kMerlCells));
    table.data.rule = fmt::format(
        "cells with a number that is -1 (missing), negative or not finite, {} of them above the horizon, and cells "
        "below the horizon are filled by the mean of their usable neighbours, nearest first; then every cell is "
        "averaged "
        "with its mirror image in azimuth",
        holes);
    const std::vector<std::uint8_t> measured = state;
    fillOpenCells(table, state);
    symmetrise(table, measured);
    table.energy = energyOf(table);
    return table;
}

namespace {
struct Interval {  // lower cell, upper cell, weight of the upper one
    int low, high;
    float weight;
};
}  // namespace

/// \param x  position in cells, centres at + 0.5; clamped to the outermost centres
static Interval clampedInterval(double x, int count) {
    const double at = std::clamp(x - 0.5, 0.0, static_cast<double>(count - 1));
    const int low = std::min(static_cast<int>(at), count - 2);
    return {low, low + 1, static_cast<float>(at - low)};
}

static Interval periodicInterval(double x, int count) {
    const double at = x - 0.5, floor = std::floor(at);
    const int low = (static_cast<int>(floor) % count + count) % count;
    return {low, low + 1 == count ? 0 : low + 1, static_cast<float>(at - floor)};
}

/// φd of a pair, as halfDifference (core/directions.hpp) but without its sines and cosines of angles.
static double differenceAzimuth(const Vec3& wi, const Vec3& h, double sinThetaH) {
    const double cp = sinThetaH > 1e-15 ? h.x / sinThetaH : 1, sp = sinThetaH > 1e-15 ? h.y / sinThetaH : 0;
    const double dx = h.z * (cp * wi.x + sp * wi.y) - sinThetaH * wi.z, dy = cp * wi.y - sp * wi.x;
    return std::abs(dx) < 1e-15 && std::abs(dy) < 1e-15 ? 0 : std::atan2(dy, dx);
}

Rgb evaluate(const MerlTable& table, const Vec3& wi, const Vec3& wo) {
    if (!(wi.z > 0 && wo.z > 0)) return Rgb(0);
    const Vec3 sum = wi + wo, difference = wi - wo;
    const double sumLength = glm::length(sum);  // > 0: both are above the horizon
    const Vec3 half = sum / sumLength;
    const double sinThetaH = std::sqrt(half.x * half.x + half.y * half.y);
    const double thetaH = std::atan2(sinThetaH, half.z), thetaD = std::atan2(glm::length(difference), sumLength);
    const Interval h = clampedInterval(std::sqrt(thetaH * 2 / kPi) * kMerlThetaH, kMerlThetaH);
    const Interval d = clampedInterval(thetaD * 2 / kPi * kMerlThetaD, kMerlThetaD);
    const Interval p = periodicInterval(differenceAzimuth(wi, half, sinThetaH) / kPi * kMerlPhiD, kMerlPhiD);
    const auto alongPhi = [&](int ih, int id) {
        return glm::mix(table.cells[cellIndex(ih, id, p.low)], table.cells[cellIndex(ih, id, p.high)], p.weight);
    };
    const auto alongThetaD = [&](int ih) { return glm::mix(alongPhi(ih, d.low), alongPhi(ih, d.high), d.weight); };
    return Rgb(glm::mix(alongThetaD(h.low), alongThetaD(h.high), h.weight));
}

Reflectance openMerl(const std::filesystem::path& path) {
    const std::vector<std::uint8_t> bytes = readFile(path, 2 * kFileBytes);
    auto table = std::make_shared<const MerlTable>(parseMerl(bytes, path.string()));
    Reflectance out;
    out.source = path.string();
    out.kind = "merl";
    out.hash = contentHash({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    out.data = table->data;
    out.reciprocityResidual = table->mirrorResidual;
    out.energy = table->energy;
    out.f = [table](const Vec3& wi, const Vec3& wo) { return evaluate(*table, wi, wo); };
    return out;
}

}  // namespace nacre
