// nacre bake: everything that a manifest or scene names.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/bake_schedule.hpp"
#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "cli/verb.hpp"
#include "core/error.hpp"
#include "shading/scene_manifest.hpp"

namespace nacre::cli {

using nlohmann::json;
using Status = BakeResult::Status;

namespace {

struct Settings {
    std::string manifest;
    std::vector<std::string> only;
    BakeOptions options;
    bool asJson = false;
};

const char* word(Status status) {
    switch (status) {
        case Status::Baked:
            return "baked";
        case Status::Skipped:
            return "up_to_date";
        case Status::Failed:
            return "failed";
        case Status::ToBake:
            return "to_bake";
        case Status::Given:
            return "given";
    }
    return "";
}

/// Those of --only and what they are made from; all without it.
std::vector<SceneAsset> chosenOf(const std::vector<SceneAsset>& all, const std::vector<std::string>& only) {
    if (only.empty()) return all;
    std::vector<std::size_t> wanted;
    for (const std::string& name : only) {
        const auto at = std::find_if(all.begin(), all.end(), [&](const SceneAsset& a) { return a.name == name; });
        if (at == all.end()) {
            std::string known;
            for (const SceneAsset& asset : all) known += (known.empty() ? "" : ", ") + asset.name;
            throw UsageError(
                fmt::format("--only: no asset named '{}'; there are {}", name, known.empty() ? "none" : known));
        }
        wanted.push_back(static_cast<std::size_t>(at - all.begin()));
    }
    std::vector<SceneAsset> out;
    for (const std::size_t i : withInputs(all, wanted)) out.push_back(all[i]);
    return out;
}

json reportOf(const Settings& s, const std::vector<SceneAsset>& assets, const std::vector<BakeResult>& results,
              double seconds) {
    json out = {{"manifest", s.manifest}, {"assets", json::object()}, {"seconds", seconds}};
    for (const Status status : {Status::Baked, Status::Skipped, Status::Failed, Status::ToBake, Status::Given})
        out[word(status)] =
            std::count_if(results.begin(), results.end(), [&](const BakeResult& r) { return r.status == status; });
    for (std::size_t i = 0; i < assets.size(); ++i) {
        const BakeResult& r = results[i];
        json& entry = out["assets"][assets[i].name] = {
            {"status", word(r.status)}, {"file", assets[i].file.string()}, {"bytes", r.bytes}};
        if (r.status == Status::Baked || r.status == Status::Failed) entry["seconds"] = r.seconds;
        if (!r.why.empty()) entry[r.status == Status::Failed ? "message" : "why"] = r.why;
        if (!r.messages.empty()) entry["messages"] = r.messages;
    }
    return out;
}

std::string textOf(const std::vector<SceneAsset>& assets, const std::vector<BakeResult>& results) {
    std::string out;
    for (std::size_t i = 0; i < assets.size(); ++i) {
        const BakeResult& r = results[i];
        out += fmt::format("{:<16} {:<10} {:>10}", assets[i].name, word(r.status), r.bytes ? humanBytes(r.bytes) : "");
        if (r.status == Status::Baked) out += fmt::format("  {:.2f} s", r.seconds);
        if (!r.why.empty() && r.status != Status::Failed) out += "  " + r.why;
        out += '\n';
    }
    return out;
}

void tellLines(const std::string& name, const std::string& lines) {
    for (std::size_t begin = 0; begin < lines.size();) {
        const std::size_t end = std::min(lines.find('\n', begin), lines.size());
        tell(name + ": " + lines.substr(begin, end - begin));
        begin = end + 1;
    }
}

void runBake(const Context& context, const Settings& s) {
    const Stopwatch watch;
    const std::vector<SceneAsset> assets = chosenOf(readManifest(s.manifest), s.only);
    const std::vector<BakeResult> results = bakeAll(assets, s.options, terminalProgress(context.quiet));
    endProgress();
    putData(s.asJson ? reportOf(s, assets, results, watch.seconds()).dump(2) + "\n" : textOf(assets, results));
    flushData();
    std::size_t failed = 0;
    for (std::size_t i = 0; i < assets.size(); ++i) {
        tellLines(assets[i].name, results[i].status == Status::Failed ? results[i].why : results[i].messages);
        failed += results[i].status == Status::Failed;
    }
    if (failed > 0) throw Error(fmt::format("{}: {} of {} assets failed", s.manifest, failed, assets.size()));
}

constexpr const char* kDetails =
    "MANIFEST is a scene file, or any JSON file with a section \"assets\":\n"
    "  {\"assets\": {\"gold\": {\"file\": \"baked/gold.exr\", \"bake\": {\"verb\": \"factorize\",\n"
    "    \"source\": \"sgd:gold-paint\", \"options\": {\"--max-error\": 0.02}}}}}\n"
    "Paths count from its folder; the scenes that a scene imports belong to it. An asset is up to date when the hash "
    "of\n"
    "its recipe, of its sources' contents and of this version is the one in FILE.exr.bake.json, and the file the one\n"
    "that was written then. Files appear whole or not at all: after a kill, the same call goes on with what is left. "
    "An\n"
    "asset made from another's file waits for it. One that fails leaves the others alone; the exit code is 1 then.";

}  // namespace

Verb bakeVerb(Context& context) {
    const auto s = std::make_shared<Settings>();
    Verb verb{"bake", "Bake every asset that a scene or manifest names", kDetails, {}, {}};
    verb.options = {{"manifest", "MANIFEST", "Scene file, or JSON with \"assets\"", into(s->manifest), true},
                    {"--jobs", "N", "Bakes at a time (default: one a core); they share the cores",
                     integerInto([s](long long v) { s->options.jobs = static_cast<unsigned>(v); }, 1, 1024)},
                    {"--only", "NAMES", "These assets, separated by commas, and what they are made from",
                     [s](const std::string& text) {
                         std::size_t begin = 0;
                         while (begin <= text.size()) {
                             const std::size_t end = std::min(text.find(',', begin), text.size());
                             s->only.push_back(text.substr(begin, end - begin));
                             begin = end + 1;
                         }
                     }},
                    {"--force", "", "Also what is up to date", into(s->options.force)},
                    {"--dry-run", "", "Say what would be baked, and why", into(s->options.dryRun)},
                    {"--json", "", "One JSON object on standard output", into(s->asJson)}};
    verb.run = [s, &context] { runBake(context, *s); };
    return verb;
}

}  // namespace nacre::cli
