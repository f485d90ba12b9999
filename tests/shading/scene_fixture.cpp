#include "scene_fixture.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include "bump/bump_asset.hpp"
#include "envmaps/env_asset.hpp"
#include "envmaps/fresnel_table.hpp"
#include "envmaps/prefilter.hpp"
#include "envmaps/source.hpp"
#include "factorize/factorize.hpp"
#include "factorize/models/models.hpp"
#include "shading/image_output.hpp"
#include "shading/primitives.hpp"

namespace nacre::test {
namespace {

constexpr const char* kGlossyModel = "torrance-sparrow:d=beckmann,alpha=0.3,kd=0.25/0.1/0.05";

Rgb skyFrom(const Vec3& d) { return Rgb(0.5, 0.6, 0.9) * (1.1 + d.y) + (d.x > 0.8 ? Rgb(3, 2, 1) : Rgb(0)); }

EnvMap smallSky() {
    EnvMap map(EnvLayout::LatLong, 32);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) map.image.setRgb(x, y, skyFrom(envTexelDirection(map.layout, 32, x, y)));
    return map;
}

/// Smooth bumps, high enough to shadow each other: 4 × 4 of them, no two rows alike.
HeightMap roundStones() {
    HeightMap map{Image(32, 32, 1), Wrap::Repeat};
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
            const double u = 2 * kPi * (x + 0.5) / 32, v = 2 * kPi * (y + 0.5) / 32;
            map.heights.at(x, y, 0) = static_cast<float>(2 * std::sin(4 * u + 0.7 * std::sin(v)) * std::sin(4 * v));
        }
    return map;
}

void bake(const tests::Scratch& folder) {
    const Reflectance glossy = openReflectance(kGlossyModel);
    Asset brdf = toAsset(factorize(glossy, {.method = "analytic", .size = 64}));
    brdf.meta["source"] = glossy.source;
    writeAsset(brdf, folder / "glossy.exr");

    writeExr(smallSky().image, folder / "sky_source.exr");
    const auto describe = [&folder](Asset asset, const nlohmann::json& lobes) {
        asset.meta["source"] = (folder / "sky_source.exr").string();
        asset.meta["input"] = toJson(readEnvironment(folder / "sky_source.exr").report);
        asset.meta["lobes"] = lobes;
        return asset;
    };
    const PrefilterLevel levels[] = {{{LobeKind::Mirror}, 32}, {{.kind = LobeKind::Phong, .exponent = 40}, 16}};
    EnvChain chain;
    chain.levels = prefilter(smallSky(), levels, {}).levels;
    chain.mapping = LevelMapping{"linear", "exponent", {1e4, 40}};
    writeAsset(describe(toAsset(chain), {{{"lobe", "mirror"}}, {{"lobe", "phong"}, {"exponent", 40}}}),
               folder / "sky.exr");
    const PrefilterLevel diffuse[] = {{{LobeKind::Diffuse}, 8}};
    const EnvChain irradiance(prefilter(smallSky(), diffuse, {}).levels.front());
    writeAsset(describe(toAsset(irradiance), {{{"lobe", "diffuse"}}}), folder / "diffuse.exr");

    Asset fresnel;
    fresnel.kind = "fresnel";
    fresnel.meta["eta"] = {1.5, 1.5, 1.5};
    fresnel.meta["k"] = {0, 0, 0};
    fresnel.textures.push_back(bakeFresnelTable({Rgb(1.5), Rgb(0)}, 64));
    writeAsset(fresnel, folder / "fresnel.exr");

    const HeightMap heights = roundStones();
    BumpMaps maps{32, 32, Wrap::Repeat, {}, {}, {}, {}, {}, {}};
    maps.normals = makeNormals(heights);
    maps.ellipses = fitEllipses(heights);
    maps.horizons = makeHorizonMap(heights, 8);
    maps.scatter = makeScatterMap(heights, {.directions = 48});
    maps.heights = heights.heights;
    writeAsset(toAsset(maps), folder / "wall.exr");
}

