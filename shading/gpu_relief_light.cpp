#include "shading/gpu_relief_light.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <half.h>

#include <array>
#include <numeric>

#include "bump/patch_samples.hpp"
#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"

namespace nacre {
namespace {

constexpr std::size_t kDirections = 16;  // of one draw: nacre_relief_directions
constexpr int kBrdfUnit = 11;

/// Texture units, in the order of bind/relief_light.glsl.
/// A BRDF's take the last two's.
enum Unit { Distances, Normals, Albedo, Slopes, Fine, Lit, Leaves, PassedOn, Sky, Before, SkyCube, Own, Points };
constexpr std::array<const char*, 13> kSamplers = {
    "nacre_relief_distances", "nacre_relief_normals", "nacre_relief_albedo",   "nacre_relief_slopes",
    "nacre_relief_fine",      "nacre_relief_lit",     "nacre_relief_leaves",   "nacre_relief_passed_on",
    "nacre_relief_sky",       "nacre_relief_before",  "nacre_relief_sky_cube", "nacre_relief_own_shares",
    "nacre_relief_points"};

GLint wrapMode(Wrap wrap) {
    return wrap == Wrap::Repeat ? GL_REPEAT : wrap == Wrap::Clamp ? GL_CLAMP_TO_EDGE : GL_MIRRORED_REPEAT;
}

void setParameters(GLenum target, GLint filter, GLint wrap) {
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, wrap);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, wrap);
    glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
}

/// RGBA from one value a texel; leaves the texture bound to unit 0.
template <typename Texel>  // glm::vec4(int x, int y)
void upload(const TextureName& texture, int width, int height, GLint format, GLint filter, GLint wrap, Texel texel) {
    std::vector<glm::vec4> data;
    data.reserve(static_cast<std::size_t>(width) * height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) data.push_back(texel(x, y));
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, GL_RGBA, GL_FLOAT, data.data());
    setParameters(GL_TEXTURE_2D, filter, wrap);
}

/// Halves, four a texel and layer. \param value  bits of number n of texel (x, y)
template <typename Value>
void uploadLayers(const TextureName& texture, int width, int height, int numbers, const char* what, Value value) {
    const int layers = std::max(1, (numbers + 3) / 4);
    GLint most = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most);
    require(layers <= most, fmt::format("GpuReliefLight: expected up to {} {}, which the driver can hold, found {}",
                                        4 * most, what, numbers));
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture.name());
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA16F, width, height, layers, 0, GL_RGBA, GL_HALF_FLOAT, nullptr);
    std::vector<std::uint16_t> data(static_cast<std::size_t>(width) * height * 4);
    for (int layer = 0; layer < layers; ++layer) {
        std::size_t i = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (int n = 4 * layer; n < 4 * layer + 4; ++n) data[i++] = n < numbers ? value(x, y, n) : 0;
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, layer, width, height, 1, GL_RGBA, GL_HALF_FLOAT, data.data());
    }
    setParameters(GL_TEXTURE_2D_ARRAY, GL_NEAREST, GL_CLAMP_TO_EDGE);
    glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
}

std::uint16_t offsetBits(const SeenPoints& points, std::size_t i, int number) {
    const std::uint32_t both =
        points.offsets[i * static_cast<std::size_t>(points.count) + static_cast<std::size_t>(number / 2)];
    return static_cast<std::uint16_t>(number % 2 ? both >> 16 : both & 0xffff);
}

void bindTexture(int unit, GlName texture, GLenum target = GL_TEXTURE_2D) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(target, texture);
}

/// Of the framebuffer that is bound.
void clear(const TextureName& texture) {
    const float zero[4] = {0, 0, 0, 0};
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture.name(), 0);
    glClearBufferfv(GL_COLOR, 0, zero);
}

bool isUnit(const Vec3& d) {
    constexpr double kUnit = 1e-6;
    return isFinite(d) && std::abs(glm::length(d) - 1) < kUnit;
}

}  // namespace

GpuReliefLight::GpuReliefLight(ProgramLoader& loader, const HeightMap& map, const ScatterMap& scatter,
                               const GpuReliefLightOptions& options)
    : loader_(&loader),
      width_(map.width()),
      height_(map.height()),
      detail_(options.detail),
      bounces_(options.bounces),
      paths_(options.paths),
      threads_(options.threads),
      brdf_(options.brdf),
      directions_(scatter.directions),
      weights_(scatter.weights) {
    const ScatterPlan plan = planScatter(
        map, scatter,
        {.bounces = options.bounces, .paths = options.paths, .normals = options.normals, .threads = options.threads});
    require(isFinite(options.albedo), "GpuReliefLight: expected a finite albedo");
    require(detail_ >= 1 && detail_ % 2 == 1,
            fmt::format("GpuReliefLight: expected an odd detail >= 1, found {}", detail_));
    require(options.albedoMap.empty() || (options.albedoMap.width() == width_ && options.albedoMap.height() == height_),
            "GpuReliefLight: expected an albedo of the relief's size");
    viewedPoints_ = plan.viewed.count, patchPoints_ = plan.patches[0].count;
    period_ = reliefPeriod(map);
    makeTextures(map, scatter, plan, options);
}

