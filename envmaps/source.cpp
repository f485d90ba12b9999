#include "envmaps/source.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <optional>

#include "core/asset.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "envmaps/convert.hpp"
#include "envmaps/env_asset.hpp"
#include "envmaps/probe.hpp"

namespace nacre {

namespace fs = std::filesystem;

namespace {

struct LayoutInfo {
    SourceLayout layout;
    const char* name;
    int width, height;  ///< proportions
};
constexpr std::array<LayoutInfo, 11> kLayouts{{{SourceLayout::Auto, "auto", 0, 0},
                                               {SourceLayout::LatLong, "latlong", 2, 1},
                                               {SourceLayout::CubeStrip, "cube_strip", 1, 6},
                                               {SourceLayout::CubeRow, "cube_row", 6, 1},
                                               {SourceLayout::CubeHorizontalCross, "cube_hcross", 4, 3},
                                               {SourceLayout::CubeVerticalCross, "cube_vcross", 3, 4},
                                               {SourceLayout::CubeFaces, "cube_faces", 1, 1},
                                               {SourceLayout::Angular, "angular", 1, 1},
                                               {SourceLayout::MirrorBall, "mirror_ball", 1, 1},
                                               {SourceLayout::DualParaboloid, "dual_paraboloid", 1, 2},
                                               {SourceLayout::Octahedral, "octahedral", 1, 1}}};

const LayoutInfo& infoOf(SourceLayout layout) { return kLayouts[static_cast<std::size_t>(layout)]; }

constexpr std::array<std::array<const char*, 6>, 2> kFaceNames{
    {{"px", "nx", "py", "ny", "pz", "nz"}, {"posx", "negx", "posy", "negy", "posz", "negz"}}};

/// The picture as it came, its channels made three.
Image rgbOf(const Image& image) {
    Image out(image.width(), image.height(), 3);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) out.setRgb(x, y, image.rgb(x, y));
    return out;
}

}  // namespace

std::string toString(SourceLayout layout) { return infoOf(layout).name; }

std::vector<std::string> sourceLayoutNames() {
    std::vector<std::string> names;
    for (const LayoutInfo& info : kLayouts) names.emplace_back(info.name);
    return names;
}

SourceLayout sourceLayoutFromString(const std::string& name) {
    std::string known;
    for (const LayoutInfo& info : kLayouts) {
        if (name == info.name) return info.layout;
        known += (known.empty() ? "" : ", ") + std::string(info.name);
    }
    throw std::invalid_argument(fmt::format("unknown source layout '{}'; known: {}", name, known));
}

static bool hasProportions(const Image& image, int width, int height) {
    return std::int64_t{image.width()} * height == std::int64_t{image.height()} * width && image.width() % width == 0;
}

static SourceLayout layoutByProportions(const Image& image, const std::string& name) {
    for (const SourceLayout layout : {SourceLayout::LatLong, SourceLayout::CubeStrip, SourceLayout::CubeRow,
                                      SourceLayout::CubeHorizontalCross, SourceLayout::CubeVerticalCross})
        if (hasProportions(image, infoOf(layout).width, infoOf(layout).height)) return layout;
    if (hasProportions(image, 1, 1) || hasProportions(image, 1, 2))
        throw Error(
            fmt::format("{}: expected a named layout (angular, mirror_ball, octahedral, dual_paraboloid), found {} x "
                        "{} texels, which may be any of them",
                        name, image.width(), image.height()));
    throw Error(
        fmt::format("{}: expected proportions 2:1 (latlong), 1:6 or 6:1 (cube faces), 4:3 or 3:4 (cube cross), "
                    "found {} x {} texels",
                    name, image.width(), image.height()));
}

