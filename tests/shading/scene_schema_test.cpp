// The schema and the reader know the same keys, and agree on a scene that uses every one of them.
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "shading/image_output.hpp"
#include "tests/shading/scene_files.hpp"
#include "tests/shading/volume_fixture.hpp"

namespace nacre {
namespace {

using nlohmann::json;

/// Every key of the format, at least once.
constexpr const char* kEverything = R"({
  "$schema": "scene.schema.json", "nacre_scene": 1,
  "assets": {
    "gold": {"file": "gold.exr", "bake": {"verb": "factorize", "source": "lambert", "options": {"--size": 8, "--f": true}}},
    "wall": {"file": "wall.exr", "source": "wall.png"}
  },
  "meshes": {
    "file": {"file": "t.obj", "fit": 2},
    "torus": {"torus": {"ring": 1, "tube": 0.4, "rings": 8, "sides": 8, "tangents": "radial"}},
    "sphere": {"sphere": {"radius": 1, "segments": 8, "stacks": 8, "tangents": "circular"}},
    "disk": {"disk": {"radius": 1, "segments": 8, "rings": 2, "tangents": "circular"}},
    "quad": {"quad": {"size": 2, "steps": 1}}
  },
  "volumes": {"cube": {"file": "cube.den", "iso": 4, "method": "slices", "step": 0.25}},
  "materials": {
    "a": {"brdf": "gold", "ambient": [0, 0, 0.1],
      "relief": {"asset": "wall", "shadow": "horizon", "tiles": 2, "roughness": true, "indirectLight": "sun",
                 "albedo": 0.5, "bounces": 2, "paths": 8},
      "surrounding": {"reflection": {"asset": "wall", "lod": 1, "color": 0.5}, "transmission": {"asset": "wall"},
                      "diffuse": {"asset": "wall"}, "ior": 1.3, "table": "wall", "f0": 0.04, "perceptualRoughness": 0.3,
                      "multipleScattering": true, "combine": "blend"}},
    "b": {"model": "lambert"},
    "c": {"specular": {"ior": 1.5, "reflection": 1, "transmission": [1, 0.9, 1], "partial": false, "surface": 0.1,
      "texture": "dot.exr", "filter": {"colors": {"a": 0.5, "b": [1, 0, 0]}, "rows": ["ab", "ba"]}, "fog": 0.5, "fogDistance": 2, "spread": 0.1}}
  },
  "lights": {
    "sun": {"type": "directional", "color": [1, 1, 1], "intensity": 2, "direction": [0, -1, 0],
            "shadow": {"size": 512, "bits": 16, "filter": 5, "faces": "front", "bias": 0.1, "near": 1, "far": 2, "cascades": 4}},
    "bulb": {"type": "point", "color": 1, "intensity": 2, "node": "n", "position": [0, 1, 0], "shadow": {"projection": "cube"},
             "area": {"u": [1, 0, 0], "v": [0, 0, 1]}},
    "lamp": {"type": "spot", "color": 1, "intensity": 2, "node": "n", "position": [0, 1, 0], "target": [0, 0, 0],
             "innerDeg": 1, "outerDeg": 2, "shadow": true},
    "torch": {"type": "spot", "direction": [0, 0, 1]}
  },
  "nodes": {
    "n": {"mesh": "quad", "material": "a", "translation": [0, 1, 2], "rotation": [0, 0, 0, 1], "scale": 2,
          "castsShadow": false, "receivesShadow": false, "static": false, "children": ["m"]},
    "v": {"volume": "cube", "material": "b"},
    "m": {"import": "t.obj", "axis": [0, 1, 0], "angleDeg": 30, "scale": [1, 2, 3]}
  },
  "camera": {"eye": [0, 0, 5], "target": [0, 0, 0], "up": [0, 1, 0], "fovYDeg": 30, "near": 1, "far": 9},
  "sky": {"asset": "wall", "lod": 1, "rotationYDeg": 10},
  "animation": {"duration": 3, "tracks": [
    {"node": "n", "path": "translation", "times": [0, 1], "values": [[0, 0, 0], [1, 0, 0]], "interpolation": "step"},
    {"node": "n", "path": "rotation", "times": [0, 1], "axis": [0, 1, 0], "anglesDeg": [0, 90]}]}
})";
/// What the first can't have beside other keys.
constexpr const char* kOtherwise =
    R"({"nacre_scene": 1, "camera": {"orthographicHeight": 2}, "sky": {"color": [0, 0, 1]},
  "materials": {"frosted": {"specular": {"roughness": 0.2}}}})";

