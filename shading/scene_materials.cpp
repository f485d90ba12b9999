#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/image_file.hpp"
#include "factorize/models/models.hpp"
#include "shading/scene_manifest.hpp"
#include "shading/scene_sections.hpp"

namespace nacre {
namespace {

SceneLookup lookup(const JsonField& field, const SceneNames& names) {
    field.requireKeys({"asset", "lod", "color"});
    SceneLookup out;
    out.asset = field.at("asset").nameIn(names.assets, "asset");
    ifThere(field, "lod", [&](const JsonField& f) { out.lod = f.number(0, 32); });
    ifThere(field, "color", [&](const JsonField& f) { out.color = f.color(); });
    return out;
}

SceneSurrounding surrounding(const JsonField& field, const SceneNames& names) {
    field.requireKeys({"reflection", "transmission", "diffuse", "ior", "table", "f0", "perceptualRoughness",
                       "multipleScattering", "combine"});
    SceneSurrounding out;
    ifThere(field, "reflection", [&](const JsonField& f) { out.reflection = lookup(f, names); });
    ifThere(field, "transmission", [&](const JsonField& f) { out.transmission = lookup(f, names); });
    ifThere(field, "diffuse", [&](const JsonField& f) { out.diffuse = lookup(f, names); });
    if (out.reflection.asset < 0 && out.transmission.asset < 0 && out.diffuse.asset < 0)
        field.fail("expected \"reflection\", \"transmission\" or \"diffuse\", found none");
    ifThere(field, "ior", [&](const JsonField& f) { out.ior = f.positive(); });
    ifThere(field, "table", [&](const JsonField& f) { out.table = f.nameIn(names.assets, "asset"); });
    ifThere(field, "f0", [&](const JsonField& f) { out.f0 = f.color(); });
    ifThere(field, "perceptualRoughness", [&](const JsonField& f) { out.perceptualRoughness = f.number(0, 1); });
    ifThere(field, "multipleScattering", [&](const JsonField& f) { out.multipleScattering = f.flag(); });
    ifThere(field, "combine", [&](const JsonField& f) { out.blend = f.choice({"add", "blend"}) == 1; });
    return out;
}

SceneRelief relief(const JsonField& field, const SceneNames& names) {
    field.requireKeys({"asset", "shadow", "tiles", "roughness", "indirectLight", "albedo", "bounces", "paths"});
    SceneRelief out;
    out.asset = field.at("asset").nameIn(names.assets, "asset");
    ifThere(field, "shadow", [&](const JsonField& f) {
        static constexpr std::array kShadows = {BumpShadow::None, BumpShadow::HardEllipse, BumpShadow::Ellipse,
                                                BumpShadow::HardHorizon, BumpShadow::Horizon};
        out.shadow = kShadows[static_cast<std::size_t>(
            f.choice({"none", "hard_ellipse", "ellipse", "hard_horizon", "horizon"}))];
    });
    ifThere(field, "tiles", [&](const JsonField& f) {
        if (f.value().is_number()) {
            out.tiles = Vec2(f.positive());
        } else {
            const auto items = f.items(2, 2);
            out.tiles = {items[0].positive(), items[1].positive()};
        }
    });
    ifThere(field, "roughness", [&](const JsonField& f) { out.roughness = f.flag(); });
    ifThere(field, "indirectLight", [&](const JsonField& f) { out.indirectLight = f.nameIn(names.lights, "light"); });
    for (const char* key : {"albedo", "bounces", "paths"})
        if (const auto f = field.find(key); f && out.indirectLight < 0)
            f->fail("expected \"indirectLight\" beside it, found none");
    ifThere(field, "albedo", [&](const JsonField& f) {
        out.albedo = f.color();
        if (maxComponent(out.albedo) > 1) f.fail("expected an albedo of at most 1");
    });
    ifThere(field, "bounces", [&](const JsonField& f) { out.bounces = f.integer(0, 16); });
    ifThere(field, "paths", [&](const JsonField& f) { out.paths = f.integer(1, 100000); });
    return out;
}

/// As four channels.
std::shared_ptr<const Image> textureOf(const std::filesystem::path& path) {
    const Image in = readImageFile(path).image;
    Image out(in.width(), in.height(), 4);
    const bool grey = in.channels() < 3, alpha = in.channels() % 2 == 0;
    for (int y = 0; y < in.height(); ++y)
        for (int x = 0; x < in.width(); ++x) {
            for (int c = 0; c < 3; ++c) out.at(x, y, c) = in.at(x, y, grey ? 0 : c);
            out.at(x, y, 3) = alpha ? in.at(x, y, in.channels() - 1) : 1;
        }
    return std::make_shared<const Image>(std::move(out));
}

/// A picture in words: a colour for each letter, and rows of letters, the first at v = 0.
std::shared_ptr<const Image> lettered(const JsonField& field) {
    field.requireKeys({"colors", "rows"});
    const JsonField colors = field.at("colors");
    const auto rows = field.at("rows").items(1, 1024);
    const std::size_t width = rows[0].text().size();
    Image out(static_cast<int>(width), static_cast<int>(rows.size()), 4);
    for (std::size_t y = 0; y < rows.size(); ++y) {
        const std::string row = rows[y].text();
        if (std::any_of(row.begin(), row.end(), [](char c) { return (c & 0x80) != 0; }))
            rows[y].fail("expected ASCII letters, found " + row);
        if (row.size() != width) rows[y].fail(fmt::format("expected {} letters, found {}", width, row.size()));
        for (std::size_t x = 0; x < width; ++x) {
            out.setRgb(static_cast<int>(x), static_cast<int>(y), colors.at(std::string(1, row[x])).color());
            out.at(static_cast<int>(x), static_cast<int>(y), 3) = 1;
        }
    }
    return std::make_shared<const Image>(std::move(out));
}

std::shared_ptr<const Image> filterOf(const JsonField& field, const std::filesystem::path& folder) {
    if (field.value().is_object()) return lettered(field);
    return namedText(field, [&](const std::string& name) { return textureOf(scenePath(folder, name)); });
}

SceneSpecular specular(const JsonField& field, const std::filesystem::path& folder) {
    field.requireKeys({"ior", "reflection", "transmission", "partial", "surface", "texture", "filter", "fog",
                       "fogDistance", "spread", "roughness"});
    SceneSpecular out;
    ifThere(field, "ior", [&](const JsonField& f) { out.ior = f.number(1e-3, 1e3); });
    ifThere(field, "reflection", [&](const JsonField& f) { out.reflection = f.color(1); });
    for (const char* key : {"transmission", "partial"})
        if (const auto f = field.find(key); f && !out.ior) f->fail("expected \"ior\" beside it, found none");
    ifThere(field, "transmission", [&](const JsonField& f) { out.transmission = f.color(1); });
    ifThere(field, "partial", [&](const JsonField& f) { out.partial = f.flag(); });
    ifThere(field, "surface", [&](const JsonField& f) { out.surface = f.number(0, 1); });
    ifThere(field, "texture", [&](const JsonField& f) {
        if (out.surface == 0) f.fail("expected \"surface\" beside it, found none");
        out.texture = namedText(f, [&](const std::string& name) { return textureOf(scenePath(folder, name)); });
        out.pictures.push_back(scenePath(folder, f.text()));
    });
    ifThere(field, "filter", [&](const JsonField& f) {
        out.filter = filterOf(f, folder);
        if (f.value().is_string()) out.pictures.push_back(scenePath(folder, f.text()));
    });
    ifThere(field, "fogDistance", [&](const JsonField& f) { out.fogDistance = f.number(1e-6, kFarthest); });
    ifThere(field, "fog", [&](const JsonField& f) {
        if (out.fogDistance == 0) f.fail("expected \"fogDistance\" beside it, found none");
        out.fog = f.color();
    });
    // A face that spreads less is drawn clear: many samples of it would show nothing else.
    const auto orClear = [](double spread) { return spread < 1e-4 ? 0 : spread; };
    ifThere(field, "spread", [&](const JsonField& f) { out.spread = orClear(f.number(0, 10)); });
    ifThere(field, "roughness", [&](const JsonField& f) {
        if (out.spread > 0) f.fail("expected \"spread\" or \"roughness\", found both");
        out.roughness = orClear(f.number(0, 1));
    });
    return out;
}

}  // namespace

SceneMaterial sceneMaterial(const std::string& name, const JsonField& field, const SceneNames& names,
                            const std::filesystem::path& folder) {
    field.requireKeys({"brdf", "model", "ambient", "relief", "surrounding", "specular"});
    SceneMaterial out;
    out.name = name;
    ifThere(field, "brdf", [&](const JsonField& f) { out.brdf = f.nameIn(names.assets, "asset"); });
    ifThere(field, "model", [&](const JsonField& f) {
        if (out.brdf >= 0) f.fail("expected \"brdf\" or \"model\", found both");
        out.model = namedText(f, [](const std::string& model) { return makeModel(model).source; });
    });
    ifThere(field, "ambient", [&](const JsonField& f) { out.ambient = f.color(); });
    ifThere(field, "relief", [&](const JsonField& f) { out.relief = relief(f, names); });
    ifThere(field, "surrounding", [&](const JsonField& f) { out.surrounding = surrounding(f, names); });
    ifThere(field, "specular", [&](const JsonField& f) { out.specular = specular(f, folder); });
    return out;
}

}  // namespace nacre
