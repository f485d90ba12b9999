#include "shading/scene_manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/error.hpp"
#include "core/file.hpp"

namespace nacre {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::uint64_t kMaxSceneBytes = 64u << 20;
constexpr std::size_t kMaxImports = 16;  // one within the other

/// What `nacre factorize` takes for a path and not for a model (factorize/reflectance.hpp).
bool namesReflectanceFile(const fs::path& folder, const std::string& source) {
    if (source.rfind("micro:", 0) == 0) return false;
    const std::string suffix = fs::path(source).extension().string();
    std::error_code ignored;
    return suffix == ".binary" || suffix == ".bsdf" || suffix == ".csv" ||
           source.substr(0, source.find(':')).find('/') != std::string::npos ||
           fs::is_regular_file(folder / source, ignored);
}

/// The files of a surrounding: one picture, a folder's, or six by a name with %s (envmaps/source.hpp).
std::vector<std::string> filesOf(const std::string& source) {
    static constexpr std::array kFaces = {"px",   "nx",   "py",   "ny",   "pz",   "nz",
                                          "posx", "negx", "posy", "negy", "posz", "negz"};
    std::error_code ignored;
    std::vector<std::string> out;
    if (const std::size_t at = source.find("%s"); at != std::string::npos) {
        for (const char* face : kFaces) {
            const std::string name = source.substr(0, at) + face + source.substr(at + 2);
            if (fs::is_regular_file(name, ignored)) out.push_back(name);
        }
    } else if (fs::is_directory(source, ignored)) {
        for (const auto& entry : fs::directory_iterator(source, ignored))
            if (entry.is_regular_file(ignored)) out.push_back(entry.path().string());
        std::sort(out.begin(), out.end());
    }
    if (out.empty()) out.push_back(source);
    return out;
}

/// A number or text as it would be typed.
std::string optionWord(const JsonField& field) {
    if (field.value().is_number()) {
        field.number();
        return field.value().is_number_integer() ? field.value().dump()
                                                 : fmt::format("{}", field.value().get<double>());
    }
    if (!field.value().is_string())
        field.fail("expected a text, number, true, false, or an array of texts and numbers");
    return field.text();
}

void appendOption(std::vector<std::string>& out, const std::string& flag, const JsonField& field) {
    if (flag.size() < 3 || flag.rfind("--", 0) != 0) field.fail("expected an option such as \"--size\"");
    for (const char* word : {"--output", "--json", "--quiet", "--help", "--export"})
        if (flag == word) field.fail("expected an option of what is baked; the command sets this one itself");
    if (field.value().is_boolean()) {
        if (field.flag()) out.push_back(flag);
        return;
    }
    std::string value;
    if (field.value().is_array())
        for (const JsonField& item : field.items(1)) value += (value.empty() ? "" : ",") + optionWord(item);
    else
        value = optionWord(field);
    out.push_back(flag);
    out.push_back(value);
}

BakeRecipe recipeOf(const JsonField& field, const fs::path& folder) {
    static constexpr std::array kVerbs = {"factorize", "envmap", "fresnel", "bump"};
    field.requireKeys({"verb", "source", "options"});
    BakeRecipe out;
    out.verb = kVerbs[static_cast<std::size_t>(field.at("verb").choice({kVerbs[0], kVerbs[1], kVerbs[2], kVerbs[3]}))];
    if (out.verb == "fresnel") {
        if (const auto source = field.find("source")) source->fail("expected none: fresnel has options alone");
    } else {
        out.source = field.at("source").text();
        if (out.verb != "factorize" || namesReflectanceFile(folder, out.source)) {
            out.source = scenePath(folder, out.source).string();
            out.inputs = filesOf(out.source);
        }
    }
    if (const auto options = field.find("options"))
        for (const auto& [flag, value] : options->members()) appendOption(out.options, flag, value);
    return out;
}

SceneAsset assetOf(const std::string& name, const JsonField& field, const fs::path& folder) {
    field.requireKeys({"file", "bake", "source"});
    SceneAsset out;
    out.name = name;
    out.file = scenePath(folder, field.at("file").text());
    if (const auto bake = field.find("bake")) {
        if (const auto source = field.find("source")) source->fail("expected none beside \"bake\", which has one");
        out.bake = recipeOf(*bake, folder);
        out.source = out.bake->source;
    } else if (const auto source = field.find("source")) {
        out.source = source->text();
        if (namesReflectanceFile(folder, out.source) || fs::path(out.source).has_extension())
            if (std::error_code ignored; fs::exists(folder / out.source, ignored))
                out.source = scenePath(folder, out.source).string();
    }
    return out;
}

bool bakedAlike(const SceneAsset& a, const SceneAsset& b) {
    if (!a.bake || !b.bake) return !a.bake && !b.bake;
    return a.bake->verb == b.bake->verb && a.bake->source == b.bake->source && a.bake->options == b.bake->options;
}

/// Adds the assets of one file and of those that it imports. \param prefix  of their names: "node/"
void appendManifest(std::vector<SceneAsset>& out, const fs::path& path, SceneStack open, const std::string& prefix) {
    open.push_back(fs::weakly_canonical(path));
    const json document = readSceneJson(path);
    const std::string name = path.string();
    const JsonField root(document, name);
    for (SceneAsset& asset : assetsIn(root, path.parent_path())) {
        const auto same =
            std::find_if(out.begin(), out.end(), [&](const SceneAsset& a) { return a.file == asset.file; });
        if (same == out.end()) {
            asset.name = prefix + asset.name;
            out.push_back(std::move(asset));
        } else if (!bakedAlike(*same, asset)) {
            root.at("assets")
                .at(asset.name)
                .fail(fmt::format("{} is made in another way by \"{}\"", asset.file.string(), same->name));
        }
    }
    const auto nodes = root.find("nodes");
    if (!nodes) return;
    for (const auto& [nodeName, node] : nodes->members()) {
        const auto import = node.find("import");
        if (!import || fs::path(import->text()).extension() != ".json") continue;
        const fs::path file = scenePath(path.parent_path(), import->text());
        requireNoCycle(open, file, *import);
        appendManifest(out, file, open, prefix + nodeName + "/");
    }
}

}  // namespace

