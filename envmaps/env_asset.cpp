#include "envmaps/env_asset.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace nacre {

using nlohmann::json;

static constexpr const char* kKind = "environment";

Rgb sampleChain(const EnvChain& chain, const Vec3& direction, double lod) {
    require(!chain.levels.empty(), "sampleChain: no levels");
    const double last = static_cast<double>(chain.levels.size() - 1), inside = std::clamp(lod, 0.0, last);
    const auto level = static_cast<std::size_t>(inside);
    const double fraction = inside - static_cast<double>(level);
    const Rgb fine = sampleEnv(chain.levels[level], direction);
    if (fraction == 0) return fine;
    return (1 - fraction) * fine + fraction * sampleEnv(chain.levels[level + 1], direction);
}

double scaleForHalf(const EnvChain& chain) {
    float brightest = 0;
    for (const EnvMap& level : chain.levels)
        for (const float v : level.image.data()) brightest = std::max(brightest, std::abs(v));
    double scale = 1;
    while (brightest / scale > 65504 && std::isfinite(brightest)) scale *= 2;
    return scale;
}

static Image scaled(const Image& image, double factor) {
    if (factor == 1) return image;
    Image out = image;
    for (float& v : out.data()) v = static_cast<float>(v * factor);
    return out;
}

Asset toAsset(const EnvChain& chain, const EnvStorage& storage) {
    require(!chain.levels.empty(), "toAsset: no levels");
    require(storage.format != TexelFormat::Unorm8, "toAsset: radiance is stored as half or float");
    require(std::isfinite(storage.scale) && storage.scale > 0, "toAsset: scale must be finite, > 0");
    require(!chain.mapping || chain.mapping->values.size() == chain.levels.size(),
            "toAsset: expected a mapping value for each level");
    if (chain.mapping) requireValid(*chain.mapping);
    Asset asset;
    asset.kind = kKind;
    const EnvLayout layout = chain.levels.front().layout;
    for (std::size_t i = 0; i < chain.levels.size(); ++i) {
        require(chain.levels[i].layout == layout, "toAsset: levels of different layouts");
        AssetTexture texture;
        try {
            texture = makeTexture(fmt::format("level{}", i), toString(layout),
                                  scaled(chain.levels[i].image, 1 / storage.scale), storage.format);
        } catch (const StorageError& error) {
            throw StorageError(
                fmt::format("{} (a scale of {:g} would fit, or format float)", error.what(), scaleForHalf(chain)));
        }
        texture.scale = glm::vec4(static_cast<float>(storage.scale));
        asset.textures.push_back(std::move(texture));
    }
    asset.meta["layout"] = toString(layout);
    asset.meta["size"] = chain.levels.front().size();
    asset.meta["levels"] = chain.levels.size();
    asset.meta["orientation"] = "openexr, y up";
    if (chain.mapping)
        asset.meta["level_mapping"] = {
            {"name", chain.mapping->name}, {"parameter", chain.mapping->parameter}, {"values", chain.mapping->values}};
    return asset;
}

static LevelMapping mappingFrom(const json& meta, const std::string& name, std::size_t levels) {
    try {
        LevelMapping mapping{meta.at("name").get<std::string>(), meta.at("parameter").get<std::string>(),
                             meta.at("values").get<std::vector<double>>()};
        requireValid(mapping);
        require(mapping.values.size() == levels, fmt::format("{} values for {} levels", mapping.values.size(), levels));
        return mapping;
    } catch (const std::exception& error) {
        throw Error(
            fmt::format("{}: expected a level_mapping with name, parameter and values, found {}", name, error.what()));
    }
}

EnvChain envFromAsset(const Asset& asset, const std::string& name) {
    if (asset.kind != kKind)
        throw Error(fmt::format("{}: expected an asset of kind environment, found kind '{}'", name, asset.kind));
    EnvChain chain;
    for (std::size_t i = 0; i < asset.textures.size(); ++i) {
        const AssetTexture& texture = asset.texture(fmt::format("level{}", i));
        try {
            const EnvLayout layout = envLayoutFromString(texture.mapping);
            require(i == 0 || layout == chain.levels.front().layout, "levels of different layouts");
            chain.levels.emplace_back(layout, texture.image);
        } catch (const std::invalid_argument& error) {
            throw Error(fmt::format("{}: part {}: expected a map of three channels, found {}", name, texture.name,
                                    error.what()));
        }
        std::vector<float>& data = chain.levels.back().image.data();
        for (std::size_t k = 0; k < data.size(); ++k) {
            const int channel = static_cast<int>(k % 3);
            data[k] = texture.bias[channel] + texture.scale[channel] * data[k];
            if (!std::isfinite(data[k]))
                throw Error(fmt::format("{}: part {}: expected values that times scale are finite, found {}", name,
                                        texture.name, data[k]));
        }
    }
    if (const auto mapping = asset.meta.find("level_mapping"); mapping != asset.meta.end())
        chain.mapping = mappingFrom(*mapping, name, chain.levels.size());
    return chain;
}

}  // namespace nacre
