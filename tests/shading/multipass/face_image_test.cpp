// Pictures on faces as projective textures: their maps, and the shader's lookup.
#include "shading/multipass/face_image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../gpu_evaluate.hpp"
#include "core/error.hpp"
#include "core/sampling.hpp"
#include "shading/multipass/projective_map.hpp"
#include "shading/multipass/specular_face.hpp"
#include "shading/texture.hpp"
#include "tests/shading/multipass/specular_fixture.hpp"

namespace nacre {
namespace {

using ::testing::HasSubstr;

std::shared_ptr<Image> picture(int width, int height, std::uint64_t seed = 1) {
    auto out = std::make_shared<Image>(width, height, 4);
    for (std::size_t i = 0; i < out->data().size(); ++i)
        out->data()[i] = static_cast<float>(radicalInverse(seed + i, 2));
    return out;
}

SceneSpecular stained(const std::shared_ptr<const Image>& filter) {
    SceneSpecular out;
    out.ior = 1;
    out.filter = filter;
    return out;
}

Vec2 uvOf(const PlacedImage& image, const Vec3& x) {
    const Vec4 at = image.place * Vec4(x, 1);
    return Vec2(at) / at.z;
}

/// MPR section 4.5: a rectangle whose plane is along no axis, seen by the light; its image on a floor is a
/// quadrilateral, and the picture's coordinates are the map from that to the unit square.
TEST(FaceImage, OnALitPlaneItIsTheMapOfAQuadrilateralToARectangle) {
    test::SpecularScene s;
    s.face("pane", stained(picture(4, 3)), {0.2, 1.5, -0.1}, 0.8, {1, 2, 0.5}, {0.5, 0.3, 1});
    const std::vector<glm::dmat4> nodes = nodeTransforms(s.scene, 0);
    const SpecularFace face = specularFaces(s.scene, nodes).at(0);
    EXPECT_EQ(face.image.rect, glm::vec4(0, 0, 4, 3));
    EXPECT_LT(face.image.off, 1e-6);
    for (const Vec4& light : {Vec4(-0.5, 3, 1, 1), Vec4(glm::normalize(Vec3(-0.3, 1, 0.4)), 0)}) {
        const auto onFloor = [&](const Vec3& p) {
            const Vec3 along = p * light.w - Vec3(light);
            return p - p.y / along.y * along;
        };
        const glm::dmat4& m = nodes[0];
        const auto corner = [&](double x, double y) {
            const Vec3 p = onFloor(Vec3(m * Vec4(x, y, 0, 1)));
            return Vec2(p.x, p.z);
        };
        // The fixture's square: from (-1, -1) to (1, 1), uv from (0, 0) to (1, 1).
        const glm::dmat3 map = glm::inverse(squareToQuad({corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}));
        const PlacedImage image = placedImage(face.image, projectionFrom(light, face.plane));
        for (int i = 0; i < 50; ++i) {
            const Vec3 on(2 * radicalInverse(i, 2) - 1, 0, 2 * radicalInverse(i, 3) - 1);
            const Vec3 uvw = map * Vec3(on.x, on.z, 1);
            EXPECT_LT(glm::length(uvOf(image, on) - Vec2(uvw) / uvw.z), 1e-6);
        }
    }
}

/// Along one ray: a light, a point of a first face, one of a second, what is lit.
TEST(FaceImage, OfTwoFacesInARow) {
    test::SpecularScene s;
    s.face("first", stained(picture(2, 2)), {0, 0, 0}, 0.3);
    s.face("second", stained(picture(2, 2)), {0, 0, -1}, -0.4, {1, 1, 0});
    const std::vector<glm::dmat4> nodes = nodeTransforms(s.scene, 0);
    const std::vector<SpecularFace> faces = specularFaces(s.scene, nodes);
    const Vec4 light(0.3, 0.2, 2, 1);
    const glm::dmat4 second = projectionFrom(light, faces[1].plane);
    const PlacedImage image = placedImage(faces[0].image, projectionFrom(light, faces[0].plane) * second);
    for (const Vec2& uv : {Vec2(0.5, 0.5), Vec2(0.2, 0.9), Vec2(0.8, 0.1)}) {
        const Vec3 p(nodes[0] * Vec4(2.0 * uv - 1.0, 0, 1)), x = Vec3(light) + 2.5 * (p - Vec3(light));
        EXPECT_LT(glm::length(uvOf(image, x) - uv), 1e-6);
    }
}

TEST(FaceImage, PicturesOfAllMaterialsAreOne) {
    test::SpecularScene s;
    s.face("a", stained(picture(4, 3)), {0, 0, 0});
    s.ball(Rgb(1), {0, 0, 0});
    SceneSpecular decal;
    decal.surface = 0.5;
    decal.texture = picture(2, 5, 30);
    s.face("b", decal, {0, 0, 1});
    const std::vector<glm::vec4> rects = faceImageRects(s.scene);
    EXPECT_EQ(rects, (std::vector<glm::vec4>{{0, 0, 4, 3}, glm::vec4(0), {0, 3, 2, 5}}));
    const Image all = faceImages(s.scene);
    EXPECT_EQ(all.width(), 4);
    EXPECT_EQ(all.height(), 8);
    EXPECT_EQ(all.rgb(3, 2), s.scene.materials[0].specular->filter->rgb(3, 2));
    EXPECT_EQ(all.at(3, 2, 3), 0) << "no texture: nothing is kept back";
    EXPECT_EQ(all.rgb(1, 7), Rgb(1)) << "no filter";
    EXPECT_EQ(all.at(1, 7, 3), decal.texture->at(1, 4, 3));
    EXPECT_TRUE(faceImages(SceneDescription()).empty());
}

TEST(FaceImage, RejectsPicturesThatDontFit) {
    test::SpecularScene s;
    s.face("pane", stained(picture(4, 3)), {0, 0, 0});
    s.scene.meshes[0].mesh.uvs[2].x += 0.1f;
    try {
        checkSpecular(s.scene);
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("node 'pane': expected uv that are an affine map of the face"));
    }
    s.scene.meshes[0].mesh.uvs[2].x -= 0.1f;
    EXPECT_NO_THROW(checkSpecular(s.scene));
    s.scene.materials[0].name = "glass";
    s.scene.materials[0].specular->surface = 0.5;
    s.scene.materials[0].specular->texture = picture(4, 4);
    try {
        checkSpecular(s.scene);
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("material 'glass': specular: expected a filter of the texture's size"));
    }
    s.scene.materials[0].specular->filter = std::make_shared<Image>(4, 4, 3);
    EXPECT_THROW(checkSpecular(s.scene), std::invalid_argument);
}