std::vector<SceneAsset> assetsIn(const JsonField& root, const fs::path& folder) {
    std::vector<SceneAsset> out;
    const auto section = root.find("assets");
    if (!section) return out;
    for (const auto& [name, field] : section->members()) {
        SceneAsset asset = assetOf(name, field, folder);
        for (const SceneAsset& other : out)
            if (other.file == asset.file && (other.bake || asset.bake))
                field.at("file").fail(fmt::format("expected a file of its own, found that of \"{}\"", other.name));
        out.push_back(std::move(asset));
    }
    return out;
}

std::vector<SceneAsset> readManifest(const fs::path& path) {
    std::vector<SceneAsset> out;
    const json document = readSceneJson(path);
    const std::string name = path.string();
    JsonField(document, name).at("assets");  // a manifest without one is some other file
    appendManifest(out, path, {}, "");
    return out;
}

json readSceneJson(const fs::path& path) {
    const std::vector<std::uint8_t> bytes = readFile(path, kMaxSceneBytes);
    return parseJson({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.string());
}

fs::path scenePath(const fs::path& folder, const std::string& file) { return (folder / file).lexically_normal(); }

void requireNoCycle(const SceneStack& open, const fs::path& path, const JsonField& field) {
    const fs::path canonical = fs::weakly_canonical(path);
    const auto first = std::find(open.begin(), open.end(), canonical);
    if (first != open.end()) {
        std::string cycle;
        for (auto at = first; at != open.end(); ++at) cycle += at->filename().string() + " > ";
        field.fail("expected no cycle, found " + cycle + canonical.filename().string());
    }
    if (open.size() >= kMaxImports)
        field.fail(fmt::format("expected at most {} scenes within each other", kMaxImports));
}

}  // namespace nacre