SceneNode node(std::string name, int mesh, int material, const Vec3& at, const Vec3& scale = Vec3(1)) {
    SceneNode out;
    out.name = std::move(name);
    out.mesh = mesh;
    out.material = material;
    out.translation = at;
    out.scale = scale;
    return out;
}

glm::dquat aboutX(double angle) { return glm::angleAxis(angle, Vec3(1, 0, 0)); }

}  // namespace

const tests::Scratch& bakedAssets() {
    static const tests::Scratch folder;
    static const bool baked = [] {
        bake(folder);
        return true;
    }();
    static_cast<void>(baked);
    return folder;
}

SceneDescription fullScene() {
    const tests::Scratch& files = bakedAssets();
    SceneDescription scene;
    scene.assets = {{"glossy", files / "glossy.exr", {}, kGlossyModel},
                    {"sky", files / "sky.exr", {}, ""},
                    {"diffuse", files / "diffuse.exr", {}, ""},
                    {"fresnel", files / "fresnel.exr", {}, ""},
                    {"wall", files / "wall.exr", {}, ""}};
    scene.meshes = {
        {"square", makeQuad(4)}, {"ball", makeSphere(0.5f, 48, 24)}, {"torus", makeTorus(0.4f, 0.15f, 40, 24)}};

    SceneMaterial floor, ball, ring;
    floor.name = "floor";
    floor.model = "lambert:kd=0.6";
    floor.ambient = Rgb(0.02);
    floor.relief = SceneRelief{};
    floor.relief->asset = kWall;
    floor.relief->tiles = {3, 3};
    floor.relief->indirectLight = 1;
    floor.relief->paths = 16;
    floor.surrounding = SceneSurrounding{};
    floor.surrounding->diffuse = {kDiffuse, 0, Rgb(0.3)};
    ball.name = "ball";
    ball.brdf = kGlossy;
    ball.surrounding = SceneSurrounding{};
    ball.surrounding->reflection = {kSky, 1, Rgb(1)};
    ball.surrounding->diffuse = {kDiffuse, 0, Rgb(0.2)};
    ball.surrounding->table = kFresnel;
    ring.name = "ring";
    ring.model = "ward:alphax=0.1,alphay=0.4";
    scene.materials = {floor, ball, ring};

    scene.nodes = {node("floor", 0, 0, {0, -0.5, 0}), node("ball", 1, 1, {-0.7, 0, 0.2}),
                   node("torus", 2, 2, {0.8, 0, -0.3}), node("mirrored torus", 2, 2, {0.3, 0.1, 0.9}, {-1, 1, 1})};
    scene.nodes[0].rotation = aboutX(-kPi / 2);
    scene.nodes[2].rotation = aboutX(0.9);
    scene.nodes[3].rotation = aboutX(1.2);
    scene.nodes[3].isStatic = false;
    SceneTrack turn;
    turn.node = 3;
    turn.path = SceneTrack::Path::Rotation;
    for (int i = 0; i <= 4; ++i) {
        const glm::dquat q = glm::angleAxis(i * kPi / 2, Vec3(0, 1, 0)) * aboutX(1.2);
        turn.times.push_back(i);
        turn.values.emplace_back(q.x, q.y, q.z, q.w);
    }
    scene.tracks = {turn};
    scene.duration = 4;

    SceneLight sun, spot;
    sun.name = "sun";
    sun.light = {true, glm::normalize(Vec3(-1, 2, 1)), Rgb(0.8, 0.75, 0.7), {}};
    spot.name = "spot";
    spot.light = {false, {1.2, 2.4, 1.5}, Rgb(14), SpotCone{glm::normalize(Vec3(-1, -2.6, -1.4)), 0.3, 0.5}};
    sun.shadow = spot.shadow = SceneShadow{};
    sun.shadow->size = spot.shadow->size = 256;
    scene.lights = {sun, spot};
    scene.sky.asset = kSky;
    scene.sky.rotationY = 0.7;
    scene.camera.eye = {0.6, 1.6, 3.6};
    scene.camera.target = {0, -0.2, 0};
    scene.camera.fovY = 0.75;
    return scene;
}

}  // namespace nacre::test