TEST(FaceImage, ShaderFiltersAsTheReference) {
    test::context();
    const std::shared_ptr<const Image> inner = picture(5, 4);
    Image all(9, 11, 4);  // something else around it
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x)
            for (int c = 0; c < 4; ++c) all.at(x + 2, y + 6, c) = inner->at(x, y, c);
    const Texture texture(all);
    std::vector<DirectionPair> pairs;
    for (int i = 0; i < 300; ++i)  // beyond the edges too
        pairs.push_back({Vec3(1.4 * radicalInverse(i, 2) - 0.2, 1.4 * radicalInverse(i, 3) - 0.2, 0), Vec3(0, 0, 1)});
    const std::vector<glm::vec4> got =
        test::gpuEvaluate({.code = "#include \"nacre/face_image.glsl\"\nuniform sampler2D images;\n"
                                   "vec4 evaluate(vec3 wi, vec3 wo) {\n"
                                   "    return nacre_face_image(images, vec4(2.0, 6.0, 5.0, 4.0), wi.xy);\n}\n",
                           .bind =
                               [&](const Program& program) {
                                   texture.bind(2);
                                   program.set("images", 2);
                               }},
                          pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const glm::vec4 want = sampleBilinear(*inner, float(pairs[i].wi.x), float(pairs[i].wi.y));
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(got[i][c], want[c], 1e-5) << i;
    }
}

}  // namespace
}  // namespace nacre
