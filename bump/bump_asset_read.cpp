#include <fmt/format.h>

#include <limits>

#include "bump/bump_asset.hpp"
#include "core/error.hpp"

namespace nacre {

using nlohmann::json;

namespace {

/// Reads the parts of one asset; every message names the file.
class Reader {
public:
    Reader(const Asset& asset, const std::string& name) : asset_(asset), name_(name) {}

    [[noreturn]] void fail(const std::string& part, const std::string& expected, const std::string& found) const {
        throw Error(fmt::format("{}: {}expected {}, found {}", name_, part.empty() ? "" : "part " + part + ": ",
                                expected, found.size() > 80 ? found.substr(0, 80) : found));
    }

    /// meta[key] as a T. `what` names the type.
    template <typename T>
    T member(const char* key, const char* what) const {
        const auto found = asset_.meta.find(key);
        if (found == asset_.meta.end()) fail("", fmt::format("{} '{}' in attribute 'nacre'", what, key), "none");
        try {
            return found->get<T>();
        } catch (const json::exception&) {
            fail("", fmt::format("{} '{}' in attribute 'nacre'", what, key), found->dump());
        }
    }

    int count(const char* key) const {
        static constexpr int kMost = 256;  // four a texture, at most 64 textures
        const auto value = member<double>(key, "number");
        if (!(value >= 1 && value <= kMost && value == std::floor(value)))
            fail("", fmt::format("'{}' 1 to {}", key, kMost), fmt::format("{}", value));
        return static_cast<int>(value);
    }

    bool has(const std::string& name) const {
        for (const AssetTexture& t : asset_.textures)
            if (t.name == name) return true;
        return false;
    }

    /// The values that lookups mean, bias + scale · sample, of a texture of the given size.
    Image image(const std::string& name, int width, int height, int channels) const {
        if (!has(name)) fail(name, "a texture of that name", "none");
        const AssetTexture& t = asset_.texture(name);
        if (t.mapping != "uv") fail(name, "mapping uv", t.mapping);
        if (t.image.width() != width || t.image.height() != height || t.image.channels() != channels)
            fail(name, fmt::format("{} x {} texels of {} channels", width, height, channels),
                 fmt::format("{} x {} of {}", t.image.width(), t.image.height(), t.image.channels()));
        Image out = t.image;
        for (std::size_t i = 0; i < out.data().size(); ++i) {
            const int c = static_cast<int>(i % static_cast<std::size_t>(channels));
            out.data()[i] = t.bias[c] + t.scale[c] * out.data()[i];
            if (!std::isfinite(out.data()[i])) fail(name, "finite values", fmt::format("{}", out.data()[i]));
        }
        return out;
    }

    /// Layers of one channel out of textures of four.
    std::vector<Image> unpacked(const std::string& name, int layers, int width, int height) const {
        std::vector<Image> out;
        for (int first = 0; first < layers; first += 4) {
            const int channels = std::min(4, layers - first);
            const Image packed = image(fmt::format("{}{}", name, first / 4), width, height, channels);
            for (int c = 0; c < channels; ++c) {
                Image layer(width, height, 1);
                for (std::size_t i = 0; i < layer.texelCount(); ++i)
                    layer.data()[i] =
                        packed.data()[i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)];
                out.push_back(std::move(layer));
            }
        }
        return out;
    }