void GpuReliefLight::makeTextures(const HeightMap& map, const ScatterMap& scatter, const ScatterPlan& plan,
                                  const GpuReliefLightOptions& options) {
    const GLint color = options.color == ColorFormat::Rgba16F ? GL_RGBA16F : GL_RGBA32F, wrap = wrapMode(map.wrap);
    const auto index = [&](int x, int y) { return static_cast<std::size_t>(y) * map.width() + x; };
    const auto hole = [&](int x, int y) { return std::isnan(map.heights.at(x, y, 0)); };
    const auto own = [&](const TextureName& texture, GLint format, GLint filter, const auto& texel) {
        upload(texture, width_, height_, format, filter, wrap, texel);
    };
    own(normals_, GL_RGBA32F, GL_NEAREST, [&](int x, int y) {
        return hole(x, y) ? glm::vec4(0)
                          : glm::vec4(plan.normals.rgb(x, y), bounces_ > 0 ? plan.viewed.share[index(x, y)] : 0.0f);
    });
    own(albedo_, color, GL_LINEAR, [&](int x, int y) {
        const Rgb factor = options.albedoMap.empty() ? Rgb(1) : options.albedoMap.rgb(x, y);
        return hole(x, y) ? glm::vec4(0) : glm::vec4(options.albedo * factor, 1);
    });
    own(slopes_, GL_RGBA32F, GL_NEAREST, [&](int x, int y) { return ownSlopes(map, x, y); });
    const auto black = [](int, int) { return glm::vec4(0); };
    for (const TextureName* texture : {&viewed_.sky, &radiance_[0], &radiance_[1], &scattered_, &total_})
        own(*texture, color, GL_LINEAR, black);
    const int around = wrapMode(period_.wrap), w = 2 * period_.width(), h = 2 * period_.height();
    for (const TextureName* texture : {&patch_.sky, &passedOn_[0], &passedOn_[1]})
        upload(*texture, w, h, color, GL_LINEAR, around, black);
    for (const TextureName& texture : sums_) upload(texture, w, h, GL_RGBA32F, GL_NEAREST, around, black);
    const Image fine = PatchSamples{detail_}.normals(period_);
    upload(fineNormals_, fine.width(), fine.height(), GL_RGBA32F, GL_NEAREST, around,
           [&](int x, int y) { return glm::vec4(fine.rgb(x, y), 1); });
    upload(leaves_, fine.width(), fine.height(), color, GL_LINEAR, around, black);
    upload(viewed_.own, width_, height_, GL_RGBA16F, GL_NEAREST, wrap,
           [&](int x, int y) { return bounces_ > 0 ? plan.viewed.own[index(x, y)] : glm::vec4(0); });
    const auto patchOf = [](int x, int y) { return static_cast<std::size_t>(x % 2 + 2 * (y % 2)); };
    upload(patch_.own, 2 * width_, 2 * height_, GL_RGBA16F, GL_NEAREST, wrap, [&](int x, int y) {
        if (bounces_ < 2) return glm::vec4(0);
        const std::size_t q = patchOf(x, y), i = index(x / 2, y / 2);
        glm::vec4 shares = plan.patches[q].own[i];
        shares[static_cast<int>(q)] = plan.patches[q].share[i];
        return shares;
    });
    glBindTexture(GL_TEXTURE_2D, 0);
    uploadLayers(distances_, width_, height_, scatter.count(), "directions", [&](int x, int y, int k) {
        return Imath::half(scatter.distance[static_cast<std::size_t>(k)].at(x, y, 0)).bits();
    });
    uploadLayers(viewed_.points, width_, height_, 2 * viewedPoints_, "halves of points",
                 [&](int x, int y, int n) { return offsetBits(plan.viewed, index(x, y), n); });
    uploadLayers(patch_.points, 2 * width_, 2 * height_, 2 * patchPoints_, "halves of points",
                 [&](int x, int y, int n) { return offsetBits(plan.patches[patchOf(x, y)], index(x / 2, y / 2), n); });
    checkGl("textures of a GPU relief light");
}

