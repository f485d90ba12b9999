#include "bench/materials.hpp"

#include <gtest/gtest.h>

#include <set>

#include "bench/gpu_lab.hpp"

using namespace nacre;
using namespace nacre::bench;

TEST(BenchMaterials, ModelsNeedNoFilesAndAllOpen) {
    const MaterialList list = benchMaterials({.shared = "no such folder", .cache = "none"});
    std::set<std::string> names;
    std::set<Group> groups;
    for (const Material& m : list.materials) {
        names.insert(m.name);
        groups.insert(m.group);
        const OpenMaterial opened = open(m);
        EXPECT_TRUE(opened.reflectance.f && opened.truth) << m.name;
        EXPECT_EQ(opened.reflectance.isotropic, m.group != Group::Anisotropic) << m.name;
    }
    EXPECT_EQ(names.size(), list.materials.size());
    EXPECT_EQ(groups.size(), 4u);
    EXPECT_EQ(list.notes.size(), 2u);  // no tables, no RGL files: said
}

TEST(BenchMaterials, QuickRunsTakeFewOfEachGroup) {
    const auto count = [](bool quick) {
        return benchMaterials({.shared = "none", .cache = "none", .quick = quick}).materials.size();
    };
    EXPECT_LT(count(true), count(false));
}

TEST(BenchMaterials, NamesChooseAndUnknownOnesAreRefused) {
    const auto list = benchMaterials({.shared = "none", .cache = "none", .quick = true, .only = {"Schlick 0.04"}});
    ASSERT_EQ(list.materials.size(), 1u);
    EXPECT_EQ(list.materials[0].name, "Schlick 0.04");
    try {
        benchMaterials({.shared = "none", .cache = "none", .only = {"gold"}});
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("Torrance-Sparrow 0.1"), std::string::npos) << error.what();
    }
}

TEST(BenchMaterials, DeviationPairsReachTheHorizon) {
    int grazing = 0;
    for (const DirectionPair& p : deviationPairs(1000)) {
        EXPECT_GE(std::min(p.wi.z, p.wo.z), 0);
        grazing += std::min(p.wi.z, p.wo.z) < 0.035;
    }
    EXPECT_GT(grazing, 150);
}
