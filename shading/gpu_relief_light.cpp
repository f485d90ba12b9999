#include "shading/gpu_relief_light.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <half.h>

#include <array>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"

namespace nacre {
namespace {

constexpr std::size_t kDirections = 16;  // of one draw: nacre_relief_directions
constexpr int kBrdfUnit = 11;

/// Texture units, in the order of bind/relief_light.glsl.
enum Unit { Distances, Normals, Albedo, Slopes, Fine, Lit, Leaves, PassedOn, Sky, Before, SkyCube };
constexpr std::array<const char*, 11> kSamplers = {
    "nacre_relief_distances", "nacre_relief_normals", "nacre_relief_albedo",  "nacre_relief_slopes",
    "nacre_relief_fine",      "nacre_relief_lit",     "nacre_relief_leaves",  "nacre_relief_passed_on",
    "nacre_relief_sky",       "nacre_relief_before",  "nacre_relief_sky_cube"};

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

/// Four directions a layer, as halves.
void uploadDistances(const TextureName& texture, const ScatterMap& scatter, int width, int height) {
    const int layers = (scatter.count() + 3) / 4;
    GLint most = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most);
    require(layers <= most,
            fmt::format("GpuReliefLight: expected up to {} directions, which the driver can hold, found {}", 4 * most,
                        scatter.count()));
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture.name());
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA16F, width, height, layers, 0, GL_RGBA, GL_HALF_FLOAT, nullptr);
    std::vector<std::uint16_t> data(static_cast<std::size_t>(width) * height * 4);
    for (int layer = 0; layer < layers; ++layer) {
        for (std::size_t i = 0; i < data.size(); ++i) {
            const int k = 4 * layer + static_cast<int>(i % 4);
            data[i] = Imath::half(k < scatter.count() ? scatter.distance[k].data()[i / 4] : -1.0f).bits();
        }
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, layer, width, height, 1, GL_RGBA, GL_HALF_FLOAT, data.data());
    }
    setParameters(GL_TEXTURE_2D_ARRAY, GL_NEAREST, GL_CLAMP_TO_EDGE);
    glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
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
    require(options.albedoMap.empty() || (options.albedoMap.width() == width_ && options.albedoMap.height() == height_),
            "GpuReliefLight: expected an albedo of the relief's size");
    plan_ = plan.bounces;
    fine_ = refinedRelief(map, detail_);
    makeTextures(map, scatter, plan, options);
}

void GpuReliefLight::makeTextures(const HeightMap& map, const ScatterMap& scatter, const ScatterPlan& plan,
                                  const GpuReliefLightOptions& options) {
    const GLint color = options.color == ColorFormat::Rgba16F ? GL_RGBA16F : GL_RGBA32F, wrap = wrapMode(map.wrap);
    const auto hole = [&](int x, int y) { return std::isnan(map.heights.at(x, y, 0)); };
    const auto own = [&](const TextureName& texture, GLint format, GLint filter, const auto& texel) {
        upload(texture, width_, height_, format, filter, wrap, texel);
    };
    own(normals_, GL_RGBA32F, GL_NEAREST, [&](int x, int y) {
        return hole(x, y) ? glm::vec4(0) : glm::vec4(plan.normals.rgb(x, y), plan.hits.at(x, y, 0));
    });
    own(albedo_, color, GL_LINEAR, [&](int x, int y) {
        const Rgb factor = options.albedoMap.empty() ? Rgb(1) : options.albedoMap.rgb(x, y);
        return hole(x, y) ? glm::vec4(0) : glm::vec4(options.albedo * factor, 1);
    });
    own(slopes_, GL_RGBA32F, GL_NEAREST, [&](int x, int y) { return ownSlopes(map, x, y); });
    const auto black = [](int, int) { return glm::vec4(0); };
    for (const TextureName* texture : {&sky_, &radiance_[0], &radiance_[1], &scattered_, &total_})
        own(*texture, color, GL_LINEAR, black);
    for (const TextureName& texture : sums_) own(texture, GL_RGBA32F, GL_NEAREST, black);
    const int w = fine_.width(), h = fine_.height();
    upload(fineNormals_, w, h, GL_RGBA32F, GL_NEAREST, wrap, [&](int x, int y) {
        return std::isnan(fine_.heights.at(x, y, 0)) ? glm::vec4(0) : glm::vec4(reliefNormal(fine_, x, y), 1);
    });
    upload(leaves_, w, h, color, GL_LINEAR, wrap, black);
    glBindTexture(GL_TEXTURE_2D, 0);
    uploadDistances(distances_, scatter, width_, height_);
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
                                   std::span<const double> weights) const {
    std::vector<glm::vec4> unit, towards, sky;
    for (std::size_t j = 0; j < directions.size(); ++j) {
        const Vec3& d = directions_[static_cast<std::size_t>(directions[j])];
        unit.emplace_back(d, weights[j]);
        towards.emplace_back(seenPoint(0, 0, d, 1) - Vec2(0.5), directions[j], 0);
        sky.emplace_back(lamp.sky ? lamp.sky(d) : Rgb(lamp.surrounding ? 1 : 0), 0);
    }
    program.set("nacre_relief_count", static_cast<int>(directions.size()));
    program.set("nacre_relief_directions", unit);
    program.set("nacre_relief_towards", towards);
    program.set("nacre_relief_sky_colors", sky);
}

/// Draws as many as all directions need; the last one's goes to `to`.
void GpuReliefLight::sum(const Program& program, const ReliefLamp& lamp, std::span<const int> directions,
                         std::span<const double> weights, const TextureName& to) {
    clear(sums_[1]);
    bindTexture(Before, sums_[1].name());
    std::size_t turn = 0, at = 0;
    do {
        const std::size_t count = std::min(kDirections, directions.size() - at);
        const bool last = at + count == directions.size();
        setDirections(program, lamp, directions.subspan(at, count), weights.subspan(at, count));
        program.set("nacre_relief_last", last ? 1 : 0);
        draw(last ? to : sums_[turn], width_, height_);
        bindTexture(Before, sums_[turn].name());
        turn = 1 - turn;
        at += count;
    } while (at < directions.size());
}

void GpuReliefLight::meet(const ReliefLamp& lamp) {
    std::vector<int> all(directions_.size());
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<int>(k);
    const TextureName& sky = plan_.empty() ? scattered_ : sky_;
    sum(prepare("NACRE_RELIEF_SKY", lamp), lamp,
        lamp.sky || lamp.surrounding ? std::span<const int>(all) : std::span<const int>(), weights_, sky);
    const TextureName* passedOn = &sky_;
    for (std::size_t b = plan_.size(); b-- > 0;) {
        bindTexture(Leaves, 0);
        prepare("NACRE_RELIEF_LEAVES", lamp).use();
        bindTexture(PassedOn, passedOn->name());
        draw(leaves_, fine_.width(), fine_.height());
        bindTexture(Leaves, leaves_.name());
        bindTexture(Sky, sky_.name());
        const TextureName* to = b == 0 ? &scattered_ : &radiance_[b % 2];
        sum(prepare("NACRE_RELIEF_GATHER", lamp), lamp, plan_[b].directions, plan_[b].weights, *to);
        passedOn = to;
    }
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
        const Image mask = litMask(fine_, lamp.light, threads_);
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
