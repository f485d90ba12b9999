#include "shading/multipass/pass_text.hpp"

#include <gmock/gmock.h>

#include "shading/multipass/light_schedule.hpp"
#include "tests/shading/multipass/specular_fixture.hpp"

namespace nacre {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(PassText, ListsNamePointsAndExplainTheirPasses) {
    test::SpecularScene s;
    s.face("mirror", {}, {0, 0, 0}, 0.2, {0, 1, 0}, Vec3(0.5));
    SceneLight lamp;
    lamp.light = {false, {0, 1, 2}, Rgb(1), {}};
    lamp.area = LightArea{{0.1, 0, 0}, {0, 0.1, 0}};
    lamp.shadow = SceneShadow{};
    s.scene.lights = {lamp};
    SceneSwitches on;
    on.lightPoints = 3;
    on.specular.lightDepth = 1;
    const std::vector<glm::dmat4> nodes = nodeTransforms(s.scene, 0);
    const auto listed = [&](ShadowMethod method) {
        on.shadowMethod = method;
        const std::vector<SpecularFace> faces = specularFaces(s.scene, nodes);
        ScheduleInput input{s.scene.camera, 64, 64, Vec3(-1), Vec3(1), {}};
        input.lights =
            scheduledLights(s.scene, on, shadowedLamps(s.scene, on, nodes, lightsInWorld(s.scene, nodes)), faces);
        return passListText(makeSchedule(faces, input, on.specular), {"mirror"}, {"lamp"});
    };
    const std::string text = listed(ShadowMethod::Volumes);
    EXPECT_THAT(text, AllOf(HasSubstr("1 of lamps, each with all its points, 3 of points' images"),
                            HasSubstr("lamp, 3 points: add where"), HasSubstr("lamp, point 1 of 3 > mirror reflects"),
                            HasSubstr("lamp, point 3 of 3 > mirror reflects"), HasSubstr("\nunmask    the face again"),
                            HasSubstr("lamps with shadows comes after it"), Not(HasSubstr("\nweight "))));
    std::size_t column = 0;  // where the view stands in each row
    for (std::size_t at = text.find("  camera"); at != std::string::npos; at = text.find("  camera", at + 1)) {
        const std::size_t here = at - text.rfind('\n', at);
        if (column == 0) column = here;
        EXPECT_EQ(here, column);
    }
    const std::string maps = listed(ShadowMethod::Maps);
    EXPECT_THAT(maps, AllOf(HasSubstr("0 of lamps"), HasSubstr("lamp > mirror reflects"),
                            HasSubstr("the lamps' own light is in it, shadows by maps")));
    s.scene.lights.clear();
    EXPECT_THAT(listed(ShadowMethod::Volumes), Not(HasSubstr("\nlight ")));
}

}  // namespace
}  // namespace nacre
