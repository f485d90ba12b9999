// The surface in a volume as the rasteriser draws it against rays followed through the field; and volume files.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/error.hpp"
#include "factorize/models/models.hpp"
#include "gpu_evaluate.hpp"
#include "reference/image_compare.hpp"
#include "reference/volume_trace.hpp"
#include "shading/volume_file.hpp"
#include "shading/volume_pass.hpp"
#include "volume_fixture.hpp"

namespace nacre {
namespace {

using test::Bytes;
using test::den;
using test::egg;

constexpr int kSize = 96;

Camera lookingAt(bool orthographic) {
    Camera camera;
    camera.eye = {1.5, 1.4, 2.5};
    camera.orthographic = orthographic;
    camera.height = 2.6;
    camera.fovY = 0.8;
    camera.near = 0.5;
    camera.far = 8;
    return camera;
}

std::vector<Light> someLights() {
    return {{true, glm::normalize(Vec3(1, 2, 1)), {1.0, 0.5, 0.25}},
            {false, {-0.5, 1.5, 2.0}, {0.5, 1.0, 2.0}},
            {false, {1.0, 0.5, 2.5}, Rgb(3), SpotCone{glm::normalize(Vec3(-1, -0.4, -2.5)), 0.05, 0.3}}};
}

Image interior(const Image& coverage) {
    Image out(coverage.width(), coverage.height(), 1);
    for (int y = 1; y + 1 < coverage.height(); ++y)
        for (int x = 1; x + 1 < coverage.width(); ++x) {
            float least = 1;
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i) least = std::min(least, coverage.at(x + i, y + j, 0));
            out.at(x, y, 0) = least;
        }
    return out;
}

class VolumePass : public ::testing::Test {
protected:
    void SetUp() override { test::context(); }

    Image draw(const Volume& volume, VolumeSurface surface, const LitView& view) {
        const GpuVolume gpu(volume);
        surface.volume = &gpu;
        ProgramLoader loader;
        const RenderTarget target({.width = kSize, .height = kSize});
        target.clear();
        renderVolume(loader, target, surface, view, *directBrdf(model_));
        return target.read(4);
    }
    ImageDifference difference(const Volume& volume, const VolumeSurface& surface, const LitView& view) {
        const Image picture = draw(volume, surface, view);
        const RaytracedPicture truth = traceVolume({volume, surface.iso, surface.toWorld}, view.camera, view.lights,
                                                   model_.f, {.width = kSize, .height = kSize});
        const Image mask = interior(truth.coverage);
        Image rgb(kSize, kSize, 3);
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) rgb.setRgb(x, y, picture.rgb(x, y));
        return compareImages(rgb, truth.radiance, pictureWhite(truth.radiance, mask), mask);
    }

    Reflectance model_ = makeModel("blinn-phong:n=20,kd=0.5,ks=0.3");
};

// Half floats hold values and gradients to 5e-4; a crossing missed, an axis swapped or the light's fall-off left out is
// off by more than 0.1.
constexpr double kMarched = 4e-3;
// Points half a step off along the line of sight have other normals, most along the rim of the dent; measured 0.049.
constexpr double kSliced = 6e-2;

TEST_F(VolumePass, MarchedSurfaceIsTheTracedOne) {
    const Volume volume = egg({40, 32, 36});
    for (const bool orthographic : {false, true}) {
        const ImageDifference d = difference(volume, {.iso = 0.4}, {lookingAt(orthographic), someLights(), Rgb(0)});
        EXPECT_GT(d.pixels, 700u);
        EXPECT_LT(d.relative, kMarched) << orthographic;
    }
}

TEST_F(VolumePass, SlicesComeNearerAsTheyGetMore) {
    const Volume volume = egg({40, 32, 36});
    const LitView view{lookingAt(false), someLights(), Rgb(0)};
    double before = 1;
    for (const double step : {2.0, 0.5, 0.125}) {
        const ImageDifference d = difference(volume, {.iso = 0.4, .method = VolumeMethod::Slices, .step = step}, view);
        EXPECT_LT(d.relative, 0.6 * before) << step;
        before = d.relative;
        if (step == 0.5) {
            EXPECT_LT(d.relative, kSliced);
        }
    }
}

