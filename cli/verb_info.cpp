// nacre info: what an asset says of itself, and what is in a scene.
#include <fmt/format.h>

#include <memory>
#include <set>

#include "bump/bump_asset.hpp"
#include "cli/eval_table.hpp"
#include "cli/scene_report.hpp"
#include "cli/terminal.hpp"
#include "cli/verb.hpp"
#include "core/asset.hpp"
#include "core/error.hpp"
#include "envmaps/env_asset.hpp"
#include "factorize/factored_brdf.hpp"
#include "shading/scene_file.hpp"
#include "transfer/transfer_file.hpp"

namespace nacre::cli {

using nlohmann::json;

static std::string valueText(const json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

static std::string textureText(const AssetTexture& t) {
    std::string out =
        fmt::format("  {:<10} {:<22} {:>4} x {:<4} {} channels  {:<6} {:>10}", t.name, t.mapping, t.image.width(),
                    t.image.height(), t.image.channels(), toString(t.format), humanBytes(t.bytes()));
    if (t.format != TexelFormat::Unorm8) return out + "\n";
    for (int c = 0; c < t.image.channels(); ++c)
        out += fmt::format("  [{:.4g}, {:.4g}]", t.bias[c], t.bias[c] + t.scale[c]);
    return out + "\n";
}

/// All but what the line above it has said.
static std::string metaText(const json& meta, const std::set<std::string>& said) {
    std::string out;
    for (const auto& [key, value] : meta.items()) {
        if (said.count(key)) continue;
        if (value.is_array() && !value.empty() && value.front().is_object()) {  // one line an entry
            out += key + "\n";
            for (const json& entry : value) out += "  " + entry.dump() + "\n";
            continue;
        }
        if (!value.is_object()) {
            out += fmt::format("{:<22} {}\n", key, valueText(value));
            continue;
        }
        out += key + "\n";
        for (const auto& [name, inner] : value.items()) out += fmt::format("  {:<20} {}\n", name, valueText(inner));
    }
    return out;
}

static std::string infoText(const std::string& path, const Asset& asset) {
    std::string out =
        fmt::format("{}: {}, {} in {} textures\n", path, asset.kind, humanBytes(asset.bytes()), asset.textures.size());
    for (const AssetTexture& texture : asset.textures) out += textureText(texture);
    return out + metaText(asset.meta, {"textures", "kind", "bytes", "params"});
}

/// Says when this version can show the file but not use it: a later version's kind or form, or a damaged description.
static void tellUnusable(const std::string& path, const Asset& asset) {
    if (isTable(asset)) return;
    if (asset.kind != "brdf" && asset.kind != "environment" && asset.kind != "bump")
        return tell(
            fmt::format("{}: this version does not know the kind '{}' (it knows brdf, bump, environment, fresnel and "
                        "scale_bias) and can't use the file",
                        path, asset.kind));
    try {
        if (asset.kind == "brdf")
            factoredFromAsset(asset, path);
        else if (asset.kind == "bump")
            bumpFromAsset(asset, path);
        else
            envFromAsset(asset, path);
    } catch (const Error& error) {
        tell(fmt::format("{}; this version can't use the file", error.what()));
    }
}

static void showAsset(const std::string& file, bool asJson) {
    const Asset asset = readAsset(file);
    putData(asJson ? asset.meta.dump(2) + "\n" : infoText(file, asset));
    tellUnusable(file, asset);
}

static void showTransfer(const std::string& file, bool asJson) {
    const TransferRecording r = readTransfer(file);
    if (asJson) return putData(r.meta.dump(2) + "\n");
    const std::string text =
        fmt::format("{}: transfer, {} coefficients for {} vertices, {} triangles, in {} frames ({} to {})\n", file,
                    r.coefficientCount(), r.vertexCount(), r.triangles.size(), r.frames.size(), r.frames.front().number,
                    r.frames.back().number);
    putData(text + metaText(r.meta, {"kind", "vertices", "triangles", "frames", "block_of_frame"}));
}

static void showScene(const std::string& file, bool asJson) {
    std::vector<std::string> notes;
    SceneOptions options;
    options.needAssets = false;
    options.note = [&](const std::string& note) { notes.push_back(note); };
    const json report = sceneReport(readScene(file, options), notes);
    putData(asJson ? report.dump(2) + "\n" : sceneText(report));
}

Verb infoVerb(Context&) {
    struct Settings {
        std::string file;
        bool asJson = false;
    };
    const auto s = std::make_shared<Settings>();
    Verb verb{"info", "Show what an asset or a transfer file says of itself, or what is in a scene", {}, {}, {}};
    verb.details =
        "Of an asset: textures, source, measured error. Of a scene file, glTF or mesh: triangles, materials with what "
        "they\n"
        "use, lights, and assets: baked (up to date), stale, missing, or given (there, with no recipe to check it by).";
    verb.options = {{"file", "FILE", "A baked asset, a transfer file, a scene or a mesh", into(s->file), true},
                    {"--json", "", "One JSON object on standard output", into(s->asJson)}};
    verb.run = [s] {
        const auto show = isSceneName(s->file) ? showScene : isTransferFile(s->file) ? showTransfer : showAsset;
        show(s->file, s->asJson);
    };
    return verb;
}

}  // namespace nacre::cli