/// Sets what all steps share, and binds.
const Program& GpuReliefLight::prepare(const char* step, const ReliefLamp& lamp) const {
    ShaderDefines defines;
    if (brdf_) {
        defines = brdf_->defines();
        defines.emplace_back("NACRE_RELIEF_BRDF", "1");
    }
    defines.emplace_back("NACRE_RELIEF_STEP", step);
    if (lamp.surrounding) defines.emplace_back("NACRE_RELIEF_SKY_CUBE", "1");
    const Program& program = loader_->load("fullscreen.vert.glsl", "relief_light.frag.glsl", defines);
    for (std::size_t i = 0; i < kSamplers.size(); ++i) program.set(kSamplers[i], static_cast<int>(i));
    program.set("nacre_relief_detail", detail_);
    program.set("nacre_relief_light", glm::vec3(lamp.light));
    program.set("nacre_relief_irradiance", glm::vec3(lamp.irradiance));
    program.set("nacre_relief_to", glm::vec3(lamp.viewer));
    program.set("nacre_relief_to_sky", lamp.toSurrounding);
    program.set("nacre_relief_last", 0);
    program.set("nacre_relief_patches", 0);
    program.set("nacre_relief_side", glm::vec2(1));
    if (brdf_) brdf_->bind(program, kBrdfUnit);
    bindTexture(Distances, distances_.name(), GL_TEXTURE_2D_ARRAY);
    const std::pair<Unit, const TextureName*> textures[] = {
        {Normals, &normals_}, {Albedo, &albedo_}, {Slopes, &slopes_}, {Fine, &fineNormals_}, {Lit, &lit_}};
    for (const auto& [unit, texture] : textures) bindTexture(unit, texture->name());
    if (lamp.surrounding) lamp.surrounding->bind(SkyCube);
    return program;
}

void GpuReliefLight::draw(const TextureName& to, int width, int height) const {
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, to.name(), 0);
    glViewport(0, 0, width, height);
    drawFullscreen(empty_);
}

/// At most kDirections.
void GpuReliefLight::setDirections(const Program& program, const ReliefLamp& lamp, std::span<const int> directions,
                                   std::span<const double> weights, const Vec2& side) const {
    std::vector<glm::vec4> unit, towards, sky;
    for (std::size_t j = 0; j < directions.size(); ++j) {
        const Vec3& d = directions_[static_cast<std::size_t>(directions[j])];
        unit.emplace_back(d, weights[j]);
        towards.emplace_back(seenPoint(0, 0, d, 1) - Vec2(0.5), directions[j], 0);
        sky.emplace_back(lamp.sky ? lamp.sky({d.x * side.x, d.y * side.y, d.z}) : Rgb(lamp.surrounding ? 1 : 0), 0);
    }
    program.set("nacre_relief_count", static_cast<int>(directions.size()));
    program.set("nacre_relief_directions", unit);
    program.set("nacre_relief_towards", towards);
    program.set("nacre_relief_sky_colors", sky);
}

/// Radiance straight from the sky, of texels or of the patches of a period. Each tile of a period has its own sky.
void GpuReliefLight::sumSky(const ReliefLamp& lamp, bool patches, const TextureName& to) const {
    const Program& program = prepare("NACRE_RELIEF_SKY", lamp);
    std::vector<int> all(lamp.sky || lamp.surrounding ? directions_.size() : 0);
    std::iota(all.begin(), all.end(), 0);
    const int each = patches ? 2 : 1, tileWidth = each * width_, tileHeight = each * height_;
    const int across = patches ? period_.width() / width_ : 1, down = patches ? period_.height() / height_ : 1;
    clear(sums_[1]);
    bindTexture(Before, sums_[1].name());
    program.set("nacre_relief_patches", patches ? 1 : 0);
    std::size_t turn = 0, at = 0;
    glEnable(GL_SCISSOR_TEST);
    do {
        const std::size_t count = std::min(kDirections, all.size() - at);
        const bool last = at + count == all.size();
        program.set("nacre_relief_last", last ? 1 : 0);
        for (int tile = 0; tile < across * down; ++tile) {
            const int x = tile % across, y = tile / across;
            const Vec2 side(x ? -1 : 1, y ? -1 : 1);
            program.set("nacre_relief_side", glm::vec2(side));
            setDirections(program, lamp, std::span<const int>(all).subspan(at, count),
                          std::span<const double>(weights_).subspan(at, count), side);
            glScissor(x * tileWidth, y * tileHeight, tileWidth, tileHeight);
            draw(last ? to : sums_[turn], across * tileWidth, down * tileHeight);
        }
        bindTexture(Before, sums_[turn].name());
        turn = 1 - turn;
        at += count;
    } while (at < all.size());
    glDisable(GL_SCISSOR_TEST);
}

