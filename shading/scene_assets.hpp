// A scene's baked assets on the GPU: each file once, and again when it changes.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bump/bump_asset.hpp"
#include "core/scene_description.hpp"
#include "shading/gpu_bump.hpp"
#include "shading/gpu_environment.hpp"
#include "shading/gpu_factored_brdf.hpp"
#include "shading/scene_programs.hpp"

namespace nacre {

/// One file's textures: the member that traits.kind says is there.
struct GpuAsset {
    AssetTraits traits;
    nlohmann::json meta;  ///< what the file says of itself, its measured error too; textures' tables left out
    std::optional<GpuFactoredBrdf> brdf;
    std::optional<GpuEnvironment> environment;
    std::optional<GpuEnvironmentTable> table;
    std::optional<GpuBump> bump;
};

/// What became of a file that changed.
struct AssetChange {
    std::filesystem::path file;
    std::string name;     ///< of the first asset that has it
    std::string problem;  ///< empty: loaded. Else why not: the last good one stays in use
};

class SceneAssets {
public:
    SceneAssets() = default;
    /// open(assets).
    explicit SceneAssets(const std::vector<SceneAsset>& assets) { open(assets); }

    /// Loads the files that aren't loaded, forgets those that no asset names. On failure everything stays as it was.
    /// \throws nacre::Error "asset 'wall': " and the reader's message, which names the file
    void open(const std::vector<SceneAsset>& assets);

    std::size_t size() const { return entries_.size(); }
    const GpuAsset& operator[](std::size_t asset) const { return *entries_.at(asset)->gpu; }
    /// Grows when the file is loaded again: what was made from an asset is then out of date.
    int version(std::size_t asset) const { return entries_.at(asset)->version; }
    std::vector<AssetTraits> traits() const;  ///< one an asset

    /// The relief itself, read from the file once more: its heights and scatter map are of no use between updates.
    /// \throws nacre::Error when the file is gone, or isn't what it was
    BumpMaps readBump(std::size_t asset) const;

    /// Looks at each file's time and size, and loads those that changed. A file that can't be loaded, or with which
    /// `accept` throws, is reported once for each change.
    std::vector<AssetChange> reload(const std::function<void(const std::vector<AssetTraits>&)>& accept = {});

private:
    struct Entry {
        std::filesystem::path file;
        std::string name;
        std::string stamp;  ///< time and size
        int version = 0;
        std::unique_ptr<GpuAsset> gpu;
    };
    std::map<std::filesystem::path, std::shared_ptr<Entry>> files_;
    std::vector<std::shared_ptr<Entry>> entries_;  ///< one an asset
};

}  // namespace nacre