TEST_F(VolumePass, TurnedAndStretchedInTheWorld) {
    const Volume volume = egg({40, 32, 36});
    const glm::dmat4 toWorld(Vec4(0.1, 0.7, 0, 0), Vec4(-0.9, 0.2, 0.1, 0), Vec4(0, 0.1, 1.1, 0),
                             Vec4(0.1, 0, -0.2, 1));
    const LitView view{lookingAt(false), someLights(), Rgb(0)};
    EXPECT_LT(difference(volume, {.iso = 0.4, .toWorld = toWorld}, view).relative, kMarched);
    EXPECT_LT(difference(volume, {.iso = 0.4, .toWorld = toWorld, .method = VolumeMethod::Slices}, view).relative,
              kSliced);
}

TEST_F(VolumePass, SurfaceStartsWhereTheBoxDoes) {
    Volume full = egg({16, 16, 16});
    for (std::size_t i = 0; i < full.values.size(); ++i) full.values[i] = 1 + static_cast<float>(i % 16) / 16;
    const LitView view{lookingAt(false), someLights(), Rgb(0)};
    const ImageDifference d = difference(full, {.iso = 0.5}, view);
    EXPECT_GT(d.pixels, 1500u);
    EXPECT_LT(d.relative, kMarched);
}

TEST_F(VolumePass, OneTexelAFlatAxisAndNothingInside) {
    Volume one;
    one.size = {1, 1, 1};
    one.values = {3};
    const LitView view{lookingAt(false), someLights(), Rgb(0.25)};
    const Image cube = draw(one, {.iso = 2}, view);  // no gradient: its normal is the line of sight
    EXPECT_EQ(cube.at(kSize / 2, kSize / 2, 3), 1.0f);
    EXPECT_GT(cube.at(kSize / 2, kSize / 2, 0), 0.25f);
    const Image none = draw(one, {.iso = 4}, view);
    for (const float v : none.data()) EXPECT_EQ(v, 0.0f);
    // One texel deep: the same all along z. Only what is covered counts, for the middle's normal is that of noise.
    const Volume flat = egg({24, 24, 1});
    const Image picture = draw(flat, {.iso = 0.4}, view);
    const Image covered =
        traceVolume({flat, 0.4}, view.camera, view.lights, model_.f, {.width = kSize, .height = kSize}).coverage;
    int hits = 0, different = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            hits += covered.at(x, y, 0) > 0;
            different += covered.at(x, y, 0) != picture.at(x, y, 3);
        }
    EXPECT_GT(hits, 300);
    EXPECT_LE(different, 4);
}

TEST_F(VolumePass, ShadowsOfTheReferenceDarken) {
    const Volume volume = egg({24, 24, 24});
    const std::vector<Light> grazing = {{true, glm::normalize(Vec3(-1, 0.4, 0.9)), Rgb(1)}};
    RaytraceOptions options{.width = kSize, .height = kSize};
    const TracedVolume surface{volume, 0.4};
    const Image open = traceVolume(surface, lookingAt(false), grazing, model_.f, options).radiance;
    options.shadows = true;
    const Image shadowed = traceVolume(surface, lookingAt(false), grazing, model_.f, options).radiance;
    int darker = 0;
    for (std::size_t i = 0; i < open.data().size(); ++i) {
        EXPECT_LE(shadowed.data()[i], open.data()[i]);
        darker += shadowed.data()[i] < open.data()[i];
    }
    EXPECT_GT(darker, 100);  // of the dent
}

TEST_F(VolumePass, WrongSettingsAreNamed) {
    const GpuVolume gpu(egg({8, 8, 8}));
    ProgramLoader loader;
    const RenderTarget target({.width = 4, .height = 4});
    const auto draws = [&](const VolumeSurface& s) {
        renderVolume(loader, target, s, {lookingAt(false), {}, Rgb(0)}, *directBrdf(model_));
    };
    EXPECT_THROW(draws({}), std::invalid_argument);
    EXPECT_THROW(draws({.volume = &gpu, .iso = std::nan("")}), std::invalid_argument);
    EXPECT_THROW(draws({.volume = &gpu, .step = 0}), std::invalid_argument);
    EXPECT_THROW(draws({.volume = &gpu, .step = 1e-4}), std::invalid_argument);
}