void GpuReliefLight::meet(const ReliefLamp& lamp) {
    sumSky(lamp, false, bounces_ == 0 ? scattered_ : viewed_.sky);
    if (bounces_ == 0) return;
    sumSky(lamp, true, patch_.sky);
    const int each = detail_ + 1;
    const TextureName* passedOn = &patch_.sky;
    for (int b = bounces_; b-- > 0;) {
        bindTexture(Leaves, 0);
        prepare("NACRE_RELIEF_LEAVES", lamp).use();
        bindTexture(PassedOn, passedOn->name());
        draw(leaves_, each * period_.width(), each * period_.height());
        const Program& gather = prepare("NACRE_RELIEF_GATHER", lamp);
        const Seen& seen = b == 0 ? viewed_ : patch_;
        gather.set("nacre_relief_patches", b == 0 ? 0 : 1);
        gather.set("nacre_relief_count", b == 0 ? viewedPoints_ : patchPoints_);
        bindTexture(PassedOn, passedOn->name());
        bindTexture(Leaves, leaves_.name());
        bindTexture(Sky, seen.sky.name());
        bindTexture(Own, seen.own.name());
        bindTexture(Points, seen.points.name(), GL_TEXTURE_2D_ARRAY);
        const TextureName& to = b == 0 ? scattered_ : passedOn_[b % 2];
        if (b == 0)
            draw(to, width_, height_);
        else
            draw(to, 2 * period_.width(), 2 * period_.height());
        passedOn = &to;
    }
    bindTexture(Points, 0, GL_TEXTURE_2D_ARRAY);
}

void GpuReliefLight::follow(const ReliefLamp& lamp) {
    const std::size_t depth = static_cast<std::size_t>(bounces_) + 1;
    const std::vector<int> paths = scatterPaths(static_cast<int>(directions_.size()), paths_, bounces_ + 1);
    const Program& program = prepare("NACRE_RELIEF_SEGMENT", lamp);
    std::size_t turn = 0;  // of the sums
    clear(sums_[1]);
    for (int p = 0; p < paths_; ++p) {
        const std::span<const int> path = std::span(paths).subspan(static_cast<std::size_t>(p) * depth, depth);
        clear(radiance_[depth % 2]);  // nothing comes along the deepest segment but the sky
        for (std::size_t b = depth; b-- > 0;) {
            const auto k = static_cast<std::size_t>(path[b]);
            setDirections(program, lamp, path.subspan(b, 1), std::span(weights_).subspan(k, 1));
            const double share = b > 0 ? 1 : 1.0 / paths_;
            program.set("nacre_relief_factor", static_cast<float>(static_cast<double>(directions_.size()) * share));
            const Vec3 to = b > 0 ? -directions_[static_cast<std::size_t>(path[b - 1])] : lamp.viewer;
            program.set("nacre_relief_to", glm::vec3(to));
            program.set("nacre_relief_last", b == 0 ? 1 : 0);
            bindTexture(PassedOn, radiance_[(b + 1) % 2].name());
            bindTexture(Before, b == 0 ? sums_[1 - turn].name() : 0);
            const bool done = b == 0 && p + 1 == paths_;
            draw(done ? scattered_ : b == 0 ? sums_[turn] : radiance_[b % 2], width_, height_);
        }
        turn = 1 - turn;
    }
}

void GpuReliefLight::update(const ReliefLamp& lamp) {
    require(isUnit(lamp.light) && isUnit(lamp.viewer), "GpuReliefLight: expected unit directions of light and viewer");
    require(isFinite(lamp.irradiance), "GpuReliefLight: expected a finite irradiance");
    require(!lamp.surrounding || lamp.surrounding->layout() == EnvLayout::Cube,
            "GpuReliefLight: expected a surrounding as a cube");
    if (litFor_ != lamp.light) {
        const Image mask = PatchSamples{detail_}.lit(period_, lamp.light, threads_);
        upload(lit_, mask.width(), mask.height(), GL_RGBA16F, GL_NEAREST, GL_CLAMP_TO_EDGE,
               [&](int x, int y) { return glm::vec4(mask.at(x, y, 0)); });
        litFor_ = lamp.light;
    }
    for (const GLenum state : {GL_SCISSOR_TEST, GL_DEPTH_TEST, GL_BLEND, GL_CULL_FACE}) glDisable(state);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    if (brdf_)
        follow(lamp);
    else
        meet(lamp);
    prepare("NACRE_RELIEF_TOTAL", lamp).use();
    bindTexture(PassedOn, scattered_.name());
    draw(total_, width_, height_);
    for (int unit = kBrdfUnit + kMaxFactoredTextures; unit-- > 0;) bindTexture(unit, 0);
    bindTexture(SkyCube, 0, GL_TEXTURE_CUBE_MAP);
    bindTexture(Distances, 0, GL_TEXTURE_2D_ARRAY);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("GPU relief light");
}

Image GpuReliefLight::read(GlName result) const {
    std::vector<glm::vec4> pixels(static_cast<std::size_t>(width_) * height_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, result, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, pixels.data());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("reading a relief's light");
    Image out(width_, height_, 3);
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) out.setRgb(x, y, Rgb(pixels[static_cast<std::size_t>(y) * width_ + x]));
    return out;
}

}  // namespace nacre
