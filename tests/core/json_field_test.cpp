// JSON that people write: what is wrong is named by file and place.
#include "core/json_field.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

using ::testing::HasSubstr;
using tests::messageOf;

const std::string kName = "f.json";

TEST(ParseJson, NamesLineColumnAndDoubles) {
    const auto message = [](const std::string& text) { return messageOf<Error>([&] { parseJson(text, kName); }); };
    EXPECT_THAT(message("[1,\n 2,]"), HasSubstr("f.json: expected JSON, found: parse error at line 2, column 4"));
    EXPECT_THAT(message(R"({"a": [{}, {"b": 1, "c": 2, "b": 3}]})"), HasSubstr("f.json: /a/1/b: "));
    EXPECT_THAT(message(R"({"a": {"b": 1}, "c": {"b": 1}, "a": 2})"), HasSubstr("f.json: /a: "));
    EXPECT_THAT(message("1e999"), HasSubstr("f.json: "));
    EXPECT_THAT(message("\"\xff\""), HasSubstr("f.json: "));
    EXPECT_EQ(parseJson(R"({"a": {"b": 1}, "c": {"b": [1, 2]}})", kName)["c"]["b"][1], 2);
}

TEST(JsonField, ReadersNamePlaceExpectedAndFound) {
    const nlohmann::json document = parseJson(
        R"({"n": -1, "big": 5000000000, "v": [0, 3, 4], "q": [0, 0, 0, 1], "z": [0, 0, 0], "s": "blue", "e": "", "a/b": {"~": true}})",
        kName);
    const JsonField root(document, kName);
    EXPECT_EQ(root.at("n").number(), -1);
    EXPECT_EQ(root.at("v").direction(), Vec3(0, 0.6, 0.8));
    EXPECT_EQ(root.at("v").color(), Rgb(0, 3, 4));
    EXPECT_EQ(root.at("q").quaternion(), Vec4(0, 0, 0, 1));
    EXPECT_EQ(root.at("s").choice({"red", "blue"}), 1);
    EXPECT_EQ(root.at("s").nameIn({"blue", "red"}, "colour"), 0);
    EXPECT_TRUE(root.at("a/b").at("~").flag());
    EXPECT_EQ(root.at("a/b").at("~").path(), "/a~1b/~0");
    EXPECT_FALSE(root.find("nothing"));
    const auto message = [&](auto&& call) { return messageOf<Error>(call); };
    EXPECT_EQ(message([&] { root.at("n").positive(); }), "f.json: /n: expected a number above 0, found -1");
    EXPECT_EQ(message([&] { root.at("n").number(0, 2); }), "f.json: /n: expected a number from 0 to 2, found -1");
    EXPECT_EQ(message([&] { root.at("big").integer(0, 9); }),
              "f.json: /big: expected a whole number 0 to 9, found 5000000000");
    EXPECT_EQ(message([&] { root.at("s").number(); }), "f.json: /s: expected a number, found \"blue\"");
    EXPECT_EQ(message([&] { root.at("e").text(); }), "f.json: /e: expected a text, found \"\"");
    EXPECT_EQ(message([&] { root.at("z").direction(); }), "f.json: /z: expected a direction, found no length");
    EXPECT_EQ(message([&] { root.at("z").quaternion(); }), "f.json: /z: expected an array of 4, found an array of 3");
    EXPECT_EQ(message([&] { root.at("s").choice({"red"}); }), "f.json: /s: expected one of red, found \"blue\"");
    EXPECT_EQ(message([&] { root.at("s").nameIn({"red"}, "colour"); }),
              "f.json: /s: no colour named \"blue\"; there are red");
    EXPECT_EQ(message([&] { root.at("a/b").requireKeys({"x"}); }), "f.json: /a~1b: no key named \"~\"; there are x");
    EXPECT_EQ(message([&] { root.at("s").flag(); }), "f.json: /s: expected true or false, found \"blue\"");
    EXPECT_EQ(message([&] { root.at("gone"); }), "f.json: /: expected the key \"gone\", found none");
}

}  // namespace
}  // namespace nacre
