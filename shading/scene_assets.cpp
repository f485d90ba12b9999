#include "shading/scene_assets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/error.hpp"
#include "envmaps/env_asset.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

/// Time and size of a file; empty when there is none.
std::string stampOf(const fs::path& file) {
    std::error_code failure;
    const auto time = fs::last_write_time(file, failure);
    if (failure) return {};
    const auto size = fs::file_size(file, failure);
    if (failure) return {};
    return fmt::format("{} {}", time.time_since_epoch().count(), size);
}

std::unique_ptr<GpuAsset> load(const fs::path& file) {
    const Asset asset = readAsset(file);
    const std::string name = file.string();
    auto out = std::make_unique<GpuAsset>();
    out->traits = traitsOf(asset, name);
    out->meta = asset.meta;
    out->meta.erase("textures");
    if (asset.kind == "brdf") out->brdf.emplace(factoredFromAsset(asset, name));
    if (asset.kind == "environment") {
        const EnvChain chain = envFromAsset(asset, name);
        out->environment.emplace(chain.levels, GpuEnvironmentOptions{TexelFormat::Half, scaleForHalf(chain)});
    }
    if (asset.kind == "fresnel" || asset.kind == "scale_bias") out->table.emplace(asset.texture(asset.kind));
    if (asset.kind == "bump") out->bump.emplace(bumpFromAsset(asset, name));
    return out;
}

/// What is wrong with a file is an Error, whatever finds it.
std::unique_ptr<GpuAsset> loadNamed(const fs::path& file, const std::string& name) {
    try {
        return load(file);
    } catch (const Error& error) {
        throw Error(fmt::format("asset '{}': {}", name, error.what()));
    } catch (const std::invalid_argument& error) {
        throw Error(fmt::format("asset '{}': {}: {}", name, file.string(), error.what()));
    }
}

}  // namespace

void SceneAssets::open(const std::vector<SceneAsset>& assets) {
    std::map<fs::path, std::shared_ptr<Entry>> files;
    std::vector<std::shared_ptr<Entry>> entries;
    for (const SceneAsset& asset : assets) {
        const fs::path key = fs::absolute(asset.file).lexically_normal();
        std::shared_ptr<Entry>& entry = files[key];
        if (!entry) {
            const auto known = files_.find(key);
            if (known != files_.end()) {
                entry = known->second;
            } else {
                const std::string stamp = stampOf(key);
                entry = std::make_shared<Entry>(Entry{key, asset.name, stamp, 0, loadNamed(asset.file, asset.name)});
            }
        }
        entries.push_back(entry);
    }
    files_ = std::move(files);
    entries_ = std::move(entries);
}

std::vector<AssetTraits> SceneAssets::traits() const {
    std::vector<AssetTraits> out;
    for (const auto& entry : entries_) out.push_back(entry->gpu->traits);
    return out;
}

BumpMaps SceneAssets::readBump(std::size_t asset) const {
    const Entry& entry = *entries_.at(asset);
    return bumpFromAsset(readAsset(entry.file), entry.file.string());
}

std::vector<AssetChange> SceneAssets::reload(const std::function<void(const std::vector<AssetTraits>&)>& accept) {
    std::vector<AssetChange> out;
    for (const auto& [key, entry] : files_) {
        std::string stamp = stampOf(key);
        if (stamp == entry->stamp) continue;
        entry->stamp = std::move(stamp);
        std::string problem;
        std::unique_ptr<GpuAsset> other;
        try {
            other = loadNamed(entry->file, entry->name);
            std::swap(entry->gpu, other);
            if (accept) accept(traits());
            ++entry->version;
        } catch (const std::exception& error) {
            if (other) std::swap(entry->gpu, other);
            problem = error.what();
        }
        out.push_back({entry->file, entry->name, problem});
    }
    return out;
}

}  // namespace nacre
