// Scene files: every member arrives, and every wrong field is named by its path.
#include "shading/scene_file.hpp"

#include <numbers>

#include "tests/shading/scene_files.hpp"
#include "tests/shading/volume_fixture.hpp"

namespace nacre {
namespace {

using ::testing::HasSubstr;
using tests::kTriangleObj;

class SceneFile : public tests::SceneFiles {
protected:
    /// `text` is refused with a message that names this place and holds this fragment.
    void refuses(const std::string& sections, const std::string& place, const std::string& fragment) {
        const std::string message = errorOf(sceneText(sections));
        EXPECT_THAT(message, HasSubstr("scene.json: " + place + ": ")) << sections;
        EXPECT_THAT(message, HasSubstr(fragment)) << sections;
    }
};

TEST_F(SceneFile, EmptySceneHasACameraAndNothing) {
    const SceneDescription scene = read(R"({"nacre_scene": 1})");
    EXPECT_TRUE(scene.nodes.empty() && scene.lights.empty() && scene.assets.empty());
    EXPECT_EQ(scene.camera.eye, Camera().eye);
    EXPECT_EQ(scene.camera.far, Camera().far);
    EXPECT_EQ(read(sceneText(R"("camera": {"eye": [0, 0, 5]})")).camera.eye.z, 5);
}

TEST_F(SceneFile, MembersArrive) {
    write("gold.exr", "");
    write("wall.exr", "");
    const SceneDescription scene = read(sceneText(R"(
        "assets": {"gold": {"file": "gold.exr", "bake": {"verb": "factorize", "source": "sgd:gold-paint",
                                "options": {"--max-error": 0.02, "--size": 64, "--json-like": true, "--no": false,
                                            "--light": [0.6, 0, 0.8]}}},
                   "wall": {"file": "wall.exr", "source": "ward:alpha=0.1"}},
        "meshes": {"ball": {"sphere": {"radius": 2, "segments": 8, "stacks": 4}, "fit": 1}},
        "materials": {"gold": {"brdf": "gold", "ambient": 0.1,
                               "relief": {"asset": "wall", "shadow": "hard_horizon", "tiles": [2, 3],
                                          "indirectLight": "sun", "bounces": 1}}},
        "lights": {"lamp": {"type": "spot", "position": [0, 4, 0], "target": [0, 0, 0], "color": [1, 0.5, 0.25],
                            "intensity": 8, "innerDeg": 10, "outerDeg": 30, "node": "a",
                            "shadow": {"bits": 16, "faces": "back", "bias": 0.01}},
                   "sun": {"type": "directional", "direction": [0, -2, 0], "shadow": true}},
        "nodes": {"z": {"translation": [1, 2, 3], "children": ["a"]},
                  "a": {"mesh": "ball", "material": "gold", "axis": [0, 3, 0], "angleDeg": 90, "scale": 2,
                        "castsShadow": false}},
        "sky": {"color": [0, 0, 1], "rotationYDeg": 180},
        "camera": {"eye": [0, 0, 9], "fovYDeg": 60, "near": 1, "far": 20},
        "animation": {"tracks": [{"node": "z", "path": "rotation", "times": [0, 2], "axis": [0, 1, 0],
                                  "anglesDeg": [0, 90], "interpolation": "step"}]})"));
    ASSERT_EQ(scene.assets.size(), 2u);
    const BakeRecipe& recipe = *scene.assets[0].bake;
    EXPECT_EQ(recipe.options,
              (std::vector<std::string>{"--json-like", "--light", "0.6,0,0.8", "--max-error", "0.02", "--size", "64"}));
    EXPECT_EQ(scene.assets[0].source, "sgd:gold-paint");
    EXPECT_TRUE(recipe.inputs.empty()) << "a model is no file";
    EXPECT_EQ(scene.assets[1].source, "ward:alpha=0.1");
    EXPECT_EQ(scene.assets[1].file, scratch_ / "wall.exr");
    ASSERT_EQ(scene.nodes.size(), 2u);
    EXPECT_EQ(scene.nodes[0].name, "z") << "parents first";
    EXPECT_EQ(scene.nodes[1].parent, 0);
    EXPECT_EQ(scene.nodes[1].scale, Vec3(2));
    EXPECT_NEAR(scene.nodes[1].rotation.y, std::numbers::sqrt2 / 2, 1e-12);
    EXPECT_FALSE(scene.nodes[1].castsShadow);
    EXPECT_FALSE(scene.nodes[0].isStatic);
    EXPECT_FALSE(scene.nodes[1].isStatic) << "a parent moves";
    const SceneRelief& relief = *scene.materials[0].relief;
    EXPECT_EQ(relief.shadow, BumpShadow::HardHorizon);
    EXPECT_EQ(relief.tiles, Vec2(2, 3));
    EXPECT_EQ(relief.indirectLight, 1);
    EXPECT_EQ(relief.bounces, 1);
    const SceneLight& lamp = scene.lights[0];
    EXPECT_EQ(lamp.light.color, Rgb(8, 4, 2));
    EXPECT_EQ(lamp.light.cone->axis, Vec3(0, -1, 0));
    EXPECT_NEAR(lamp.light.cone->outer, kPi / 6, 1e-12);
    EXPECT_EQ(lamp.node, 1);
    EXPECT_EQ(lamp.shadow->faces, SceneShadow::Faces::Back);
    EXPECT_EQ(scene.lights[1].light.position, Vec3(0, 1, 0)) << "towards the light";
    EXPECT_TRUE(scene.lights[1].shadow);
    EXPECT_EQ(scene.duration, 2);
    EXPECT_TRUE(scene.tracks[0].step);
    EXPECT_NEAR(scene.sky.rotationY, kPi, 1e-12);
    EXPECT_NEAR(scene.camera.fovY, kPi / 3, 1e-12);
}

TEST_F(SceneFile, SyntaxErrorNamesLineAndColumn) {
    EXPECT_THAT(errorOf("{\n  \"nacre_scene\": 1,,\n}"),
                HasSubstr("scene.json: expected JSON, found: parse error at line 2, column 20"));
    EXPECT_THAT(errorOf(""), HasSubstr("line 1, column 1"));
}

TEST_F(SceneFile, NamesUsedTwice) {
    EXPECT_THAT(errorOf(sceneText(R"("meshes": {"a": {"quad": {}}, "a": {"quad": {}}})")),
                HasSubstr("scene.json: /meshes/a: expected each name once, found it twice"));
    EXPECT_THAT(errorOf(sceneText(R"("animation": {"tracks": [{}, {"node": 1, "node": 2}]})")),
                HasSubstr("/animation/tracks/1/node: "));
    write("a.exr", "");
    refuses(R"("assets": {"a": {"file": "a.exr", "bake": {"verb": "fresnel"}}, "b": {"file": "x/../a.exr"}})",
            "/assets/b/file", "\"a\"");
}

TEST_F(SceneFile, UnknownKeysAndNames) {
    EXPECT_THAT(errorOf(R"({"nacre_scene": 1, "nodez": {}})"),
                HasSubstr("scene.json: /: no key named \"nodez\"; there are $schema, nacre_scene"));
    EXPECT_THAT(errorOf("{}"), HasSubstr("scene.json: /: expected the key \"nacre_scene\""));
    EXPECT_THAT(errorOf(R"({"nacre_scene": 2})"), HasSubstr("/nacre_scene: expected version 1, found 2"));
    write("gold.exr", "");
    write("wall.exr", "");
    refuses(
        R"("assets": {"gold": {"file": "gold.exr"}, "wall": {"file": "wall.exr"}}, "materials": {"gold": {"brdf": "gol"}})",
        "/materials/gold/brdf", "no asset named \"gol\"; there are gold, wall");
    refuses(R"("nodes": {"a/b": {"mesh": "x"}})", "/nodes/a~1b/mesh", "no mesh named \"x\"; there are none");
    refuses(R"("materials": {"m": {"model": "lambert:shine=1"}})", "/materials/m/model", "shine");
    refuses(R"("materials": {"m": {"relief": {"depth": 1}}})", "/materials/m/relief", "\"depth\"");
    refuses(R"("lights": {"l": {"type": "point", "direction": [0, 0, 1]}})", "/lights/l", "no key named \"direction\"");
}

TEST_F(SceneFile, WrongTypesAndRanges) {
    refuses(R"("meshes": [])", "/meshes", "expected an object, found an array of 0");
    refuses(R"("meshes": {"m": {}})", "/meshes/m", "expected one of file, torus");
    refuses(R"("meshes": {"m": {"torus": {}, "disk": {}}})", "/meshes/m", "torus and disk");
    refuses(R"("meshes": {"m": {"torus": {"tube": -1}}})", "/meshes/m/torus/tube", "above 0, found -1");
    refuses(R"("meshes": {"m": {"sphere": {"segments": 2}}})", "/meshes/m/sphere/segments", "3 to 2048, found 2");
    refuses(R"("materials": {"m": {"ambient": [1, 2]}})", "/materials/m/ambient",
            "expected an array of 3, found an array of 2");
    refuses(R"("materials": {"m": {"ambient": [1, 2, -1]}})", "/materials/m/ambient/2", "from 0 to 1e+15, found -1");
    refuses(R"("camera": {"eye": [0, 0, "3"]})", "/camera/eye/2", "to 1e+09, found \"3\"");
    refuses(R"("camera": {"eye": [0, 0, 0]})", "/camera", "apart");
    refuses(R"("camera": {"up": [0, 0, 1]})", "/camera", "along");
    refuses(R"("camera": {"near": 2, "far": 1})", "/camera/far", "more than near");
    refuses(R"("lights": {"l": {"type": "sun"}})", "/lights/l/type", "directional, point, spot");
    refuses(R"("lights": {"l": {"type": "spot", "innerDeg": 50}})", "/lights/l/innerDeg", "less than outerDeg, 45");
    refuses(R"("lights": {"l": {"type": "spot", "shadow": {"bits": 24}}})", "/lights/l/shadow/bits", "16 or 32");
    refuses(R"("lights": {"l": {"type": "spot", "shadow": {"cascades": 2}}})", "/lights/l/shadow/cascades",
            "directional");
    refuses(R"("nodes": {"n": {"rotation": [0, 0, 0, 2]}})", "/nodes/n/rotation", "unit");
    refuses(R"("nodes": {"n": {"scale": [1, 0, 1]}})", "/nodes/n/scale", "0");
    refuses(R"("nodes": {"n": {"angleDeg": 4}})", "/nodes/n/angleDeg", "axis");
    refuses(R"("meshes": {"q": {"quad": {}}}, "nodes": {"n": {"mesh": "q"}})", "/nodes/n", "\"material\"");
    for (const char* rest : {R"("meshes": {"q": {"quad": {"size": [1, 2]}}})", R"("meshes": {"q": {"file": 3}})",
                             R"("volumes": {"v": {"iso": 1, "file": 3}})", R"("materials": {"m": {"model": 3}})",
                             R"("materials": {"m": {"specular": {"filter": 3}}})"}) {
        const std::string error = errorOf(sceneText(rest));
        EXPECT_EQ(error.find("scene.json: "), error.rfind("scene.json: ")) << "one place: " << error;
    }
    for (const char* v : {"[0, 0, 0]", "[-2, 0, 0]"})
        refuses(R"("lights": {"l": {"type": "point", "area": {"u": [1, 0, 0], "v": )" + std::string(v) + "}}}",
                "/lights/l/area", "parallel");
    refuses(
        R"("nodes": {"n": {}}, "animation": {"tracks": [{"node": "n", "path": "scale", "times": [1, 1], "values": []}]})",
        "/animation/tracks/0/times/1", "after 1");
    refuses(
        R"("nodes": {"n": {}}, "animation": {"tracks": [{"node": "n", "path": "scale", "times": [0, 1], "values": [[1,1,1]]}]})",
        "/animation/tracks/0/values", "array of 2");
    refuses(
        R"("nodes": {"n": {}}, "animation": {"tracks": [{"node": "n", "path": "rotation", "times": [0, 1], "axis": [0,1,0], "anglesDeg": [0, 270]}]})",
        "/animation/tracks/0/anglesDeg/1", "180");
    refuses(R"("lights": {"l": {"type": "point", "intensity": 1e300}})", "/lights/l/intensity", "to 1e+15");
    refuses(R"("lights": {"l": {"type": "point", "position": [0, 1e39, 0]}})", "/lights/l/position/1", "to 1e+09");
    refuses(R"("camera": {"near": 1e-300})", "/camera/near", "from 1e-06");
    const std::string vast = R"("meshes": {"q": {"quad": {"size": 1e9}}}, "materials": {"m": {}},
        "nodes": {"n": {"mesh": "q", "material": "m", "scale": 10}})";
    EXPECT_THAT(errorOf(sceneText(vast)),
                HasSubstr("scene.json: expected all of the scene within 1e+09 of the origin, found a vertex at 5e+09"));
    refuses(R"("materials": {"m": {"specular": {"filter": {"colors": {"a": 1}, "rows": ["é"]}}}})",
            "/materials/m/specular/filter/rows/0", "ASCII letters, found é");
    std::string deep;
    for (int i = 0; i < 100; ++i) deep += "[";
    EXPECT_THAT(errorOf(deep), HasSubstr("levels"));
}

TEST_F(SceneFile, MissingFilesNameThePath) {
    refuses(R"("assets": {"gold": {"file": "gold.exr"}})", "/assets/gold/file", (scratch_ / "gold.exr").string());
    refuses(R"("assets": {"gold": {"file": "gold.exr", "bake": {"verb": "factorize", "source": "lambert"}}})",
            "/assets/gold/file", "nacre bake");
    refuses(R"("meshes": {"m": {"file": "no.obj"}})", "/meshes/m/file", (scratch_ / "no.obj").string());
    refuses(R"("nodes": {"n": {"import": "no.glb"}})", "/nodes/n/import", (scratch_ / "no.glb").string());
    const auto path = write("s.json", sceneText(R"("assets": {"gold": {"file": "gold.exr"}})"));
    EXPECT_EQ(readScene(path, {.needAssets = false, .note = {}}).assets.size(), 1u);
}

TEST_F(SceneFile, Cycles) {
    refuses(R"("nodes": {"a": {"children": ["b"]}, "b": {"children": ["c"]}, "c": {"children": ["b"]}})",
            "/nodes/c/children/0", "found one under \"a\"");
    refuses(R"("nodes": {"b": {"children": ["c"]}, "c": {"children": ["b"]}})", "/nodes/b/children", "b > c > b");
    refuses(R"("nodes": {"b": {"children": ["b"]}})", "/nodes/b/children", "b > b");
    refuses(R"("nodes": {"b": {"import": "scene.json"}})", "/nodes/b/import", "scene.json > scene.json");
    write("other.json", sceneText(R"("nodes": {"x": {"import": "scene.json"}})"));
    refuses(R"("nodes": {"b": {"import": "other.json"}})", "/nodes/b/import", "scene.json > other.json > scene.json");
}

TEST_F(SceneFile, ImportsShareWhatTheyHave) {
    write("t.obj", kTriangleObj);
    write("lamp.json",
          sceneText(R"("meshes": {"t": {"file": "t.obj"}}, "materials": {"red": {"model": "lambert:kd=1/0/0"}},
        "lights": {"bulb": {"type": "point", "position": [0, 1, 0]}},
        "nodes": {"stand": {"mesh": "t", "material": "red"}}, "camera": {"eye": [0, 0, 4]},
        "animation": {"tracks": [{"node": "stand", "path": "translation", "times": [0, 3], "values": [[0,0,0],[1,0,0]]}]})"));
    const SceneDescription scene = read(sceneText(R"("materials": {"blue": {"model": "lambert:kd=0/0/1"}},
        "nodes": {"left": {"import": "lamp.json", "translation": [-2, 0, 0]},
                  "right": {"import": "lamp.json", "translation": [2, 0, 0], "material": "blue"}})"));
    ASSERT_EQ(scene.nodes.size(), 4u);
    EXPECT_EQ(scene.meshes.size(), 1u) << "one mesh, two instances";
    EXPECT_EQ(scene.nodes[1].name, "left/stand");
    EXPECT_EQ(scene.materials[static_cast<std::size_t>(scene.nodes[1].material)].name, "lamp.json/red");
    EXPECT_EQ(scene.materials[static_cast<std::size_t>(scene.nodes[3].material)].name, "blue");
    EXPECT_EQ(scene.tracks.size(), 2u);
    EXPECT_EQ(scene.tracks[1].node, 3);
    EXPECT_EQ(scene.duration, 3);
    EXPECT_TRUE(scene.nodes[0].isStatic);
    EXPECT_FALSE(scene.nodes[3].isStatic);
    const std::vector<Light> lights = lightsInWorld(scene, nodeTransforms(scene, 0));
    EXPECT_EQ(lights[0].position, Vec3(-2, 1, 0));
    EXPECT_EQ(lights[1].position, Vec3(2, 1, 0));
    EXPECT_EQ(scene.camera.eye, Vec3(-2, 0, 4)) << "the first imported camera, where its node places it";
}

TEST_F(SceneFile, ReliefNeedsUv) {
    write("w.exr", "");
    write("t.obj", kTriangleObj);
    const std::string rest = R"("assets": {"w": {"file": "w.exr"}}, "materials": {"m": {"relief": {"asset": "w"}}})";
    refuses(rest + R"(, "meshes": {"t": {"file": "t.obj"}}, "nodes": {"n": {"mesh": "t", "material": "m"}})",
            "/nodes/n", "uv");
    refuses(
        rest + R"(, "meshes": {"t": {"disk": {"tangents": "radial"}}}, "nodes": {"n": {"mesh": "t", "material": "m"}})",
        "/nodes/n", "radial");
    refuses(rest + R"(, "nodes": {"n": {"import": "t.obj", "material": "m"}})", "/nodes/n", "uv");
    EXPECT_EQ(
        read(sceneText(rest + R"(, "meshes": {"t": {"quad": {}}}, "nodes": {"n": {"mesh": "t", "material": "m"}})"))
            .nodes.size(),
        1u);
}

TEST_F(SceneFile, VolumesArriveAndWrongOnesAreNamed) {
    write("cube.den", test::text(test::den(2, 3, 4)));
    const std::string cube = R"("volumes": {"cube": {"file": "cube.den", "iso": 4.5, "method": "slices", "step": 0.25}},
                                "materials": {"matt": {"model": "lambert"}}, )";
    const SceneDescription scene =
        read(sceneText(cube + R"("nodes": {"v": {"volume": "cube", "material": "matt", "translation": [1, 0, 0]}})"));
    ASSERT_EQ(scene.volumes.size(), 1u);
    EXPECT_EQ(scene.volumes[0].name, "cube");
    EXPECT_EQ(scene.volumes[0].volume->size, glm::ivec3(2, 3, 4));
    EXPECT_EQ(scene.volumes[0].iso, 4.5);
    EXPECT_EQ(scene.volumes[0].method, VolumeMethod::Slices);
    EXPECT_EQ(scene.volumes[0].step, 0.25);
    EXPECT_EQ(scene.nodes[0].volume, 0);
    EXPECT_EQ(scene.nodes[0].mesh, -1);
    EXPECT_NEAR(scene.camera.target.x, 1, 1e-12) << "the camera sees the volume";
    refuses(R"("volumes": {"v": {"file": "gone.den", "iso": 1}})", "/volumes/v/file", "gone.den");
    write("other.den", "nothing");
    refuses(R"("volumes": {"v": {"file": "other.den", "iso": 1}})", "/volumes/v/file",
            "expected a volume (.den or .inr)");
    refuses(R"("volumes": {"v": {"file": "cube.den"}})", "/volumes/v", "iso");
    refuses(R"("volumes": {"v": {"file": "cube.den", "iso": 1, "step": -1}})", "/volumes/v/step", "");
    refuses(cube + R"("nodes": {"v": {"volume": "cub", "material": "matt"}})", "/nodes/v/volume", "cube");
    refuses(cube + R"("nodes": {"v": {"volume": "cube"}})", "/nodes/v", "\"material\" beside \"volume\"");
    refuses(
        cube + R"("nodes": {"v": {"volume": "cube", "material": "matt", "mesh": "q"}}, "meshes": {"q": {"quad": {}}})",
        "/nodes/v", "found both");
    write("wall.exr", "");
    refuses(R"("volumes": {"cube": {"file": "cube.den", "iso": 4}}, "assets": {"wall": {"file": "wall.exr"}},
               "materials": {"rock": {"model": "lambert", "relief": {"asset": "wall"}}},
               "nodes": {"v": {"volume": "cube", "material": "rock"}})",
            "/nodes/v", "without relief for a volume, found \"rock\"");
    // Imported twice: one volume, two nodes.
    write("part.json", sceneText(cube + R"("nodes": {"v": {"volume": "cube", "material": "matt"}})"));
    const SceneDescription twice =
        read(sceneText(R"("nodes": {"a": {"import": "part.json"}, "b": {"import": "part.json"}})"));
    ASSERT_EQ(twice.volumes.size(), 1u);
    EXPECT_EQ(std::count_if(twice.nodes.begin(), twice.nodes.end(), [](const SceneNode& n) { return n.volume == 0; }),
              2);
}

TEST_F(SceneFile, AMeshAloneIsAScene) {
    const SceneDescription scene = read(kTriangleObj, "t.obj");
    ASSERT_EQ(scene.nodes.size(), 1u);
    EXPECT_EQ(scene.materials[0].name, "grey");
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_TRUE(scene.lights[0].shadow);
    const glm::dmat4 clip = scene.camera.projection(1) * scene.camera.view();
    for (const glm::vec3& p : scene.meshes[0].mesh.positions) {
        const Vec4 q = clip * Vec4(Vec3(p), 1);
        EXPECT_LE(std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)}), q.w) << "seen";
    }
    EXPECT_TRUE(isSceneName("a/b.glb") && isSceneName("b.obj") && isSceneName("s.json") && !isSceneName("a.exr"));
}

}  // namespace
}  // namespace nacre