/// As much of JSON Schema as ours uses; other keywords but notes fail the test.
class Schema {
public:
    explicit Schema(json text) : text_(std::move(text)) {}

    const json& root() const { return text_; }
    const json& resolved(const json& schema) const {
        return schema.contains("$ref")
                   ? resolved(text_.at(json::json_pointer(schema["$ref"].get<std::string>().substr(1))))
                   : schema;
    }
    bool accepts(const json& schema, const json& value) const {
        for (const auto& [keyword, wanted] : schema.items())
            if (!holds(keyword, wanted, schema, value)) return false;
        return true;
    }

private:
    static bool isOf(const std::string& type, const json& v) {
        return type == "object"    ? v.is_object()
               : type == "array"   ? v.is_array()
               : type == "string"  ? v.is_string()
               : type == "boolean" ? v.is_boolean()
               : type == "integer" ? v.is_number_integer()
                                   : type == "number" && v.is_number();
    }
    bool holds(const std::string& k, const json& wanted, const json& schema, const json& v) const {
        static const std::set<std::string> kNotes = {"$schema",     "$id",     "$defs",     "title",
                                                     "description", "default", "properties"};
        const double number = v.is_number() ? v.get<double>() : 0;
        if (kNotes.count(k)) return true;
        if (k == "$ref") return accepts(resolved(schema), v);
        if (k == "const") return v == wanted;
        if (k == "enum") return std::find(wanted.begin(), wanted.end(), v) != wanted.end();
        if (k == "oneOf")
            return std::count_if(wanted.begin(), wanted.end(), [&](const json& s) { return accepts(s, v); }) == 1;
        if (k == "type") {
            if (wanted.is_string()) return isOf(wanted, v);
            return std::any_of(wanted.begin(), wanted.end(), [&](const json& t) { return isOf(t, v); });
        }
        if ((k == "required" || k == "propertyNames") && !v.is_object()) return true;
        if (k == "required")
            return std::all_of(wanted.begin(), wanted.end(), [&](const json& n) { return v.contains(n); });
        if (k == "propertyNames") {
            for (const auto& [name, ignored] : v.items())
                if (!std::regex_search(name, std::regex(wanted["pattern"].get<std::string>()))) return false;
            return true;
        }
        if (k == "additionalProperties") {
            if (!v.is_object()) return true;
            for (const auto& [name, inner] : v.items()) {
                const bool known = schema.contains("properties") && schema["properties"].contains(name);
                if (known ? !accepts(schema["properties"][name], inner) : wanted == false || !accepts(wanted, inner))
                    return false;
            }
            return true;
        }
        if ((k == "minItems" || k == "maxItems" || k == "items") && !v.is_array()) return true;
        if (k == "minLength" && !v.is_string()) return true;
        if (k == "items")
            return std::all_of(v.begin(), v.end(), [&](const json& item) { return accepts(wanted, item); });
        if (k == "minItems") return v.size() >= wanted.get<std::size_t>();
        if (k == "maxItems") return v.size() <= wanted.get<std::size_t>();
        if (k == "minLength") return v.get<std::string>().size() >= wanted.get<std::size_t>();
        if (k == "minimum") return number >= wanted.get<double>();
        if (k == "maximum") return number <= wanted.get<double>();
        if (k == "exclusiveMinimum") return number > wanted.get<double>();
        if (k == "exclusiveMaximum") return number < wanted.get<double>();
        ADD_FAILURE() << "a keyword that this test doesn't know: " << k;
        return false;
    }

    json text_;
};

class SceneSchema : public tests::SceneFiles {
protected:
    void SetUp() override {
        for (const char* name : {"gold.exr", "wall.exr", "wall.png"}) write(name, "");
        writeExr(Image(2, 2, 3), scratch_ / "dot.exr");
        write("cube.den", test::text(test::den(2, 2, 2)));
        write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    }

    /// The keys that the reader lists when it meets one that it doesn't know, at this place of the scene.
    std::set<std::string> keysAt(const json& scene, const json::json_pointer& place) {
        json changed = scene;
        changed[place]["unheard-of"] = 1;
        const std::string message = errorOf(changed.dump());
        const std::size_t list = message.find("; there are ");
        EXPECT_NE(list, std::string::npos) << place.to_string() << ": " << message;
        EXPECT_NE(message.find("\"unheard-of\""), std::string::npos) << message;
        std::set<std::string> out;
        std::stringstream words(list == std::string::npos ? "" : message.substr(list + 12));
        for (std::string word; std::getline(words >> std::ws, word, ',');) out.insert(word);
        return out;
    }

