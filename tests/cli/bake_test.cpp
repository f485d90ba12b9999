// nacre bake and nacre info of scenes, from outside: what is baked, skipped, failed; kills, and files that change.
#include <gmock/gmock.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/file.hpp"
#include "tests/cli/process.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using tests::contents;
using tests::nacre;
using tests::Outcome;
using tests::Scratch;

class Bake : public ::testing::Test {
protected:
    static json recipe(const std::string& source, json options = {{"--size", 4}}) {
        return {{"verb", "factorize"}, {"source", source}, {"options", std::move(options)}};
    }
    std::string write(const json& assets) const {
        writeFile(scratch_ / "m.json", json{{"nacre_scene", 1}, {"assets", assets}}.dump());
        return (scratch_ / "m.json").string();
    }
    /// Three small ones, one of them in a folder that isn't there.
    std::string three() const {
        return write(
            {{"a", {{"file", "a.exr"}, {"bake", recipe("lambert")}}},
             {"b", {{"file", "deep/er/b.exr"}, {"bake", recipe("phong:n=3")}}},
             {"f",
              {{"file", "f.exr"}, {"bake", {{"verb", "fresnel"}, {"options", {{"--eta", 1.4}, {"--size", 8}}}}}}}});
    }
    json report(std::vector<std::string> arguments, int code = 0) {
        arguments.insert(arguments.begin(), "bake");
        arguments.push_back("--json");
        const Outcome outcome = nacre(arguments);
        EXPECT_EQ(outcome.code, code) << outcome.err;
        err_ = outcome.err;
        return json::parse(outcome.out, nullptr, false);
    }

    Scratch scratch_;
    std::string err_;
};

TEST_F(Bake, BakesOnceAndThenSkips) {
    const std::string manifest = three();
    const json first = report({manifest, "--jobs", "2"});
    EXPECT_EQ(first["baked"], 3);
    EXPECT_GT(first["assets"]["b"]["bytes"], 0);
    EXPECT_EQ(first["assets"]["f"]["why"], "missing");
    EXPECT_THAT(contents(scratch_ / "f.exr"), HasSubstr("--eta 1.4"));
    const json second = report({manifest});
    EXPECT_EQ(second["up_to_date"], 3);
    EXPECT_EQ(second["baked"], 0);
    EXPECT_EQ(report({manifest, "--force"})["baked"], 3);
    EXPECT_EQ(report({manifest, "--force", "--only", "a"})["assets"].size(), 1u);
}

TEST_F(Bake, ChangesAreSeen) {
    report({three()});
    writeFile(scratch_ / "a.exr", contents(scratch_ / "f.exr"));
    const std::string manifest = write({{"a", {{"file", "a.exr"}, {"bake", recipe("lambert")}}},
                                        {"b", {{"file", "deep/er/b.exr"}, {"bake", recipe("phong:n=4")}}}});
    const json planned = report({manifest, "--dry-run"});
    EXPECT_EQ(planned["to_bake"], 2);
    EXPECT_THAT(planned["assets"]["a"]["why"], HasSubstr("after it was baked"));
    EXPECT_THAT(planned["assets"]["b"]["why"], HasSubstr("recipe"));
    EXPECT_EQ(report({manifest})["baked"], 2);
    EXPECT_EQ(report({manifest})["up_to_date"], 2);
}

TEST_F(Bake, AFolderThatMovesStaysBaked) {
    std::filesystem::create_directories(scratch_ / "x");
    writeFile(scratch_ / "x/s.csv", "theta_i,phi_i,theta_o,phi_o,r,g,b\n");
    std::ofstream samples(scratch_ / "x/s.csv", std::ios::app);
    for (double t = 0.1; t < 1.5; t += 0.35)
        for (double u = 0.1; u < 1.5; u += 0.35)
            for (double p = 0; p < 3.2; p += 0.6) samples << t << ",0," << u << ',' << p << ",0.2,0.3,0.4\n";
    samples.close();
    writeFile(scratch_ / "x/m.json", json{{"assets", {{"s", {{"file", "s.exr"}, {"bake", recipe("s.csv")}}}}}}.dump());
    ASSERT_EQ(report({(scratch_ / "x/m.json").string()})["baked"], 1) << err_;
    std::filesystem::rename(scratch_ / "x", scratch_ / "y");
    EXPECT_EQ(report({(scratch_ / "y/m.json").string()})["up_to_date"], 1);
    std::ofstream(scratch_ / "y/s.csv", std::ios::app) << "0.2,0,0.3,0.1,0.2,0.3,0.4\n";
    EXPECT_EQ(report({(scratch_ / "y/m.json").string()})["baked"], 1) << "a source that changed";
}