static SourceLayout layoutOf(const ImageFile& file, const std::string& name, SourceLayout wanted) {
    const bool byAttribute = wanted == SourceLayout::Auto && file.envmap;
    SourceLayout layout = wanted;
    if (byAttribute) layout = file.envmap == "cube" ? SourceLayout::CubeStrip : SourceLayout::LatLong;
    if (layout == SourceLayout::Auto) layout = layoutByProportions(file.image, name);
    const LayoutInfo& info = infoOf(layout);
    const bool sideBySide = layout == SourceLayout::DualParaboloid && hasProportions(file.image, 2, 1);
    if (!sideBySide && !hasProportions(file.image, info.width, info.height))
        throw Error(fmt::format("{}: expected proportions {}:{} for {}{}, found {} x {} texels", name, info.width,
                                info.height, info.name, byAttribute ? " (its envmap attribute)" : "",
                                file.image.width(), file.image.height()));
    return layout;
}

static std::optional<CubeArrangement> arrangementOf(SourceLayout layout) {
    switch (layout) {
        case SourceLayout::CubeStrip:
        case SourceLayout::CubeFaces:
            return CubeArrangement::Strip;
        case SourceLayout::CubeRow:
            return CubeArrangement::Row;
        case SourceLayout::CubeHorizontalCross:
            return CubeArrangement::HorizontalCross;
        case SourceLayout::CubeVerticalCross:
            return CubeArrangement::VerticalCross;
        default:
            return {};
    }
}

/// Faces by the attribute, by name, or by whose seams fit. Both readings of a cross fit: it is taken as seen from
/// inside.
static EnvMap cubeOf(const Image& image, CubeArrangement arrangement, const std::string& wanted, bool attribute,
                     SourceReport& report) {
    static constexpr double kClearlyBetter = 0.7;  // ratio of mismatches; equal ones, as of a constant map, say nothing
    require(wanted == "auto" || wanted == "openexr" || wanted == "gl",
            fmt::format("unknown face orientation '{}'; known: auto, openexr, gl", wanted));
    const auto read = [&](bool gl) {
        report.faces = gl ? "gl" : "openexr";
        return cubeFromArrangement(image, arrangement, gl ? FaceOrientation::Gl : FaceOrientation::OpenExr);
    };
    const bool cross = arrangement == CubeArrangement::HorizontalCross || arrangement == CubeArrangement::VerticalCross;
    if (wanted != "auto" || cross || attribute) return read(wanted == "gl");
    EnvMap exr = read(false), gl = read(true);
    report.seamsOpenExr = seamMismatch(exr);
    report.seamsGl = seamMismatch(gl);
    if (report.seamsGl < kClearlyBetter * report.seamsOpenExr) return gl;
    report.faces = "openexr";
    return exr;
}

static Image stackedParaboloids(const Image& image) {
    if (image.height() == 2 * image.width()) return image;
    const int size = image.height();
    Image out(size, 2 * size, 3);
    for (int y = 0; y < 2 * size; ++y)
        for (int x = 0; x < size; ++x) out.setRgb(x, y, image.rgb(x + (y >= size ? size : 0), y % size));
    return out;
}

static void check(EnvMap& map, const SourceOptions& options, SourceReport& report) {
    const bool blocks = map.layout == EnvLayout::Cube || map.layout == EnvLayout::DualParaboloid;
    report.texels =
        checkTexels(map.image, envSolidAngles(map.layout, map.size(), options.threads),
                    {blocks ? map.size() : 0, map.layout == EnvLayout::LatLong}, options.negative, report.path);
}

static EnvMap probeMap(Image image, ProbeKind kind, const SourceOptions& options, SourceReport& report) {
    const std::vector<double> weights = probeSolidAngles(kind, image.width());
    for (std::size_t i = 0; i < image.data().size(); ++i)
        if (weights[i / 3] == 0) image.data()[i] = 0;  // outside the disk there is no surrounding
    report.texels = checkTexels(image, weights, {}, options.negative, report.path);
    return cubeFromProbe(image, kind, options.threads);
}

