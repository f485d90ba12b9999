#include "cli/bake_record.hpp"

#include <cerrno>
#include <charconv>
#include <csignal>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/version.hpp"

namespace nacre::cli {

namespace fs = std::filesystem;
using nlohmann::json;

std::string recipeHash(const BakeRecipe& recipe) {
    json text = {nacreVersion(), recipe.verb, recipe.options};
    if (recipe.inputs.empty()) text.push_back(recipe.source);
    for (const std::string& input : recipe.inputs)
        text.push_back({fs::path(input).filename().string(), fileHash(input)});
    return contentHash(text.dump());
}

const char* toString(AssetState::Kind kind) {
    switch (kind) {
        case AssetState::Kind::Baked:
            return "baked";
        case AssetState::Kind::Stale:
            return "stale";
        case AssetState::Kind::Missing:
            return "missing";
        case AssetState::Kind::Given:
            return "given";
    }
    return "";
}

fs::path recordPath(const SceneAsset& asset) { return asset.file.string() + ".bake.json"; }

AssetState stateOf(const SceneAsset& asset, const std::string& hash) {
    using Kind = AssetState::Kind;
    std::error_code ignored;
    if (!fs::is_regular_file(asset.file, ignored)) return {Kind::Missing, {}};
    if (!asset.bake) return {Kind::Given, {}};
    if (!fs::is_regular_file(recordPath(asset), ignored)) return {Kind::Stale, "no record of how it was baked"};
    constexpr std::uint64_t kMaxRecord = 1 << 16;
    const std::vector<std::uint8_t> bytes = readFile(recordPath(asset), kMaxRecord);
    const json record = json::parse(bytes.begin(), bytes.end(), nullptr, false);
    if (!record.is_object() || record.value("nacre_bake", json()) != 1) return {Kind::Stale, "its record is damaged"};
    if (record.value("recipe", json()) != hash) return {Kind::Stale, "its recipe, a source or this version changed"};
    if (record.value("asset", json()) != fileHash(asset.file)) return {Kind::Stale, "it changed after it was baked"};
    return {Kind::Baked, {}};
}

AssetState stateOf(const SceneAsset& asset) {
    try {
        return stateOf(asset, asset.bake ? recipeHash(*asset.bake) : std::string());
    } catch (const Error& error) {
        std::error_code ignored;
        const bool there = fs::is_regular_file(asset.file, ignored);
        return {there ? AssetState::Kind::Stale : AssetState::Kind::Missing, error.what()};
    }
}

void writeRecord(const SceneAsset& asset, const std::string& hash, double seconds) {
    writeFile(recordPath(asset), json{{"nacre_bake", 1},
                                      {"recipe", hash},
                                      {"asset", fileHash(asset.file)},
                                      {"version", nacreVersion()},
                                      {"seconds", seconds}}
                                         .dump(2) +
                                     "\n");
}

void removeLeftovers(const SceneAsset& asset) {
    const std::string start = asset.file.filename().string() + ".";
    const fs::path folder = asset.file.has_parent_path() ? asset.file.parent_path() : fs::path(".");
    std::error_code ignored;
    std::vector<fs::path> left;
    for (fs::directory_iterator it(folder, ignored), end; !ignored && it != end; it.increment(ignored)) {
        const std::string name = it->path().filename().string(), ending = it->path().extension().string();
        if (!name.starts_with(start) || (ending != ".tmp" && ending != ".provisional")) continue;
        const std::string digits = it->path().stem().extension().string();  // ".1234" of NAME.1234.tmp
        pid_t process = 0;
        const auto [last, failed] = std::from_chars(digits.data() + 1, digits.data() + digits.size(), process);
        if (digits.size() < 2 || failed != std::errc{} || last != digits.data() + digits.size()) continue;
        if (process > 0 && ::kill(process, 0) != 0 && errno == ESRCH) left.push_back(it->path());
    }
    for (const fs::path& path : left) fs::remove(path, ignored);
}

}  // namespace nacre::cli
