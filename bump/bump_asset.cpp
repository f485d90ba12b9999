#include "bump/bump_asset.hpp"

#include <fmt/format.h>

#include <limits>

#include "core/asset_exr.hpp"
#include "core/error.hpp"

namespace nacre {

using nlohmann::json;

static constexpr const char *kKind = "bump", *kMapping = "uv", *kSurface = "bilinear";
static constexpr float kHole = std::numeric_limits<float>::lowest();  ///< an asset's values are finite

namespace {

/// Images of one channel, four a texture.
void addPacked(Asset& asset, const std::string& name, const std::vector<Image>& layers, TexelFormat format) {
    for (std::size_t first = 0; first < layers.size(); first += 4) {
        const std::size_t count = std::min<std::size_t>(4, layers.size() - first);
        Image packed(layers[0].width(), layers[0].height(), static_cast<int>(count));
        for (std::size_t c = 0; c < count; ++c)
            for (std::size_t i = 0; i < packed.texelCount(); ++i)
                packed.data()[i * count + c] = layers[first + c].data()[i];
        asset.textures.push_back(makeTexture(fmt::format("{}{}", name, first / 4), kMapping, packed, format));
    }
}

void requireSize(const BumpMaps& maps, const Image& image, int channels, const char* what) {
    require(image.width() == maps.width && image.height() == maps.height && image.channels() == channels,
            fmt::format("bump asset: {}: expected {} x {} texels of {} channels, found {} x {} of {}", what, maps.width,
                        maps.height, channels, image.width(), image.height(), image.channels()));
}

void requireSizes(const BumpMaps& maps) {
    if (maps.normals) {
        require(!maps.normals->levels.empty(), "bump asset: normals without a level");
        requireSize(maps, maps.normals->levels[0], maps.normals->levels[0].channels() == 4 ? 4 : 3, "normals");
    }
    if (maps.horizons)
        for (const Image& image : maps.horizons->elevation) requireSize(maps, image, 1, "horizons");
    if (maps.ellipses) {
        requireSize(maps, maps.ellipses->shape, 3, "ellipses");
        requireSize(maps, maps.ellipses->offset, 3, "ellipses");
    }
    if (maps.scatter) {
        const ScatterMap& s = *maps.scatter;
        require(s.distance.size() == s.directions.size() && s.weights.size() == s.directions.size(),
                "bump asset: scatter map: expected as many distances and weights as directions");
        for (const Image& image : s.distance) requireSize(maps, image, 1, "scatter map");
    }
    if (maps.indirect) requireSize(maps, *maps.indirect, 3, "indirect light");
    if (maps.heights) requireSize(maps, *maps.heights, 1, "heights");
    require(maps.normals || (maps.horizons && maps.horizons->azimuths() > 0) || maps.ellipses ||
                (maps.scatter && maps.scatter->count() > 0) || maps.indirect || maps.heights,
            "bump asset: expected something to store, found nothing");
}

void addHeights(Asset& asset, Image heights) {
    for (float& z : heights.data()) {
        if (!std::isnan(z)) continue;
        z = kHole;
        asset.meta["hole"] = kHole;
    }
    asset.textures.push_back(makeTexture("height0", kMapping, heights, TexelFormat::Float));
}

void addScatter(Asset& asset, const ScatterMap& scatter, TexelFormat format) {
    addPacked(asset, "scatter", scatter.distance, format);
    json directions = json::array();
    for (const Vec3& d : scatter.directions) directions.push_back({d.x, d.y, d.z});
    asset.meta["directions"] = directions;
    asset.meta["weights"] = scatter.weights;
}

/// readAsset's limits, before a file is written that it would refuse.
void requireReadable(const Asset& asset) {
    std::size_t values = 0;
    for (const AssetTexture& t : asset.textures) values += t.image.data().size();
    if (asset.textures.size() > exr::kMaxParts || values > exr::kMaxValues || asset.bytes() > exr::kMaxFileBytes)
        throw StorageError(fmt::format("bump asset: expected at most {} textures of {} values, found {} of {}",
                                       exr::kMaxParts, exr::kMaxValues, asset.textures.size(), values));
}

}  // namespace

Asset toAsset(const BumpMaps& maps, TexelFormat format) {
    requireSizes(maps);
    require(!maps.scatter || format != TexelFormat::Unorm8, "bump asset: scatter maps are stored as half or float");
    Asset asset;
    asset.kind = kKind;
    asset.meta["size"] = {maps.width, maps.height};
    asset.meta["wrap"] = toString(maps.wrap);
    asset.meta["surface"] = kSurface;
    if (maps.normals) {
        const std::vector<Image>& levels = maps.normals->levels;
        for (std::size_t i = 0; i < levels.size(); ++i)
            asset.textures.push_back(makeTexture(fmt::format("normal{}", i), kMapping, levels[i], format));
        asset.meta["normal_levels"] = levels.size();
        if (levels[0].channels() == 4) asset.meta["roughness"] = "alpha, alpha^2 = 2 variance of slopes";
    }
    if (maps.horizons) {
        addPacked(asset, "horizon", maps.horizons->elevation, format);
        asset.meta["azimuths"] = maps.horizons->azimuths();
    }
    if (maps.ellipses) {
        asset.textures.push_back(makeTexture("ellipse0", kMapping, maps.ellipses->shape, format));
        asset.textures.push_back(makeTexture("ellipse1", kMapping, maps.ellipses->offset, format));
    }
    if (maps.scatter) addScatter(asset, *maps.scatter, format);
    if (maps.indirect) asset.textures.push_back(makeTexture("indirect0", kMapping, *maps.indirect, format));
    if (maps.heights) addHeights(asset, *maps.heights);
    requireReadable(asset);
    return asset;
}

}  // namespace nacre
