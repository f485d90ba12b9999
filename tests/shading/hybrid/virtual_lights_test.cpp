// Elements, what they reflect, and the lights that stand for them: against closed forms.
#include "shading/hybrid/virtual_lights.hpp"

#include <gmock/gmock.h>

#include "../gpu_evaluate.hpp"
#include "core/error.hpp"
#include "hybrid_fixture.hpp"
#include "shading/hybrid/reflected_power.hpp"

namespace nacre {
namespace {

SceneElements elementsOf(const SceneDescription& scene, const ElementOptions& options = {}) {
    return sceneElements(scene, nodeTransforms(scene, 0), test::albedos(scene), options);
}

std::vector<Rgb> powerOf(const SceneDescription& scene, const SceneElements& elements) {
    test::context();
    ProgramLoader loader;
    return reflectedPower(loader, GpuElements(elements), elements, scene, nodeTransforms(scene, 0));
}

double total(const std::vector<Rgb>& power) {
    double out = 0;
    for (const Rgb& p : power) out += p.g;
    return out;
}

TEST(SceneElements, HaveNearlyEqualAreasThatAddUp) {
    SceneDescription scene = test::emptyRoom();
    test::addSquare(scene, 1, {0, 0, 0}, {0, 0, 1});
    test::addSquare(scene, 0.5, {0, 3, 0}, {0, -1, 0});
    const SceneElements out = elementsOf(scene, {.least = 1000});
    double area = 0;
    for (const SceneElement& e : out.elements) {
        area += e.area;
        EXPECT_LE(e.area, 5.0 / 1000);
        EXPECT_GT(e.area, 0.5 * 5.0 / 1000);
        EXPECT_NEAR(glm::dot(e.normal, e.node == 0 ? Vec3(0, 0, 1) : Vec3(0, -1, 0)), 1, 1e-6);
    }
    EXPECT_NEAR(area, 5, 1e-5);
    EXPECT_EQ(out.corners.size(), 3 * out.elements.size());
}

TEST(SceneElements, MoreThanAnItemBufferHasBitsForAreReported) {
    SceneDescription scene = test::emptyRoom();
    test::addSquare(scene, 1, {0, 0, 0}, {0, 0, 1});
    EXPECT_EQ(elementsOf(scene, {.least = 128, .bits = 8}).elements.size(), 128u);
    try {
        elementsOf(scene, {.least = 256, .bits = 8});
        FAIL() << "256 elements and nothing don't fit into 8 bits";
    } catch (const Error& e) {
        EXPECT_STREQ(e.what(), "item buffer: expected at most 255 elements, which 8 bits tell apart, found 256");
    }
}

TEST(ReflectedPower, OfAPointLightIsItsSolidAngle) {
    SceneDescription scene = test::emptyRoom();
    test::addSquare(scene, 1, {0, 0, 0}, {0, 0, 1});
    test::addLight(scene, {false, {0, 0, 1}, Rgb(3), {}});
    const SceneElements elements = elementsOf(scene);
    EXPECT_NEAR(total(powerOf(scene, elements)), 0.5 * 3 * 4 * kPi / 6, 1e-3);
    scene.nodes[0].translation.z = 2;  // the light is behind
    EXPECT_EQ(total(powerOf(scene, elementsOf(scene))), 0) << "all polygons face away";
}

TEST(ReflectedPower, OfASunIsTheAreaItSees) {
    SceneDescription scene = test::emptyRoom();
    test::addSquare(scene, 1, {0, 0, 0}, {0, 0, 1});
    test::addLight(scene, {true, {0.6, 0, 0.8}, Rgb(2), {}});
    EXPECT_NEAR(total(powerOf(scene, elementsOf(scene))), 0.5 * 2 * 4 * 0.8, 0.02) << "a pixel's area is 1.2e-4";
    test::addSquare(scene, 1, {0.6, 0, 0.8}, {0, 0, 1});  // in the light's way, as large, and takes half of it
    EXPECT_NEAR(total(powerOf(scene, elementsOf(scene))), 0.5 * 2 * 0.8 * 4 * 1.0, 0.05);
}

TEST(ReflectedPower, OfASpotFadesWithItsCone) {
    SceneDescription scene = test::emptyRoom();
    test::addSquare(scene, 4, {0, 0, 0}, {0, 0, 1});
    test::addLight(scene, {false, {0, 0, 2}, Rgb(1), SpotCone{{0, 0, -1}, 0.3, 0.6}});
    // ∫ share dω: 2π (1 − cos 0.3) inside, and of the ramp ((c − a)/(b − a))² from a = cos 0.6 to b = cos 0.3 a third
    const double a = std::cos(0.6), b = std::cos(0.3), expected = 2 * kPi * ((1 - b) + (b - a) / 3);
    EXPECT_NEAR(total(powerOf(scene, elementsOf(scene))), 0.5 * expected, 2e-3 * expected);
}

TEST(ReflectedPower, OfZeroReflectanceAndOfAnEmptyRoomIsNothing) {
    SceneDescription scene = test::emptyRoom();
    const int black = test::addWhite(scene, 0);
    test::addLight(scene, {false, {0, 0, 1}, Rgb(3), {}});
    const SceneElements none = elementsOf(scene);
    EXPECT_TRUE(none.elements.empty());
    EXPECT_TRUE(chooseVirtualLights(none, powerOf(scene, none), 8, VirtualLightChoice::Grouped).lights.empty());
    test::addSquare(scene, 1, {0, 0, 0}, {0, 0, 1}, black);
    const SceneElements dark = elementsOf(scene);
    for (const VirtualLightChoice choice : {VirtualLightChoice::Grouped, VirtualLightChoice::Strongest}) {
        const VirtualLights lights = chooseVirtualLights(dark, powerOf(scene, dark), 8, choice);
        EXPECT_TRUE(lights.lights.empty());
        EXPECT_EQ(lights.leftOut, 0);
    }
}

TEST(ReflectedPower, OfALightInsideAnObjectStaysInside) {
    SceneDescription scene = test::emptyRoom();
    test::addSquare(scene, 4, {0, -2, 0}, {0, 1, 0});
    for (const Vec3& side :
         {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)})
        test::addSquare(scene, 1, side, side);
    test::addLight(scene, {false, {0.2, 0.1, 0}, Rgb(3), {}});
    EXPECT_EQ(total(powerOf(scene, elementsOf(scene))), 0) << "walls are seen from their backs, the floor isn't seen";
}

TEST(VirtualLights, StrongestAreThePartialSortAndSayWhatIsLeftOut) {
    SceneDescription scene = test::emptyRoom();
    test::addSquare(scene, 1, {0, 0, 0}, {0, 0, 1});
    const SceneElements elements = elementsOf(scene, {.least = 8});
    ASSERT_EQ(elements.elements.size(), 8u);
    const std::vector<Rgb> power{Rgb(1), Rgb(7), Rgb(0), Rgb(3), Rgb(5), Rgb(2), Rgb(1), Rgb(1)};
    const VirtualLights out = chooseVirtualLights(elements, power, 3, VirtualLightChoice::Strongest);
    ASSERT_EQ(out.lights.size(), 3u);
    EXPECT_EQ(out.lights[0].power, Rgb(7));
    EXPECT_EQ(out.lights[1].power, Rgb(5));
    EXPECT_EQ(out.lights[2].power, Rgb(3));
    EXPECT_EQ(out.lights[1].position, elements.elements[4].centre);
    EXPECT_NEAR(out.leftOut, 5.0 / 20, 1e-12);
    EXPECT_EQ(chooseVirtualLights(elements, power, 100, VirtualLightChoice::Strongest).lights.size(), 7u);
}

TEST(VirtualLights, GroupsKeepAllPowerAndDontMixWalls) {
    SceneDescription scene = test::emptyRoom();
    test::addSquare(scene, 1, {0, 0, 0}, {0, 0, 1});
    test::addSquare(scene, 1, {1, 0, 1}, {-1, 0, 0});
    const SceneElements elements = elementsOf(scene, {.least = 512});
    std::vector<Rgb> power(elements.elements.size(), Rgb(0));
    double all = 0, area = 0;
    for (std::size_t i = 0; i < power.size(); ++i) {
        power[i] = Rgb(1 + static_cast<double>(i % 7), 1, 2);
        all += power[i].r, area += elements.elements[i].area;
    }
    for (const int count : {1, 2, 37, 100000}) {
        const VirtualLights out = chooseVirtualLights(elements, power, count, VirtualLightChoice::Grouped);
        EXPECT_EQ(out.lights.size(), std::min<std::size_t>(static_cast<std::size_t>(count), elements.elements.size()));
        double sum = 0, areas = 0;
        for (const VirtualPointLight& l : out.lights) {
            sum += l.power.r, areas += l.area();
            const bool floor = l.normal.z > 0.9;
            EXPECT_NEAR(floor ? l.position.z : l.position.x, floor ? 0 : 1, 1e-6) << "on its surface";
        }
        EXPECT_NEAR(sum, all, 1e-9 * all);
        EXPECT_NEAR(areas, area, 1e-6);
        EXPECT_EQ(out.leftOut, 0);
    }
}

VirtualPointLight squareLight(double half, double height) {
    return {{0, 0, height}, {0, 0, -1}, {0, 0, height}, {half, 0, 0}, {0, -half, 0}, Rgb(1)};
}

TEST(VirtualLights, NearByARectangleHasLambertsFormFactorAndADiskItsOwn) {
    for (const double height : {1e-3, 0.3, 0.9}) {
        // power Φ, radiance Φ/(π A), irradiance of a form factor F: Φ F / A; ours is Φ/π · x
        const VirtualPointLight light = squareLight(0.25, height);
        const double area = 0.25, x = 0.25 / height,
                     factor = 4 / kPi * x / std::sqrt(1 + x * x) * std::atan(x / std::sqrt(1 + x * x));
        const Vec2 rectangle = virtualLightGeometry(light, Vec3(0), {0, 0, 1}, NearLight::Rectangle);
        EXPECT_NEAR(rectangle.x * area / kPi, factor, 1e-9) << height;
        EXPECT_NEAR(rectangle.y * height * height, 1, 1e-9);
        const Vec2 disk = virtualLightGeometry(light, Vec3(0), {0, 0, 1}, NearLight::Disk);
        EXPECT_NEAR(disk.x * area / kPi, area / kPi / (height * height + area / kPi), 1e-9);
    }
    // in the corner between the rectangle and a wall
    const VirtualPointLight wall = squareLight(1, 1);
    const Vec2 corner = virtualLightGeometry(wall, {1 - 1e-9, 0, 1e-9}, {-1, 0, 0}, NearLight::Rectangle);
    EXPECT_GT(corner.x, 0);
    EXPECT_LT(corner.x * 4 / kPi, 0.5) << "less than half of what the point sees";
}

TEST(VirtualLights, FarAwayAllShapesAreAPoint) {
    const VirtualPointLight light = squareLight(0.1, 5);
    for (const NearLight near : {NearLight::Point, NearLight::Disk, NearLight::Rectangle})
        EXPECT_NEAR(virtualLightGeometry(light, Vec3(0), {0, 0, 1}, near).x, 1.0 / 25, 1e-3 / 25);
}

TEST(VirtualLights, GiveNothingBehindThemBehindTheReceiverAndOnThePointItself) {
    for (const NearLight near : {NearLight::Point, NearLight::Disk, NearLight::Rectangle}) {
        const VirtualPointLight light = squareLight(0.5, 1);
        EXPECT_EQ(virtualLightGeometry(light, Vec3(0), {0, 0, -1}, near).x, 0) << "behind the receiver";
        EXPECT_EQ(virtualLightGeometry(light, {0, 0, 2}, {0, 0, -1}, near).x, 0) << "behind the light";
        EXPECT_EQ(virtualLightGeometry(light, {0, 0, 1}, {0, 0, 1}, near).x, 0) << "on the shaded point itself";
    }
}

}  // namespace
}  // namespace nacre