TEST_F(Bake, OneBadAssetAmongGoodFailsAlone) {
    const std::string manifest =
        write({{"a", {{"file", "a.exr"}, {"bake", recipe("lambert")}}},
               {"bad", {{"file", "bad.exr"}, {"bake", recipe("no-such-model")}}},
               {"gone", {{"file", "gone.exr"}}},
               {"lost", {{"file", "lost.exr"}, {"bake", {{"verb", "bump"}, {"source", "no.png"}}}}},
               {"z", {{"file", "z.exr"}, {"bake", recipe("phong:n=2")}}}});
    const json result = report({manifest}, 1);
    EXPECT_EQ(result["baked"], 2);
    EXPECT_EQ(result["failed"], 3);
    EXPECT_THAT(result["assets"]["bad"]["message"], HasSubstr("no-such-model"));
    EXPECT_THAT(result["assets"]["lost"]["message"], HasSubstr("no.png: expected a file, found none"));
    EXPECT_THAT(err_, HasSubstr("nacre: bad: "));
    EXPECT_THAT(err_, HasSubstr("3 of 5 assets failed"));
    EXPECT_TRUE(std::filesystem::exists(scratch_ / "z.exr"));
    EXPECT_EQ(report({manifest}, 1)["up_to_date"], 2);
}

TEST_F(Bake, WhatIsMadeFromAnotherWaitsForIt) {
    const json convert = {{"verb", "envmap"}, {"options", {{"--convert", true}, {"--size", 2}, {"--layout", "cube"}}}};
    const auto from = [&](const std::string& source) {
        json out = convert;
        out["source"] = source;
        return out;
    };
    std::ofstream(scratch_ / "sky.pfm", std::ios::binary) << "PF\n4 2\n-1\n" << std::string(4 * 2 * 12, '\0');
    const std::string manifest = write({{"a", {{"file", "a.exr"}, {"bake", from("b.exr")}}},
                                        {"b", {{"file", "b.exr"}, {"bake", from("sky.pfm")}}},
                                        {"x", {{"file", "x.exr"}, {"bake", from("y.exr")}}},
                                        {"y", {{"file", "y.exr"}, {"bake", from("x.exr")}}}});
    const json result = report({manifest, "--only", "a"});
    EXPECT_EQ(result["baked"], 2) << err_;
    EXPECT_EQ(report({manifest}, 1)["failed"], 2);
    EXPECT_THAT(err_, HasSubstr("made from itself"));
}

TEST_F(Bake, KilledHalfWayThenResumed) {
    json assets;
    for (int i = 0; i < 12; ++i)
        assets["m" + std::to_string(i)] = {{"file", "m" + std::to_string(i) + ".exr"},
                                           {"bake", recipe("phong:n=" + std::to_string(i + 2), {{"--size", 32}})}};
    const std::string manifest = write(assets);
    const auto done = [&] {
        int out = 0;
        for (int i = 0; i < 12; ++i)
            out += std::filesystem::exists(scratch_ / ("m" + std::to_string(i) + ".exr.bake.json"));
        return out;
    };
    Scratch io;
    const pid_t child = tests::start({"bake", manifest, "--jobs", "2"}, {}, io);
    while (done() < 3) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    ::kill(child, SIGKILL);
    EXPECT_EQ(tests::waitFor(child), 128 + SIGKILL);
    const int before = done();
    // What a process that is gone may have been writing, and what one that lives or somebody else has there.
    const std::string record = "m9.exr.bake.json.", dead = std::to_string(child) + ".tmp";
    const std::string alive = std::to_string(::getpid()) + ".tmp";
    for (const std::string& name : {record + dead, record + alive, "m9.exr." + dead, std::string("other.exr." + dead)})
        writeFile(scratch_ / name, "half");
    EXPECT_LT(before, 12) << "killed too late to say anything";
    const json result = report({manifest});
    EXPECT_GE(result["up_to_date"], before);
    EXPECT_GT(result["baked"], 0);
    EXPECT_EQ(result["failed"], 0);
    EXPECT_EQ(report({manifest})["up_to_date"], 12);
    EXPECT_TRUE(std::filesystem::remove(scratch_ / (record + alive)));
    EXPECT_TRUE(std::filesystem::remove(scratch_ / ("other.exr." + dead)));
    for (const auto& entry : std::filesystem::directory_iterator(scratch_.folder()))
        EXPECT_THAT(entry.path().string(), ::testing::AnyOf(::testing::EndsWith(".exr"), ::testing::EndsWith(".json")))
            << "nothing half-written is left";
}

