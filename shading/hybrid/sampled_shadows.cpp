#include "shading/hybrid/sampled_shadows.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <chrono>
#include <limits>

#include "core/error.hpp"
#include "core/light_area.hpp"
#include "core/parallel.hpp"
#include "core/sampling.hpp"
#include "shading/context.hpp"

namespace nacre {

static constexpr std::uint64_t kTracedPixels = 4096;  // that a choice is made by
static constexpr int kTracedPoints = 256;

const char* nameOf(SampledShadowMethod method) {
    switch (method) {
        case SampledShadowMethod::Maps:
            return "maps";
        case SampledShadowMethod::Volumes:
            return "volumes";
        case SampledShadowMethod::Fastest:
            break;
    }
    return "fastest";
}

namespace {

/// What rays say of some of a view's pixels: levels of each light, and the cosine at which its light arrives.
struct TracedLevel {
    std::size_t at;  ///< in the levels of all lights, row 0 lowest
    double level, cosine;
};

std::vector<TracedLevel> traceLevels(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes,
                                     const std::vector<SeenPoint>& seen) {
    std::vector<std::size_t> pixels;
    for (std::uint64_t i = 1; i <= kTracedPixels; ++i) {
        const auto pixel = static_cast<std::size_t>(halton3(i).x * static_cast<double>(seen.size()));
        if (seen[pixel].place.w != 0) pixels.push_back(pixel);
    }
    const RayScene rays(scene, nodes);
    const std::vector<Light> lights = lightsInWorld(scene, nodes);
    const auto areas = areasInWorld(scene, nodes);
    std::vector<TracedLevel> out;
    for (std::size_t k = 0; k < lights.size(); ++k) {
        if (!scene.lights[k].shadow) continue;
        const std::vector<Light> points =
            areas[k] ? pointsOfArea(lights[k], *areas[k], kTracedPoints) : std::vector<Light>{lights[k]};
        std::vector<TracedLevel> levels(pixels.size());
        parallelFor(pixels.size(), 0, [&](std::size_t i) {
            const SeenPoint& p = seen[pixels[i]];
            const Vec3 place(p.place);
            const auto ahead = [&](const Light& l) { return l.directional ? l.position : l.position - place; };
            const Vec3 middle = ahead(lights[k]);
            levels[i] = {k * seen.size() + pixels[i], 0,
                         std::max(0.0, glm::dot(Vec3(p.normal), middle) / glm::length(middle))};
            if (levels[i].cosine == 0) return;
            int blocked = 0;
            for (const Light& l : points)
                blocked += rays.blocked(place, l.directional ? place + 1e3 * l.position : l.position, true);
            levels[i].level = blocked / static_cast<double>(points.size());
        });
        out.insert(out.end(), levels.begin(), levels.end());
    }
    return out;
}

/// Of levels times the cosine, as back faces' levels don't show.
double psnrOf(const std::vector<float>& levels, const std::vector<TracedLevel>& truth) {
    double squares = 0;
    for (const TracedLevel& t : truth) squares += sqr(t.cosine * (levels[t.at] - t.level));
    return squares > 0 ? -10 * std::log10(squares / static_cast<double>(truth.size()))
                       : std::numeric_limits<double>::infinity();
}

}  // namespace

/// Casters are made again when nodes moved.
void SampledShadows::follow(const std::vector<glm::dmat4>& nodes) {
    if (nodes_ == nodes && (maps_ || volumes_)) return;
    maps_.reset();
    volumes_.reset();
    nodes_ = nodes;
    chosen_ = false;
}

void SampledShadows::allocate(int width, int height) {
    const std::size_t lights = scene_.lights.size();
    if (layers_ && width_ == width && height_ == height && framebuffers_.size() == lights) return;
    width_ = width, height_ = height;
    layers_.emplace();
    framebuffers_.clear();
    glBindTexture(GL_TEXTURE_2D_ARRAY, layers_->name());
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_R32F, width, height, static_cast<GLsizei>(lights), 0, GL_RED, GL_FLOAT,
                 nullptr);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
    glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
    for (std::size_t i = 0; i < lights; ++i) {
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_.emplace_back().name());
        glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, layers_->name(), 0, static_cast<GLint>(i));
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    sums_.emplace(width, height);
    chosen_ = false;
    checkGl("making levels of lights");
}