TEST(VolumeSlices, CoverTheBoxOnceAStep) {
    const std::vector<glm::vec3> triangles = volumeSlices(glm::dmat4(1), Vec3(0, 0, 1), 0.25);
    ASSERT_EQ(triangles.size(), 4u * 2 * 3);
    double area = 0;
    for (std::size_t i = 0; i < triangles.size(); i += 3)
        area += 0.5 * glm::length(glm::cross(triangles[i + 1] - triangles[i], triangles[i + 2] - triangles[i]));
    EXPECT_NEAR(area, 4, 1e-6);
    EXPECT_FLOAT_EQ(triangles.front().z, 0.125f);
    EXPECT_FLOAT_EQ(triangles.back().z, 0.875f);
}

Bytes inr(std::string header, const void* data, std::size_t size) {
    header.resize(252, '\n');
    header += "##}\n";
    Bytes out(header.begin(), header.end());
    out.resize(256 + size);
    if (size > 0) std::memcpy(out.data() + 256, data, size);
    return out;
}

std::string messageOf(const Bytes& bytes) {
    try {
        parseVolume(bytes, "f");
    } catch (const Error& e) {
        return e.what();
    }
    return "no error";
}

TEST(VolumeFile, DenAndInrAreRead) {
    const Volume a = parseVolume(den(3, 2, 2), "f");
    EXPECT_EQ(a.size, glm::ivec3(3, 2, 2));
    EXPECT_EQ(a.at(2, 1, 1), 11);
    const float values[] = {1, 2.5f, -3, 4, 5, 6};
    const Volume b = parseVolume(
        inr("#INRIMAGE-4#{\nXDIM=1\nYDIM=3\nZDIM=2\nVDIM=1\nTYPE=float\nPIXSIZE=32 bits\nCPU=decm\nVX=2\nVY=3\nVZ=4\n",
            values, sizeof values),
        "f");
    EXPECT_EQ(b.size, glm::ivec3(1, 3, 2));
    EXPECT_EQ(b.spacing, Vec3(2, 3, 4));
    EXPECT_EQ(b.at(0, 1, 0), 2.5f);
    const std::uint8_t big[] = {1, 2, 255, 254};
    const Volume c = parseVolume(
        inr("#INRIMAGE-4#{\nXDIM=2\nYDIM=1\nZDIM=1\nVDIM=1\nTYPE=signed fixed\nPIXSIZE=16 bits\nCPU=sun\n", big, 4),
        "f");
    EXPECT_EQ(c.values, (std::vector<float>{258, -2}));
}

TEST(VolumeFile, BrokenOnesAreRefusedInOneLine) {
    Bytes cut = den(3, 2, 2);
    cut.pop_back();
    EXPECT_EQ(messageOf(cut), "f: expected 12 bytes of data, found 11");
    Bytes longer = den(3, 2, 2);
    longer.push_back(0);
    EXPECT_EQ(messageOf(longer), "f: expected 12 bytes of data, found 13");
    EXPECT_EQ(messageOf(Bytes(100, 7)), "f: expected a volume (.den or .inr), found another format");
    EXPECT_EQ(messageOf({}), "f: expected a volume (.den or .inr), found another format");
    const float nan = std::nanf("");
    const std::string header = "#INRIMAGE-4#{\nXDIM=1\nYDIM=1\nZDIM=1\nVDIM=1\nTYPE=float\nPIXSIZE=32 bits\n";
    EXPECT_EQ(messageOf(inr(header, &nan, 4)), "f: volume: a value is not finite");
    EXPECT_EQ(messageOf(inr("#INRIMAGE-4#{\nXDIM=1e9\nYDIM=1\nZDIM=1\nVDIM=1\n", nullptr, 0)),
              "f: expected 1 to 1024 texels along an edge, found -1 x 1 x 1");
    EXPECT_EQ(messageOf(inr("#INRIMAGE-4#{\nXDIM=x\nVDIM=1\n", nullptr, 0)),
              "f: expected a number for XDIM, found 'x'");
    EXPECT_EQ(messageOf(inr("#INRIMAGE-4#{\nXDIM=1\nYDIM=1\nZDIM=1\nVDIM=1\nTYPE=odd\nPIXSIZE=8 bits\n", &nan, 1)),
              "f: expected float of 32 or 64 bits or fixed of 8 or 16, found 'odd' of 8");
}

}  // namespace
}  // namespace nacre