TEST_F(Bake, WrongManifestsAndUsage) {
    EXPECT_EQ(nacre({"bake"}).code, 2);
    EXPECT_EQ(nacre({"bake", (scratch_ / "no.json").string()}).code, 1);
    writeFile(scratch_ / "n.json", R"({"meshes": {}})");
    const Outcome none = nacre({"bake", (scratch_ / "n.json").string()});
    EXPECT_EQ(none.code, 1);
    EXPECT_THAT(none.err, HasSubstr("n.json: /: expected the key \"assets\""));
    const Outcome only = nacre({"bake", three(), "--only", "c"});
    EXPECT_EQ(only.code, 2);
    EXPECT_THAT(only.err, HasSubstr("no asset named 'c'; there are a, b, f"));
    const std::string wrong = write({{"a", {{"file", "a.exr"}, {"bake", {{"verb", "boil"}}}}}});
    EXPECT_THAT(nacre({"bake", wrong}).err,
                HasSubstr("/assets/a/bake/verb: expected one of factorize, envmap, fresnel, bump"));
}

TEST_F(Bake, ScenesThatASceneImportsBelongToIt) {
    three();
    writeFile(scratch_ / "outer.json",
              R"({"nacre_scene": 1, "assets": {}, "nodes": {"n": {"import": "m.json"}, "o": {"import": "m.json"}}})");
    const json result = report({(scratch_ / "outer.json").string()});
    EXPECT_EQ(result["baked"], 3);
    EXPECT_TRUE(result["assets"].contains("n/a"));
}

TEST_F(Bake, InfoShowsASceneAndItsAssets) {
    json scene = json::parse(R"({"nacre_scene": 1, "meshes": {"q": {"quad": {"steps": 2}}},
        "materials": {"m": {"brdf": "a"}}, "nodes": {"n": {"mesh": "q", "material": "m"}, "o": {"mesh": "q", "material": "m"}},
        "lights": {"l": {"type": "spot", "shadow": true}}})");
    scene["assets"] = {{"a", {{"file", "a.exr"}, {"bake", recipe("lambert")}}}, {"g", {{"file", "m.json"}}}};
    const std::string path = write({});
    writeFile(path, scene.dump());
    const auto info = [&] { return json::parse(nacre({"info", path, "--json"}).out); };
    EXPECT_EQ(info()["triangles"], 16);
    EXPECT_EQ(info()["instances"], 2);
    EXPECT_EQ(info()["materials"][0]["uses"]["brdf"], "a");
    EXPECT_EQ(info()["lights"][0]["type"], "spot");
    EXPECT_EQ(info()["assets"][0]["state"], "missing");
    EXPECT_EQ(info()["assets"][1]["state"], "given");
    ASSERT_EQ(report({path})["baked"], 1);
    EXPECT_EQ(info()["assets"][0]["state"], "baked");
    std::ofstream(scratch_ / "a.exr", std::ios::app) << "more";
    EXPECT_EQ(info()["assets"][0]["state"], "stale");
    EXPECT_THAT(nacre({"info", path}).out, HasSubstr("16 triangles in 2 instances of 1 meshes"));
    writeFile(scratch_ / "t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(json::parse(nacre({"info", (scratch_ / "t.obj").string(), "--json"}).out)["triangles"], 1);
}

}  // namespace
}  // namespace nacre