    void visit(const json& scene, const json& schema, const json::json_pointer& place) {
        const json& s = schema_.resolved(schema);
        const json& value = scene.at(place);
        if (s.contains("oneOf")) {
            for (const json& branch : s["oneOf"])
                if (schema_.accepts(branch, value)) visit(scene, branch, place);
            return;
        }
        if (s.contains("items"))
            for (std::size_t i = 0; i < value.size(); ++i) visit(scene, s["items"], place / i);
        if (!value.is_object()) return;
        if (s.contains("properties")) {
            auto& [inSchema, inReader, used] = objects_[&s];
            for (const auto& [key, ignored] : s["properties"].items()) inSchema.insert(key);
            for (const auto& [key, ignored] : value.items()) used.insert(key);
            inReader.merge(keysAt(scene, place));
        }
        for (const auto& [key, ignored] : value.items()) {
            const bool known = s.contains("properties") && s["properties"].contains(key);
            visit(scene, known ? s["properties"][key] : s["additionalProperties"], place / key);
        }
    }

    Schema schema_{json::parse(tests::fileText(NACRE_SOURCE_DIR "/shading/scene.schema.json"))};
    struct Keys {
        std::set<std::string> inSchema, inReader, used;
    };
    std::map<const json*, Keys> objects_;
};

TEST_F(SceneSchema, SchemaAndReaderKnowTheSameKeys) {
    for (const char* text : {kEverything, kOtherwise}) {
        const json scene = json::parse(text);
        EXPECT_EQ(errorOf(text), "nothing was thrown");
        EXPECT_TRUE(schema_.accepts(schema_.root(), scene));
        visit(scene, schema_.root(), json::json_pointer());
    }
    EXPECT_EQ(objects_.size(), 23u) << "kinds of objects";
    for (const auto& [schema, keys] : objects_) {
        EXPECT_EQ(keys.inSchema, keys.inReader) << schema->dump();
        EXPECT_EQ(keys.inSchema, keys.used) << "kEverything and kOtherwise must use every key of " << schema->dump();
    }
}

TEST_F(SceneSchema, BothRefuse) {
    const json scene = json::parse(kEverything);
    const std::vector<std::pair<const char*, json>> changes = {{"/nacre_scene", 2},
                                                               {"/assets/gold/file", 3},
                                                               {"/assets/gold/bake/verb", "bake"},
                                                               {"/assets/gold/bake/options/--size", {{"a", 1}}},
                                                               {"/meshes/torus/torus/tube", 0},
                                                               {"/meshes/quad/quad/steps", 0},
                                                               {"/meshes/disk/disk/rings", 1.5},
                                                               {"/volumes/cube/iso", "high"},
                                                               {"/volumes/cube/method", "splats"},
                                                               {"/volumes/cube/step", 0},
                                                               {"/materials/a/ambient", {1, 2}},
                                                               {"/materials/a/ambient", -1},
                                                               {"/materials/c/specular/reflection", 1e38},
                                                               {"/materials/c/specular/filter/rows", 1},
                                                               {"/materials/a/relief/shadow", "soft"},
                                                               {"/materials/a/relief/tiles", {1, 0}},
                                                               {"/materials/a/relief/bounces", 17},
                                                               {"/materials/a/surrounding/ior", 0},
                                                               {"/materials/a/surrounding/reflection/lod", 33},
                                                               {"/materials/a/surrounding/combine", true},
                                                               {"/lights/sun/type", "area"},
                                                               {"/lights/bulb/area/u", {1, 2}},
                                                               {"/lights/sun/intensity", -1},
                                                               {"/lights/sun/shadow/bits", 24},
                                                               {"/lights/sun/shadow/size", 8},
                                                               {"/lights/lamp/outerDeg", 91},
                                                               {"/lights/lamp/shadow", 1},
                                                               {"/nodes/n/translation", {1, 2}},
                                                               {"/nodes/n/static", 0},
                                                               {"/nodes/n/children", "m"},
                                                               {"/camera/fovYDeg", 180},
                                                               {"/camera/near", 0},
                                                               {"/sky/lod", -1},
                                                               {"/animation/duration", 0},
                                                               {"/animation/tracks/0/times", json::array()},
                                                               {"/animation/tracks/0/interpolation", "cubic"}};
    for (const auto& [place, value] : changes) {
        json changed = scene;
        changed[json::json_pointer(place)] = value;
        EXPECT_FALSE(schema_.accepts(schema_.root(), changed)) << place;
        EXPECT_THAT(errorOf(changed.dump()), ::testing::HasSubstr(std::string("scene.json: ") + place)) << value;
    }
}

}  // namespace
}  // namespace nacre
