#include "demos/recipe.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "core/error.hpp"
#include "demos/stage.hpp"

namespace nacre {
namespace {

const std::filesystem::path kNowhere = "/nonexistent-nacre-folder";

TEST(Recipe, IdsAreUniqueAndEverySourceIsKnown) {
    std::set<std::string> ids;
    for (const Recipe& r : galleryRecipes(kNowhere)) {
        EXPECT_TRUE(ids.insert(r.id).second) << r.id;
        if (r.source.rfind("micro:", 0) == 0) continue;  // simulates for a second
        EXPECT_NO_THROW(openReflectance(r.source)) << r.id;
    }
    EXPECT_GE(ids.size(), 16u);  // figures 2 to 4 and six fits
}

TEST(Recipe, CommandSaysEveryOptionOfTheBake) {
    Recipe r;
    r.id = "a";
    r.source = "sgd:gold-paint";
    EXPECT_EQ(bakeCommand(r), "nacre factorize sgd:gold-paint -o a.exr");
    r.source = "my file.bsdf";
    r.bake.method = "fit";
    r.bake.size = 32;
    r.bake.terms = 2;
    r.bake.format = TexelFormat::Unorm8;
    r.bake.maxBytes = 9216;
    r.bake.maxFetches = 2;
    EXPECT_EQ(
        bakeCommand(r),
        "nacre factorize 'my file.bsdf' -o a.exr --method fit --size 32 --terms 2 --format unorm8 --max-bytes 9216 "
        "--max-fetches 2");
}

TEST(Recipe, ShellQuoting) {
    EXPECT_EQ(shellQuoted("ggx:alphax=0.1,kd=0.2/0.3/0.4"), "ggx:alphax=0.1,kd=0.2/0.3/0.4");
    EXPECT_EQ(shellQuoted("it's"), "'it'\\''s'");
    EXPECT_EQ(shellQuoted("$HOME"), "'$HOME'");
    EXPECT_EQ(shellQuoted(""), "''");
}

TEST(Recipe, MeasuredFilesOfAFolderBecomeEntries) {
    const std::filesystem::path folder = testing::TempDir() + "nacre_recipe_test";
    std::filesystem::create_directories(folder);
    for (const char* name : {"B_red.bsdf", "a.binary", "notes.txt"}) std::ofstream(folder / name) << "x";
    const std::size_t without = galleryRecipes(kNowhere).size();
    const std::vector<Recipe> list = galleryRecipes(folder);
    std::filesystem::remove_all(folder);
    ASSERT_EQ(list.size(), without + 2);
    EXPECT_EQ(list[without].id, "rgl-b-red");
    EXPECT_EQ(list[without + 1].id, "merl-a");
}

TEST(Stage, EveryRecipesStageOpensWithoutFetchedMeshes) {
    for (const Recipe& r : galleryRecipes(kNowhere)) {
        const Stage stage = openStage(r.stage, kNowhere);
        EXPECT_FALSE(stage.mesh.triangles.empty()) << r.stage;
        EXPECT_FALSE(stage.lights.empty()) << r.stage;
        EXPECT_EQ(stage.note.empty(), r.stage.rfind("scan:", 0) != 0) << r.stage;
        for (const Light& light : stage.lights) {
            EXPECT_NEAR(light.directional ? length(light.position) : 1, 1, 1e-12) << r.stage;
        }
    }
}

TEST(Stage, UnknownNamesAreRefusedAndBrokenMeshesAreErrors) {
    EXPECT_THROW(openStage("torso", kNowhere), std::invalid_argument);
    EXPECT_THROW(openStage("scan:unicorn", kNowhere), std::invalid_argument);
    const std::filesystem::path folder = testing::TempDir() + "nacre_stage_test";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "camel.off") << "OFF\n3 1";
    EXPECT_THROW(openStage("scan:camel", folder), Error);
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace nacre
