#include "factorize/measured/rgl.hpp"

#include <fmt/format.h>

#include <memory>

#include "core/directions.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "factorize/measured/reciprocity.hpp"
#include "factorize/measured/tensor_file.hpp"

namespace nacre {

static constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 30;  // published RGB files: 0.7 to 60 MB

using Fields = std::vector<TensorField>;

static std::vector<float> readAxis(const Fields& fields, const std::string& field, const std::string& name) {
    std::vector<float> axis = floatsOf(tensorField(fields, field, TensorField::Float, {0}, name));
    for (std::size_t i = 0; i < axis.size(); ++i)
        if (!std::isfinite(axis[i]) || (i > 0 && axis[i] <= axis[i - 1]))
            throw Error(fmt::format("{}: field '{}': expected finite ascending angles, found {} at {}", name, field,
                                    axis[i], i));
    return axis;
}

/// Counts negative and non-finite numbers. Non-finite ones become 0, negative ones unless `keepNegative`.
static std::vector<float> readCounted(const TensorField& field, bool keepNegative, DataReport& data) {
    std::vector<float> values = floatsOf(field);
    data.entries += values.size();
    for (float& value : values) {
        const bool finite = std::isfinite(value);
        if (finite && value >= 0) continue;
        ++(finite ? data.negative : data.nonFinite);
        if (!finite || !keepNegative) value = 0;
    }
    return values;
}

static void checkGrid(const TensorField& field, const std::string& name) {
    const std::size_t n = field.shape.size();
    if (field.shape[n - 1] < 2 || field.shape[n - 2] < 2)
        throw Error(fmt::format("{}: field '{}': expected a grid of at least 2 x 2, found {} x {}", name, field.name,
                                field.shape[n - 1], field.shape[n - 2]));
}

static SlicedGrid gridOf(const TensorField& field, std::vector<float> values) {
    const std::size_t n = field.shape.size();
    return {field.shape[n - 1], field.shape[n - 2], std::move(values)};
}

static void readSigma(const Fields& fields, const std::string& name, RglTable& table) {
    const TensorField& field = tensorField(fields, "sigma", TensorField::Float, {0, 0}, name);
    checkGrid(field, name);
    table.sigma = gridOf(field, floatsOf(field));
    for (const float value : table.sigma.values)
        if (!(std::isfinite(value) && value > 0))
            throw Error(fmt::format("{}: field 'sigma': expected finite areas > 0, found {}", name, value));
}

static void readVisibleNormals(const Fields& fields, const std::string& name, RglTable& table) {
    const TensorField& field =
        tensorField(fields, "vndf", TensorField::Float, {table.phiI.size(), table.thetaI.size(), 0, 0}, name);
    checkGrid(field, name);
    table.visibleNormals = makeGridWarp(gridOf(field, readCounted(field, false, table.data)));
    if (table.visibleNormals.emptySlice)
        throw Error(fmt::format("{}: field 'vndf': expected a positive total in every slice, found none in slice {}",
                                name, *table.visibleNormals.emptySlice));
}

static void readValues(const Fields& fields, const std::string& name, RglTable& table) {
    const TensorField& field =
        tensorField(fields, "rgb", TensorField::Float, {table.phiI.size(), table.thetaI.size(), 3, 0, 0}, name);
    checkGrid(field, name);
    const std::vector<float> planar = readCounted(field, true, table.data);
    table.valueHeight = field.shape[3];
    table.valueWidth = field.shape[4];
    const std::size_t points = table.valueWidth * table.valueHeight;
    table.values.resize(planar.size() / 3);
    for (std::size_t i = 0; i < table.values.size(); ++i) {
        const float* first = &planar[i / points * 3 * points + i % points];
        table.values[i] = Rgb(first[0], first[points], first[2 * points]);
    }
}

static int symmetryOf(const std::vector<float>& phiI, const std::string& name) {
    const double span = phiI.back() - phiI.front();
    for (const int symmetry : {1, 2, 4})
        if (std::abs(span * symmetry - 2 * kPi) < 0.01) return symmetry;
    throw Error(fmt::format("{}: field 'phi_i': expected a span of 2π, π or π/2, found {}", name, span));
}

/// Rows are azimuths from -π to π about the incident direction.
static bool rowsAreMirrored(const SlicedGrid& grid) {
    constexpr double kRounding = 1e-6;
    const std::size_t points = grid.width * grid.height;
    for (std::size_t i = 0; i < grid.values.size(); ++i) {
        const std::size_t row = i % points / grid.width;
        const double here = grid.values[i],
                     there = grid.values[i + (grid.height - 1) * grid.width - 2 * row * grid.width];
        if (std::abs(here - there) > kRounding * (here + there)) return false;
    }
    return true;
}

void mirrorValues(RglTable& table) {
    if (!table.isotropic || !rowsAreMirrored(table.visibleNormals.density) || !rowsAreMirrored(table.ndf)) return;
    const std::size_t width = table.valueWidth, height = table.valueHeight;
    for (std::size_t slice = 0; slice < table.values.size(); slice += width * height)
        for (std::size_t row = 0; row < height / 2; ++row)
            for (std::size_t x = 0; x < width; ++x) {
                Rgb& low = table.values[slice + row * width + x];
                Rgb& high = table.values[slice + (height - 1 - row) * width + x];
                low = high = 0.5 * (low + high);
            }
    table.mirrored = true;
}

RglTable parseRgl(std::span<const std::uint8_t> bytes, const std::string& name) {
    const Fields fields = parseTensorFile(bytes, name);
    RglTable table;
    table.phiI = readAxis(fields, "phi_i", name);
    table.thetaI = readAxis(fields, "theta_i", name);
    table.isotropic = table.phiI.size() <= 2;
    if (!table.isotropic) table.symmetry = symmetryOf(table.phiI, name);
    readSigma(fields, name, table);
    const TensorField& ndf = tensorField(fields, "ndf", TensorField::Float, {0, 0}, name);
    checkGrid(ndf, name);
    table.ndf = gridOf(ndf, readCounted(ndf, false, table.data));
    readVisibleNormals(fields, name, table);
    readValues(fields, name, table);
    for (const TensorField& field : fields)
        if (field.name == "description") table.description.assign(field.bytes.begin(), field.bytes.end());
    table.data.rule =
        "negative (out of gamut) rgb becomes 0 after interpolation; negative ndf and vndf, and all non-finite numbers "
        "are "
        "set to 0 before it";
    return table;
}

static double azimuth(const Vec3& v) { return std::atan2(v.y, v.x); }

/// Elevation and azimuth as coordinates of [0,1]²; azimuths beyond ±π wrap around.
static Vec2 unitSquare(double theta, double phi) {
    const double turn = (phi + kPi) / (2 * kPi);
    return {std::sqrt(theta * 2 / kPi), turn - std::floor(turn)};
}

static double elevation(const Vec3& v) { return std::atan2(std::sqrt(v.x * v.x + v.y * v.y), v.z); }

/// Turns and mirrors both directions so that wi's azimuth falls into the measured range.
static void foldIntoRange(const RglTable& table, Vec3& wi, Vec3& wo) {
    const double first = table.phiI.front();
    const auto offset = [&] {
        const double phi = azimuth(wi) - first;
        return phi - 2 * kPi * std::floor(phi / (2 * kPi));
    };
    if (table.symmetry >= 2 && offset() > kPi) {
        wi = Vec3(-wi.x, -wi.y, wi.z);
        wo = Vec3(-wo.x, -wo.y, wo.z);
    }
    if (table.symmetry == 4 && offset() > kPi / 2) {  // mirror in the vertical plane at azimuth first + π/2
        const Vec3 across(std::sin(first + kPi / 2), -std::cos(first + kPi / 2), 0);
        wi -= 2 * dot(wi, across) * across;
        wo -= 2 * dot(wo, across) * across;
    }
}

static Rgb interpolateValues(const RglTable& table, const SliceBlend& blend, const Vec2& at) {
    const double x = at.x * static_cast<double>(table.valueWidth - 1);
    const double y = at.y * static_cast<double>(table.valueHeight - 1);
    const std::size_t column = std::min(static_cast<std::size_t>(x), table.valueWidth - 2);
    const std::size_t row = std::min(static_cast<std::size_t>(y), table.valueHeight - 2);
    const double fx = x - static_cast<double>(column), fy = y - static_cast<double>(row);
    Rgb sum(0);
    for (std::size_t n = 0; n < static_cast<std::size_t>(blend.count); ++n) {
        const Rgb* v = &table.values[(blend.slice[n] * table.valueHeight + row) * table.valueWidth + column];
        const Rgb low = glm::mix(v[0], v[1], fx), high = glm::mix(v[table.valueWidth], v[table.valueWidth + 1], fx);
        sum += static_cast<double>(blend.weight[n]) * glm::mix(low, high, fy);
    }
    return sum;
}

Rgb evaluateRaw(const RglTable& table, const Vec3& wiGiven, const Vec3& woGiven) {
    Vec3 wi = wiGiven, wo = woGiven;
    if (!(wi.z > 0 && wo.z > 0)) return Rgb(0);
    foldIntoRange(table, wi, wo);
    const Vec3 m = halfVector(wi, wo);
    const double thetaI = elevation(wi), phiI = azimuth(wi);
    const Vec2 atI = unitSquare(thetaI, phiI);
    const Vec2 atM = unitSquare(elevation(m), azimuth(m) - (table.isotropic ? phiI : 0));
    const double turn = 2 * kPi * std::floor((phiI - table.phiI.front()) / (2 * kPi));
    const SliceBlend blend = blendSlices(table.phiI, table.thetaI, phiI - turn, thetaI);
    const Vec2 v = toUniform(table.visibleNormals, blend, atM);
    const double cosThetaO = std::max(wo.z, std::cos(kRglGrazing));
    return glm::max(interpolateValues(table, blend, v), Rgb(0)) *
           (interpolate(table.ndf, 0, atM) / (4 * interpolate(table.sigma, 0, atI) * cosThetaO));
}

Rgb evaluateSymmetric(const RglTable& table, const Vec3& wi, const Vec3& wo) {
    const Rgb there = evaluateRaw(table, wi, wo), back = evaluateRaw(table, wo, wi);
    if (!table.isotropic || table.mirrored) return 0.5 * (there + back);
    const Vec3 mirroredWi(wi.x, -wi.y, wi.z), mirroredWo(wo.x, -wo.y, wo.z);
    return 0.25 *
           (there + back + evaluateRaw(table, mirroredWi, mirroredWo) + evaluateRaw(table, mirroredWo, mirroredWi));
}

Reflectance openRgl(const std::filesystem::path& path) {
    const std::vector<std::uint8_t> bytes = readFile(path, kMaxFileBytes);
    auto table = std::make_shared<RglTable>(parseRgl(bytes, path.string()));
    Reflectance out;
    out.source = path.string();
    out.kind = "rgl";
    out.hash = contentHash({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    out.isotropic = table->isotropic;
    out.data = table->data;
    out.data.rule += "; f is the mean over swapped directions";
    if (table->isotropic) out.data.rule += " and mirrored azimuths";
    out.reciprocityResidual =
        reciprocityResidual([&](const Vec3& wi, const Vec3& wo) { return evaluateRaw(*table, wi, wo); });
    mirrorValues(*table);
    out.f = [table = std::shared_ptr<const RglTable>(table)](const Vec3& wi, const Vec3& wo) {
        return evaluateSymmetric(*table, wi, wo);
    };
    return out;
}

}  // namespace nacre