    std::pair<int, int> size() const {
        const auto size = member<std::vector<int>>("size", "two integers");
        if (size.size() != 2 || size[0] < 1 || size[1] < 1) fail("", "two sizes >= 1 in 'size'", json(size).dump());
        return {size[0], size[1]};
    }

private:
    const Asset& asset_;
    const std::string& name_;
};

NormalMap readNormals(const Reader& reader, const Asset& asset, int width, int height) {
    static constexpr float kUnit = 0.02f;  // unorm8 is off by 2/255 a channel at most
    NormalMap out;
    const int channels = asset.texture("normal0").image.channels() == 4 ? 4 : 3;
    for (int level = 0, levels = reader.count("normal_levels"); level < levels; ++level) {
        const std::string part = fmt::format("normal{}", level);
        out.levels.push_back(reader.image(part, std::max(1, width >> std::min(level, 30)),
                                          std::max(1, height >> std::min(level, 30)), channels));
        const Image& image = out.levels.back();
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                if (const double length = glm::length(image.rgb(x, y)); !(std::abs(length - 1) <= kUnit))
                    reader.fail(part, "normals of length 1", fmt::format("{} at texel ({}, {})", length, x, y));
    }
    return out;
}

ScatterMap readScatter(const Reader& reader, int width, int height) {
    static constexpr double kUnit = 1e-3;
    ScatterMap out;
    const auto directions = reader.member<std::vector<std::vector<double>>>("directions", "list of directions");
    out.weights = reader.member<std::vector<double>>("weights", "list of numbers");
    if (directions.empty() || directions.size() > 256 || out.weights.size() != directions.size())
        reader.fail("", "1 to 256 directions and as many weights",
                    fmt::format("{} and {}", directions.size(), out.weights.size()));
    for (const std::vector<double>& d : directions) {
        if (d.size() != 3 || !(std::abs(glm::length(Vec3(d[0], d[1], d[2])) - 1) <= kUnit))
            reader.fail("", "directions of length 1", json(d).dump());
        out.directions.emplace_back(d[0], d[1], d[2]);
    }
    out.distance = reader.unpacked("scatter", static_cast<int>(directions.size()), width, height);
    for (const Image& image : out.distance)
        for (const float v : image.data())
            if (v < 0 && v != -1) reader.fail("scatter", "distances >= 0 or -1", fmt::format("{}", v));
    return out;
}

Image readHeights(const Reader& reader, const Asset& asset, int width, int height) {
    Image out = reader.image("height0", width, height, 1);
    if (!asset.meta.contains("hole")) return out;
    const auto hole = static_cast<float>(reader.member<double>("hole", "number"));
    for (float& z : out.data())
        if (z == hole) z = std::numeric_limits<float>::quiet_NaN();
    return out;
}

}  // namespace

BumpMaps bumpFromAsset(const Asset& asset, const std::string& name) {
    const Reader reader(asset, name);
    if (asset.kind != "bump") reader.fail("", "an asset of kind bump", fmt::format("kind '{}'", asset.kind));
    if (const auto surface = reader.member<std::string>("surface", "string"); surface != "bilinear")
        reader.fail("", "surface bilinear", surface);
    BumpMaps out;
    std::tie(out.width, out.height) = reader.size();
    try {
        out.wrap = wrapFromString(reader.member<std::string>("wrap", "string"));
    } catch (const std::invalid_argument& error) {
        reader.fail("", "a wrap", error.what());
    }
    if (reader.has("normal0")) out.normals = readNormals(reader, asset, out.width, out.height);
    if (reader.has("horizon0"))
        out.horizons = HorizonMap{reader.unpacked("horizon", reader.count("azimuths"), out.width, out.height)};
    if (reader.has("ellipse0"))
        out.ellipses = EllipseMap{reader.image("ellipse0", out.width, out.height, 3),
                                  reader.image("ellipse1", out.width, out.height, 3)};
    if (reader.has("scatter0")) out.scatter = readScatter(reader, out.width, out.height);
    if (reader.has("indirect0")) out.indirect = reader.image("indirect0", out.width, out.height, 3);
    if (reader.has("height0")) out.heights = readHeights(reader, asset, out.width, out.height);
    if (!out.normals && !out.horizons && !out.ellipses && !out.scatter && !out.indirect && !out.heights)
        reader.fail("", "a texture normal0, horizon0, ellipse0, scatter0, indirect0 or height0", "none");
    return out;
}

}  // namespace nacre
