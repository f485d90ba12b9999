#include "shading/context.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "gpu_evaluate.hpp"
#include "shading/draw.hpp"
#include "shading/render_target.hpp"
#include "shading/texture.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

TEST(Context, EveryApiWorksAndDescribesItself) {
    for (const auto& [api, version] :
         {std::pair{GlApi::Core33, "; "}, {GlApi::Core45, "; 4."}, {GlApi::Es3, "; OpenGL ES 3."}}) {
        const Context context(api);
        EXPECT_NE(context.description().find(version), std::string::npos) << context.description();
    }
}

TEST(Context, OneEndingLeavesTheOthersWorking) {
    Context kept(GlApi::Core33);
    { const Context passing(GlApi::Core33); }
    kept.makeCurrent();
    const RenderTarget target({.width = 2, .height = 2});
    target.clear({0.25f, 0.5f, 2.0f, 1.0f});
    EXPECT_EQ(target.read().rgb(1, 1), Rgb(0.25, 0.5, 2.0));
}

TEST(Context, Moves) {
    Context a(GlApi::Core33);
    Context b(std::move(a));
    b.makeCurrent();
    a = std::move(b);
    a.makeCurrent();
    EXPECT_NO_THROW(checkGl("after moving"));
}

TEST(GlObjects, MoveLeavesNothingBehind) {
    test::context();
    Buffer a;
    const GlName name = a.name();
    EXPECT_NE(name, 0u);
    const Buffer b(std::move(a));
    EXPECT_EQ(a.name(), 0u);  // NOLINT: moved-from is 0 by contract
    EXPECT_EQ(b.name(), name);
    const VertexArray vertexArray;
    const Query query;
    EXPECT_NE(vertexArray.name(), 0u);
    EXPECT_NE(query.name(), 0u);
}

TEST(RenderTarget, RowZeroIsTheTop) {
    test::context();
    const ProgramLoader loader;
    const Program program =
        loader.compile("fullscreen.vert.glsl",
                       {"rows", "out vec4 color;\nvoid main() { color = vec4(gl_FragCoord.xy, 0.0, 1.0); }\n"});
    for (const int samples : {1, 4}) {
        const RenderTarget target({.width = 3, .height = 5, .samples = samples});
        target.clear();
        program.use();
        drawFullscreen(VertexArray());
        const Image image = target.read();
        EXPECT_EQ(image.rgb(0, 0), Rgb(0.5, 4.5, 0)) << samples;
        EXPECT_EQ(image.rgb(2, 4), Rgb(2.5, 0.5, 0)) << samples;
    }
}

TEST(RenderTarget, RejectsBadSizes) {
    test::context();
    EXPECT_THROW(RenderTarget({.width = 0}), std::invalid_argument);
    EXPECT_THROW(RenderTarget({.width = 1 << 20, .height = 1 << 20}), Error);
    EXPECT_THROW(RenderTarget({.width = 4, .height = 4, .samples = 4096}), Error);
    EXPECT_THAT(tests::messageOf<Error>([] { RenderTarget({.width = 1 << 20, .height = 4}); }),
                testing::HasSubstr("found 1048576 x 4"));
}

// The largest and smallest half floats, and every 8-bit code, arrive as they are.
TEST(Texture, StoresExactValues) {
    test::context();
    const float halves[] = {0.0f, 65504.0f, -65504.0f, 5.9604645e-8f, 6.1035156e-5f, 0.33325195f, -1.0f, 1.0f};
    for (int channels = 1; channels <= 4; ++channels) {
        Image image(3, 2, channels);
        for (std::size_t i = 0; i < image.data().size(); ++i) image.data()[i] = halves[i % 8];
        for (const TexelFormat format : {TexelFormat::Half, TexelFormat::Float}) {
            AssetTexture texture;
            texture.format = format;
            texture.image = image;
            EXPECT_EQ(Texture(texture).download(channels).data(), image.data()) << channels;
        }
    }
    AssetTexture codes;
    codes.format = TexelFormat::Unorm8;
    codes.image = Image(256, 1, 1);
    for (int k = 0; k < 256; ++k) codes.image.at(k, 0, 0) = static_cast<float>(k) / 255.0f;
    const Image back = Texture(codes).download(1);
    for (int k = 0; k < 256; ++k) EXPECT_NEAR(back.at(k, 0, 0) * 255.0f, k, 1e-4) << k;
    EXPECT_THROW(Texture{AssetTexture{}}, std::invalid_argument);
}

}  // namespace
}  // namespace nacre