void SampledShadows::drawBy(SampledShadowMethod method, const GeometryBuffer& geometry, const Camera& camera,
                            const SampledShadowOptions& options) {
    const std::vector<Light> lights = lightsInWorld(scene_, nodes_);
    const auto areas = areasInWorld(scene_, nodes_);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (!scene_.lights[i].shadow) {
            const GLfloat zero[] = {0, 0, 0, 0};
            glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[i].name());
            glClearBufferfv(GL_COLOR, 0, zero);
            glBindFramebuffer(GL_FRAMEBUFFER, 0);
            continue;
        }
        const std::vector<Light> points =
            areas[i] ? pointsOfArea(lights[i], *areas[i], options.points) : std::vector<Light>{lights[i]};
        const ShadowFilter filter = areas[i] ? options.filter : ShadowFilter::None;
        if (method == SampledShadowMethod::Maps && !lights[i].directional) {
            if (!maps_) maps_.emplace(scene_, nodes_);
            sums_->clear();
            maps_->add(loader_, geometry, camera, points, *sums_, options.maps);
            sums_->filter(loader_, geometry, filter, framebuffers_[i].name());
            continue;
        }
        if (!volumes_) volumes_.emplace(loader_, scene_, nodes_);
        volumes_->begin(geometry, camera);
        for (const Light& p : points) volumes_->add(homogeneous(p), 1.0 / static_cast<double>(points.size()));
        volumes_->levels().filter(loader_, geometry, filter, framebuffers_[i].name());
    }
}

std::vector<float> SampledShadows::read() const {
    const std::size_t layer = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    std::vector<float> out(layer * framebuffers_.size());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    for (std::size_t i = 0; i < framebuffers_.size(); ++i) {
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[i].name());
        glReadPixels(0, 0, width_, height_, GL_RED, GL_FLOAT, out.data() + i * layer);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("reading levels of lights");
    return out;
}

/// Drawn twice: the first time programs may be compiled.
double SampledShadows::timed(SampledShadowMethod method, const GeometryBuffer& geometry, const Camera& camera,
                             const SampledShadowOptions& options) {
    drawBy(method, geometry, camera, options);
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    drawBy(method, geometry, camera, options);
    glFinish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

GlName SampledShadows::draw(const GeometryBuffer& geometry, const Camera& camera, const std::vector<glm::dmat4>& nodes,
                            const SampledShadowOptions& options) {
    require(options.points >= 1 && options.points <= MappedShadows::kMostPoints,
            "sampled shadows: expected 1 to 64 points");
    require(!scene_.lights.empty(), "sampled shadows: expected a light");
    for (const SceneNode& node : scene_.nodes)
        if (node.volume >= 0)
            throw Error(fmt::format("sampled shadows: expected meshes alone, found a volume at node '{}'", node.name));
    follow(nodes);
    allocate(geometry.width(), geometry.height());
    if (options.method != SampledShadowMethod::Fastest) {
        choice_ = {options.method};
        chosen_ = false;
        drawBy(options.method, geometry, camera, options);
        return layers_->name();
    }
    if (chosen_) {
        drawBy(choice_.taken, geometry, camera, options);
        return layers_->name();
    }
    const std::vector<TracedLevel> truth = traceLevels(scene_, nodes_, geometry.read());
    choice_.volumeSeconds = timed(SampledShadowMethod::Volumes, geometry, camera, options);
    choice_.volumePsnr = psnrOf(read(), truth);
    choice_.mapSeconds = timed(SampledShadowMethod::Maps, geometry, camera, options);
    choice_.mapPsnr = psnrOf(read(), truth);
    const bool mapsNear = choice_.mapPsnr >= options.leastPsnr, volumesNear = choice_.volumePsnr >= options.leastPsnr;
    const bool maps = mapsNear != volumesNear ? mapsNear
                      : mapsNear              ? choice_.mapSeconds < choice_.volumeSeconds
                                              : choice_.mapPsnr > choice_.volumePsnr;
    choice_.taken = maps ? SampledShadowMethod::Maps : SampledShadowMethod::Volumes;
    chosen_ = true;
    if (choice_.taken == SampledShadowMethod::Volumes) drawBy(choice_.taken, geometry, camera, options);
    return layers_->name();
}

}  // namespace nacre
