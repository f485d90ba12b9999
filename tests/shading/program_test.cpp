#include "shading/program.hpp"

#include <gmock/gmock.h>

#include <cstdlib>

#include "core/error.hpp"
#include "core/file.hpp"
#include "gpu_evaluate.hpp"

namespace nacre {
namespace {

using ::testing::HasSubstr;

/// A folder of shaders that is gone at the end of the test.
class ShaderSourceTest : public ::testing::Test {
protected:
    void SetUp() override {
        setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);  // the cache can call broken sources good
        folder_ = std::filesystem::temp_directory_path() / ("nacre_shader_test_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    void write(const std::string& name, const std::string& text) { writeFile(folder_ / name, text); }

    std::filesystem::path folder_;
};

template <class Call>
std::string messageOf(Call call) {
    try {
        call();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "(no error)";
}

TEST_F(ShaderSourceTest, IncludesKeepFilesAndLines) {
    write("a.glsl", "#ifndef A\n#define A\n#include \"b.glsl\"\nfloat a() { return b(); }\n#endif\n");
    write("b.glsl", "#ifndef B\n#define B\n#include \"a.glsl\"\nfloat b() { return 2.0; }\n#endif\n");
    const ShaderSource source =
        assembleShader({folder_}, {"main", "#include \"a.glsl\"\n#include \"b.glsl\"\nx"}, Glsl::V330, {{"K", "3"}});
    EXPECT_THAT(source.text, HasSubstr("#version 330 core\n#define K 3\n#line 1 0\n#line 1 1\n#ifndef A"));
    EXPECT_THAT(source.text, HasSubstr("#line 4 1\nfloat a()"));
    EXPECT_THAT(source.text, HasSubstr("#line 3 0\nx"));
    EXPECT_THAT(source.files, testing::ElementsAre("main", "a.glsl", "b.glsl"));
}

TEST_F(ShaderSourceTest, CompileErrorNamesFileAndLine) {
    write("broken.glsl", "#ifndef BROKEN\n#define BROKEN\n\nfloat broken() { return undeclared; }\n#endif\n");
    write("vertex.glsl", "void main() { gl_Position = vec4(0.0); }\n");
    for (const auto& [api, dialect] :
         {std::pair{GlApi::Core33, Glsl::V330}, {GlApi::Core45, Glsl::V450}, {GlApi::Es3, Glsl::Es300}}) {
        test::context(api);
        const ProgramLoader loader(dialect, {folder_});
        const auto log = [&](const std::string& text) {
            return messageOf([&] { loader.compile("vertex.glsl", {"main.frag", text}); });
        };
        EXPECT_THAT(log("\n#include \"broken.glsl\"\nout vec4 c;\nvoid main() { c = vec4(broken()); }\n"),
                    HasSubstr("broken.glsl:4:"));
        EXPECT_THAT(log("\n\nnonsense;\nvoid main() {}\n"), HasSubstr("main.frag:3:"));
    }
}

TEST_F(ShaderSourceTest, LineAfterIncludeIsRight) {
    write("good.glsl", "float good() { return 1.0; }\n\n\n\n");
    write("vertex.glsl", "void main() { gl_Position = vec4(0.0); }\n");
    test::context();
    const std::string log = messageOf([&] {
        ProgramLoader(Glsl::V330, {folder_})
            .compile("vertex.glsl", {"main", "#include \"good.glsl\"\n\nfloat x = y;\n"});
    });
    EXPECT_THAT(log, HasSubstr("main:3:"));
}

TEST_F(ShaderSourceTest, LinkErrorIsReported) {
    write("vertex.glsl", "out vec3 v;\nvoid main() { v = vec3(0.0); gl_Position = vec4(0.0); }\n");
    test::context();
    const std::string log = messageOf([&] {
        ProgramLoader(Glsl::V330, {folder_})
            .compile("vertex.glsl", {"main", "in vec2 v;\nout vec4 c;\nvoid main() { c = v.xyxy; }\n"});
    });
    EXPECT_THAT(log, HasSubstr("vertex.glsl and main do not link"));
}

TEST_F(ShaderSourceTest, MalformedIncludeNamesItsLine) {
    const auto assemble = [&](const std::string& text) {
        return messageOf([&] { assembleShader({folder_}, {"main", text}, Glsl::V330); });
    };
    EXPECT_THAT(assemble("#include <gone.glsl>\n"), HasSubstr("main:1: expected #include \"file\""));
}

TEST_F(ShaderSourceTest, MissingIncludeFailsOnlyWhereItIsTaken) {
    write("vertex.glsl", "void main() { gl_Position = vec4(0.0); }\n");
    test::context();
    const ProgramLoader loader(Glsl::V330, {folder_});
    const auto text = [](const char* condition) {
        return std::string("out vec4 c;\n#if ") + condition +
               "\n#include \"gone.glsl\"\n#endif\nvoid main() { c = vec4(1.0); }\n";
    };
    EXPECT_NO_THROW(loader.compile("vertex.glsl", {"main", text("0")}));
    const std::string log = messageOf([&] { loader.compile("vertex.glsl", {"main", text("1")}); });
    EXPECT_THAT(log, HasSubstr("main:3:"));
    EXPECT_THAT(log, HasSubstr("no shader file gone.glsl in " + folder_.string()));
}

TEST(NameFilesInLog, KnowsThreeDrivers) {
    const std::vector<std::string> files{"main", "nacre/x.glsl"};
    EXPECT_EQ(nameFilesInLog("1:12(3): error: no", files), "nacre/x.glsl:12: error: no\n");
    EXPECT_EQ(nameFilesInLog("1(12) : error C0: no", files), "nacre/x.glsl:12: error C0: no\n");
    EXPECT_EQ(nameFilesInLog("ERROR: 0:7: no", files), "ERROR: main:7: no\n");
    EXPECT_EQ(nameFilesInLog("9:7(1): unknown file", files), "9:7(1): unknown file\n");
}

TEST(DeclaredUniforms, FindsNamesTypesArrays) {
    const auto found = declaredUniforms(
        "// uniform float no;\n/* uniform int no;\n*/uniform vec4 a[ 16 ];\nuniform highp sampler2D b;\nuniform float "
        "c, d;\n");
    ASSERT_EQ(found.size(), 4u);
    EXPECT_EQ(found[0].type + found[0].name + found[0].arrayText, "vec4a16");
    EXPECT_EQ(found[1].type + found[1].name + found[1].arrayText, "sampler2Db");
    EXPECT_EQ(found[3].type + found[3].name, "floatd");
}

TEST_F(ShaderSourceTest, EnvironmentChoosesTheFolder) {
    const char* before = std::getenv("NACRE_SHADERS");
    const std::string kept = before ? before : "";
    unsetenv("NACRE_SHADERS");
    const std::filesystem::path usual = shaderFolder();
    EXPECT_TRUE(std::filesystem::exists(usual / "nacre"));
    setenv("NACRE_SHADERS", folder_.c_str(), 1);
    EXPECT_EQ(shaderFolder(), folder_);
    setenv("NACRE_SHADERS", "/no/such/folder", 1);
    EXPECT_THAT(messageOf([] { shaderFolder(); }), HasSubstr("/no/such/folder: expected a folder of shaders"));
    unsetenv("NACRE_SHADERS");
    if (before) setenv("NACRE_SHADERS", kept.c_str(), 1);
}

TEST_F(ShaderSourceTest, LoaderKeepsProgramsByFilesAndDefines) {
    write("vertex.glsl", "void main() { gl_Position = vec4(0.0); }\n");
    write("fragment.glsl", "out vec4 c;\nuniform float level;\nvoid main() { c = vec4(K * level); }\n");
    test::context();
    ProgramLoader loader(Glsl::V330, {folder_});
    const Program& one = loader.load("vertex.glsl", "fragment.glsl", {{"K", "1.0"}});
    EXPECT_EQ(&one, &loader.load("vertex.glsl", "fragment.glsl", {{"K", "1.0"}}));
    EXPECT_NE(&one, &loader.load("vertex.glsl", "fragment.glsl", {{"K", "2.0"}}));
    EXPECT_THROW(loader.load("vertex.glsl", "fragment.glsl", {{"K", "("}}), Error);
    EXPECT_NO_THROW(one.set("level", 1.0f));
    EXPECT_THROW(one.set("leevl", 1.0f), std::invalid_argument);
    ASSERT_EQ(one.activeUniforms().size(), 1u);
    EXPECT_EQ(one.activeUniforms()[0].type, "float");
}

}  // namespace
}  // namespace nacre
