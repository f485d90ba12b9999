// Scanned rooms as scenes (shading/room_capture.hpp).
#include "shading/room_capture.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "scene_files.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using tests::SceneFiles;

template <typename T>
std::string base64(const std::vector<T>& values) {
    static const char* kSigns = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<std::uint8_t> bytes(values.size() * sizeof(T));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0);
        for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? kSigns[bits >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

json place(double x, double y, double z, const json& turn = {{"x", 0}, {"y", 0}, {"z", 0}, {"w", 1}}) {
    return {{"position", {{"x", x}, {"y", y}, {"z", z}}}, {"orientation", turn}};
}

/// A room of 4 x 3 x 4 m, seen from within: 8 vertices, 12 triangles, moved up by its frame so that y starts at 0; its
/// floor, ceiling and a thin box before one wall are labelled.
json room() {
    std::vector<float> places;
    for (int i = 0; i < 8; ++i)
        for (const float v : {i & 1 ? 2.0f : -2.0f, i & 2 ? 1.5f : -1.5f, i & 4 ? 2.0f : -2.0f}) places.push_back(v);
    const std::vector<std::uint32_t> indices = {0, 1, 2, 1, 3, 2, 4, 6, 5, 5, 6, 7, 0, 2, 4, 2, 6, 4,
                                                1, 5, 3, 3, 5, 7, 0, 4, 1, 1, 4, 5, 2, 3, 6, 3, 7, 6};
    const double half = std::sqrt(0.5);
    const json upright = {{"x", half}, {"y", 0}, {"z", 0}, {"w", half}};  // the plane's normal, y, becomes z
    return {{"type", "scene"},
            {"version", 1},
            {"spatialEntities",
             {{{"semanticLabel_META", "GLOBAL_MESH"},
               {"locatable_META", place(0, 1.5, 0)},
               {"triangleMesh_META", {{"vertices", base64(places)}, {"indices", base64(indices)}}}},
              {{"semanticLabel_META", "FLOOR"},
               {"locatable_META", place(0, 0.02, 0)},
               {"bounded2D_META", {{"offset", {{"x", -2}, {"y", -2}}}, {"extent", {{"width", 4}, {"height", 4}}}}}},
              {{"semanticLabel_META", "WALL_FACE"},
               {"locatable_META", place(0, 1.5, -2, upright)},
               {"bounded2D_META", {{"offset", {{"x", -2}, {"y", -1.5}}}, {"extent", {{"width", 4}, {"height", 3}}}}}},
              {{"semanticLabel_META", "DOOR_FRAME"},
               {"locatable_META", place(2, 1.5, 0)},
               {"bounded3D_META",
                {{"offset", {{"x", -0.1}, {"y", -1.5}, {"z", -2}}},
                 {"extent", {{"width", 0.2}, {"height", 3}, {"depth", 4}}}}}}}}};
}

using RoomCaptureTest = SceneFiles;

TEST_F(RoomCaptureTest, IsANodeAndAMaterialALabel) {
    const SceneDescription scene = read(room().dump());
    std::map<std::string, std::size_t> triangles;
    for (const SceneNode& node : scene.nodes) {
        triangles[node.name] = scene.meshes[static_cast<std::size_t>(node.mesh)].mesh.triangles.size();
        EXPECT_EQ(scene.materials[static_cast<std::size_t>(node.material)].name, node.name);
    }
    EXPECT_EQ(triangles,
              (std::map<std::string, std::size_t>{{"FLOOR", 2}, {"WALL_FACE", 2}, {"DOOR_FRAME", 2}, {"OTHER", 6}}));
    for (const SceneMesh& mesh : scene.meshes) {
        if (mesh.name != "FLOOR") continue;
        for (const glm::vec3& n : mesh.mesh.normals) EXPECT_NEAR(n.y, 1, 1e-6) << "of its own triangles, into the room";
        for (const glm::vec3& p : mesh.mesh.positions) EXPECT_NEAR(p.y, 0, 1e-6) << "moved by the frame";
    }
}

TEST_F(RoomCaptureTest, HasALampAndACameraWithinItWhenLookedAtAlone) {
    const SceneDescription scene = read(room().dump());
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_TRUE(scene.lights[0].area && scene.lights[0].shadow);
    EXPECT_LT(scene.lights[0].light.position.y, 3);
    EXPECT_GT(scene.lights[0].light.position.y, 2);
    const Vec3 eye = scene.camera.eye;
    EXPECT_LT(std::max(std::abs(eye.x), std::abs(eye.z)), 2);
    EXPECT_GT(eye.y, 1);
    EXPECT_LT(eye.y, 2.5);
}

TEST_F(RoomCaptureTest, NodesOfScenesImportIt) {
    write("room.json", room().dump());
    const SceneDescription scene =
        read(sceneText(R"("nodes": {"here": {"import": "room.json", "translation": [10, 0, 0]}},
                          "lights": {"l": {"type": "point", "position": [10, 2, 0], "intensity": 3}})"));
    EXPECT_EQ(scene.lights.size(), 1u) << "none of the room's";
    EXPECT_EQ(scene.nodes.size(), 5u);
    EXPECT_GT(scene.camera.eye.x, 8) << "the room's camera, where it is placed";
}

TEST_F(RoomCaptureTest, TellsWhatIsWrong) {
    const auto with = [&](const std::function<void(json&)>& change) {
        json document = room();
        change(document["spatialEntities"]);
        return errorOf(document.dump());
    };
    EXPECT_THAT(with([](json& e) { e[0]["triangleMesh_META"]["vertices"] = "AAA*"; }),
                HasSubstr("/spatialEntities/0/triangleMesh_META/vertices: expected base64, found another sign at 3"));
    EXPECT_THAT(with([](json& e) { e[0]["triangleMesh_META"]["vertices"] = "AAAA===="; }),
                HasSubstr("more than two signs of padding"));
    EXPECT_THAT(with([](json& e) {
                    e[0]["triangleMesh_META"]["vertices"] = base64<float>({0, 1});
                }),
                HasSubstr("expected three numbers a vertex, found 2"));
    EXPECT_THAT(with([](json& e) {
                    e[0]["triangleMesh_META"]["vertices"] = base64<std::uint8_t>({0, 1, 2});
                }),
                HasSubstr("found 3 bytes"));
    EXPECT_THAT(with([](json& e) {
                    e[0]["triangleMesh_META"]["indices"] = base64<std::uint32_t>({0, 1, 8});
                }),
                HasSubstr("expected indices below 8, found 8"));
    EXPECT_THAT(with([](json& e) {
                    e[0]["triangleMesh_META"]["indices"] = base64<std::uint32_t>({0, 1});
                }),
                HasSubstr("expected three indices a triangle, found 2"));
    EXPECT_THAT(with([](json& e) {
                    e[0]["triangleMesh_META"]["vertices"] = base64<float>({0, 0, 0, INFINITY, 0, 0, 0, 1, 0});
                }),
                HasSubstr("expected finite numbers, found others in vertex 1"));
    EXPECT_THAT(with([](json& e) { e[0]["locatable_META"]["orientation"]["w"] = 2; }),
                HasSubstr("expected a quaternion of length 1, found length 2"));
    EXPECT_THAT(with([](json& e) { e[1].erase("semanticLabel_META"); }), HasSubstr("semanticLabel_META"));
    EXPECT_THAT(with([](json& e) { e[1]["bounded2D_META"]["extent"]["width"] = -1; }), HasSubstr("extent/width"));
    EXPECT_THAT(with([](json& e) { e.erase(0); }), HasSubstr("expected triangles, found none with area"));
    EXPECT_THAT(errorOf(R"({"spatialEntities": 3})"), HasSubstr("/spatialEntities"));
}

}  // namespace
}  // namespace nacre