/// The map as it lies in the file, its texels checked.
static EnvMap mapOf(const ImageFile& file, const SourceOptions& options, SourceReport& report) {
    Image image = rgbOf(file.image);
    if (report.layout == SourceLayout::Angular || report.layout == SourceLayout::MirrorBall)
        return probeMap(std::move(image),
                        report.layout == SourceLayout::Angular ? ProbeKind::Angular : ProbeKind::MirrorBall, options,
                        report);
    EnvMap map;
    if (const auto arrangement = arrangementOf(report.layout))
        map = cubeOf(image, *arrangement, options.faces, file.envmap.has_value(), report);
    else if (report.layout == SourceLayout::LatLong)
        map = EnvMap(EnvLayout::LatLong, std::move(image));
    else if (report.layout == SourceLayout::DualParaboloid)
        map = EnvMap(EnvLayout::DualParaboloid, stackedParaboloids(image));
    else
        map = EnvMap(EnvLayout::Octahedral, std::move(image));
    check(map, options, report);
    return map;
}

static SourceReport reportOf(const ImageFile& file, const std::string& name, const SourceOptions& options) {
    SourceReport report;
    report.path = name;
    report.hash = file.hash;
    report.format = file.format;
    report.sampleType = file.sampleType;
    report.width = file.image.width();
    report.height = file.image.height();
    report.srgbDecoded = file.srgbDecoded;
    report.exposure = file.exposure;
    report.flip = options.flip;
    report.yaw = options.yaw;
    report.negative = options.negative;
    return report;
}

static Environment oriented(EnvMap map, SourceReport report, const SourceOptions& options) {
    if (options.flip == "x") map = mirrorEnvX(map);
    if (options.flip == "y") map = mirrorEnvY(map);
    return {rotateEnv(map, options.yaw, options.threads), std::move(report)};
}

static void requireKnown(const SourceOptions& options) {
    require(options.flip == "none" || options.flip == "x" || options.flip == "y",
            fmt::format("unknown flip '{}'; known: none, x, y", options.flip));
    require(std::isfinite(options.yaw), "readEnvironment: yaw must be finite");
}

Environment environmentFromImage(const ImageFile& file, const std::string& name, const SourceOptions& options) {
    requireKnown(options);
    if (options.layout == SourceLayout::CubeFaces)
        throw Error(fmt::format("{}: expected a folder, or a name with %s, for cube_faces, found one picture", name));
    SourceReport report = reportOf(file, name, options);
    report.layout = layoutOf(file, name, options.layout);
    EnvMap map = mapOf(file, options, report);
    return oriented(std::move(map), std::move(report), options);
}

/// The file of one face in a folder, whatever its ending.
static std::optional<fs::path> faceInFolder(const fs::path& folder, const std::string& stem) {
    std::optional<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().stem() != stem || !entry.is_regular_file()) continue;
        if (found)
            throw Error(fmt::format("{}: expected one file for face {}, found {} and {}", folder.string(), stem,
                                    found->filename().string(), entry.path().filename().string()));
        found = entry.path();
    }
    return found;
}

/// The six files +X −X +Y −Y +Z −Z. \throws nacre::Error naming the faces that are missing
static std::array<fs::path, 6> facePaths(const std::string& source) {
    const std::size_t place = source.find("%s");
    std::string best;
    std::size_t bestCount = 0;
    for (const auto& names : kFaceNames) {
        std::array<fs::path, 6> paths;
        std::string missing;
        std::size_t count = 0;
        for (std::size_t face = 0; face < 6; ++face) {
            std::optional<fs::path> path;
            if (place == std::string::npos)
                path = faceInFolder(source, names[face]);
            else if (fs::path candidate = source.substr(0, place) + names[face] + source.substr(place + 2);
                     fs::exists(candidate))
                path = candidate;
            count += path.has_value();
            if (path)
                paths[face] = *path;
            else
                missing += (missing.empty() ? "" : ", ") + std::string(names[face]);
        }
        if (count == 6) return paths;
        if (best.empty() || count > bestCount) best = missing, bestCount = count;
    }
    throw Error(
        fmt::format("{}: expected six faces px nx py ny pz nz (or posx negx …), found none for {}", source, best));
}

static Environment readFaces(const std::string& source, const SourceOptions& options) {
    requireKnown(options);
    if (options.layout != SourceLayout::Auto && options.layout != SourceLayout::CubeFaces)
        throw Error(fmt::format("{}: expected one picture for {}, found a folder or a name of six", source,
                                toString(options.layout)));
    ImageFile whole;
    std::string hashes;
    int size = 0;
    const std::array<fs::path, 6> paths = facePaths(source);
    for (int face = 0; face < 6; ++face) {
        const ImageFile file = readImageFile(paths[static_cast<std::size_t>(face)]);
        const std::string name = paths[static_cast<std::size_t>(face)].string();
        if (face == 0) {
            size = file.image.width();
            whole = file;
            whole.envmap.reset();
            whole.image = Image(size, 6 * size, 3);
        }
        if (file.image.width() != size || file.image.height() != size)
            throw Error(fmt::format("{}: expected a square face of {} x {} texels, found {} x {}", name, size, size,
                                    file.image.width(), file.image.height()));
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) whole.image.setRgb(x, face * size + y, file.image.rgb(x, y));
        hashes += file.hash;
    }
    whole.hash = contentHash(hashes);
    SourceReport report = reportOf(whole, source, options);
    report.layout = SourceLayout::CubeFaces;
    EnvMap map = mapOf(whole, options, report);
    return oriented(std::move(map), std::move(report), options);
}

/// A map that was written by toAsset: layout and orientation are known.
static Environment readOwn(const std::string& source, const ImageFile& file, const SourceOptions& options) {
    requireKnown(options);
    EnvChain chain = envFromAsset(readAsset(source), source);
    SourceReport report = reportOf(file, source, options);
    EnvMap map = std::move(chain.levels.front());
    report.layout = map.layout == EnvLayout::LatLong          ? SourceLayout::LatLong
                    : map.layout == EnvLayout::Cube           ? SourceLayout::CubeStrip
                    : map.layout == EnvLayout::DualParaboloid ? SourceLayout::DualParaboloid
                                                              : SourceLayout::Octahedral;
    if (map.layout == EnvLayout::Cube) report.faces = "openexr";
    check(map, options, report);
    return oriented(std::move(map), std::move(report), options);
}

Environment readEnvironment(const std::string& source, const SourceOptions& options) {
    std::error_code failure;
    if (source.find("%s") != std::string::npos || fs::is_directory(source, failure)) return readFaces(source, options);
    const ImageFile file = readImageFile(source);
    if (file.asset) return readOwn(source, file, options);
    return environmentFromImage(file, source, options);
}

nlohmann::json toJson(const SourceReport& r) {
    nlohmann::json out = {{"path", r.path},
                          {"hash", r.hash},
                          {"format", r.format},
                          {"sample_type", r.sampleType},
                          {"layout", toString(r.layout)},
                          {"width", r.width},
                          {"height", r.height},
                          {"srgb_decoded", r.srgbDecoded},
                          {"flip", r.flip},
                          {"yaw_deg", r.yaw * 180 / kPi},
                          {"texels", r.texels.texels},
                          {"negative", r.texels.negative},
                          {"negative_rule", toString(r.negative)},
                          {"non_finite", r.texels.nonFinite},
                          {"half_overflowed", r.texels.overflowed},
                          {"energy_removed_percent", r.texels.energyRemovedPercent}};
    if (r.exposure != 1) out["exposure"] = r.exposure;
    if (!r.faces.empty()) out["faces"] = r.faces;
    if (r.seamsGl >= 0) out["seam_mismatch"] = {{"openexr", r.seamsOpenExr}, {"gl", r.seamsGl}};
    return out;
}

SourceOptions sourceOptionsFrom(const nlohmann::json& report) {
    SourceOptions options;
    options.layout = sourceLayoutFromString(report.at("layout").get<std::string>());
    options.faces = report.value("faces", options.faces);
    options.negative = negativePolicyFromString(report.at("negative_rule").get<std::string>());
    options.flip = report.at("flip").get<std::string>();
    options.yaw = report.at("yaw_deg").get<double>() * kPi / 180;
    return options;
}

}  // namespace nacre
