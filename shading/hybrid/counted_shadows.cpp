#include "shading/hybrid/counted_shadows.hpp"

#include <epoxy/gl.h>
#include "core/error.hpp"
#include "core/sampling.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"
#include "shading/pass_state.hpp"

namespace nacre {
namespace {

constexpr int kBits = 7;  ///< of the stencil's g-count; the eighth is a borrow, which capped volumes never have

void fullscreenState(GlName framebuffer) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
}

}  // namespace

CountedShadows::CountedShadows(ProgramLoader& loader, const SceneDescription& scene,
                               const std::vector<glm::dmat4>& nodes)
    : loader_(loader), rays_(scene, nodes), nodes_(scene.nodes.size()) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const SceneNode& node = scene.nodes[i];
        if (node.mesh < 0 || !node.castsShadow) continue;
        ShadowMesh shape =
            makeShadowMesh(transformed(scene.meshes[static_cast<std::size_t>(node.mesh)].mesh, nodes.at(i)));
        if (shape.triangles.empty()) continue;
        GpuShadowPoints points(shape);
        objects_.push_back({std::move(shape), std::move(points), i});
    }
}

void CountedShadows::allocate(const GeometryBuffer& geometry) {
    width_ = geometry.width(), height_ = geometry.height();
    count_.emplace(width_, height_, geometry.depthBuffer());
    levels_.emplace(width_, height_);
}

void CountedShadows::begin(const GeometryBuffer& geometry, const Camera& camera) {
    if (geometry_ != &geometry || width_ != geometry.width() || height_ != geometry.height()) allocate(geometry);
    geometry_ = &geometry;
    worldToClip_ = camera.projection(double(width_) / height_) * camera.view();
    levels_->clear();
}

/// Nodes that are met on the way from some points of the view plane to the light.
std::vector<bool> CountedShadows::taggedNodes(const Vec4& light, int points) const {
    const std::vector<Vec3> window = nearWindow(glm::inverse(worldToClip_));  // corners in turn
    std::vector<bool> out(nodes_, false);
    for (int i = 0; i < points; ++i) {
        const Vec3 u = halton3(static_cast<std::uint64_t>(i) + 1);
        Vec3 from = glm::mix(glm::mix(window[0], window[1], u.x), glm::mix(window[3], window[2], u.x), u.y);
        const bool near = light.w != 0;
        double left = near ? glm::length(Vec3(light) / light.w - from) : 1e300;
        const Vec3 along = near ? (Vec3(light) / light.w - from) / left : glm::normalize(Vec3(light));
        while (const auto hit = rays_.firstHit(from, along)) {
            left -= glm::length(hit->place - from);
            if (left <= 0) break;
            out[hit->node] = true;
            from = hit->place;
        }
    }
    return out;
}

void CountedShadows::draw(const Object& object, const Vec4& light, bool counted, bool caps) {
    const ShadowVolume volume = makeShadowVolume(object.shape, glm::dmat4(1), light);
    if (volume.empty()) return;
    const GpuShadowVolume drawn(object.points, volume);
    glStencilMask(counted ? ~0u : 0);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glFrontFace(GL_CCW);
    drawn.drawSides();
    if (caps) {  // an end is left through its inner side
        ++capped_;
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        drawn.drawCaps(false, false);
        if (volume.farCap) drawn.drawCaps(true, false);
        glFrontFace(GL_CCW);
    }
    glBindVertexArray(0);
}

/// Adds the g-count, bit by bit; counts below 0, of volumes without ends, as 0.
void CountedShadows::addStencil() {
    const Program& program = loader_.load("fullscreen.vert.glsl", "counted_add.frag.glsl");
    fullscreenState(count_->framebuffer());
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    const VertexArray empty;
    for (int bit = 0; bit < kBits; ++bit) {
        glStencilFunc(GL_EQUAL, 1 << bit, static_cast<GLuint>((1 << bit) | (1 << kBits)));
        program.set("nacre_counted_value", static_cast<float>(1 << bit));
        drawFullscreen(empty);
    }
}

void CountedShadows::add(const Vec4& light, double weight, const CountedShadowOptions& options) {
    require(geometry_ != nullptr, "counted shadows: expected begin before add");
    require(options.planePoints >= 1, "counted shadows: expected at least one point of the view plane");
    const std::vector<bool> tagged = options.capping == VolumeCapping::Approximate
                                         ? taggedNodes(light, options.planePoints)
                                         : std::vector<bool>(nodes_, options.capping == VolumeCapping::Exact);
    const Program& volume =
        loader_.load("stencil_volume.vert.glsl", "counted_volume.frag.glsl", {{"NACRE_STENCIL_BEYOND_NEAR", "1"}});
    volume.set("nacre_world_to_clip", glm::mat4(worldToClip_));
    volume.set("nacre_stencil_light", glm::vec4(light));
    setModel(volume, glm::dmat4(1));
    glBindFramebuffer(GL_FRAMEBUFFER, count_->framebuffer());
    glViewport(0, 0, width_, height_);
    const GLfloat zero[] = {0, 0, 0, 0};
    const GLint none = 0;
    glStencilMask(~0u);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glClearBufferfv(GL_COLOR, 0, zero);
    glClearBufferiv(GL_STENCIL, 0, &none);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_FALSE);
    glEnable(GL_DEPTH_CLAMP);  // sides go on beyond the far plane
    glEnable(GL_CLIP_DISTANCE0);
    glDisable(GL_CULL_FACE);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_ALWAYS, 0, ~0u);
    glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_DECR_WRAP, GL_DECR_WRAP);
    glStencilOpSeparate(GL_BACK, GL_KEEP, GL_INCR_WRAP, GL_INCR_WRAP);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    capped_ = 0;
    const bool open = options.capping == VolumeCapping::None;
    for (const Object& object : objects_) draw(object, light, open || tagged[object.node], tagged[object.node]);
    glStencilMask(~0u);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDisable(GL_CLIP_DISTANCE0);
    glDisable(GL_DEPTH_CLAMP);
    addStencil();
    glDisable(GL_STENCIL_TEST);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
    const Program& mask = loader_.load("fullscreen.vert.glsl", "counted_mask.frag.glsl");
    levels_->beginAdding(weight);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, count_->texture());
    mask.set("nacre_counted_image", 0);
    mask.set("nacre_counted_value", static_cast<float>(weight));
    drawFullscreen(VertexArray());
    glBindTexture(GL_TEXTURE_2D, 0);
    levels_->endAdding();
    checkGl("counting shadows");
}

Image CountedShadows::read(ShadowFilter filter) {
    require(geometry_ != nullptr, "counted shadows: expected begin before read");
    return levels_->read(loader_, *geometry_, filter);
}

const ShadowLevels& CountedShadows::levels() const {
    require(geometry_ != nullptr, "counted shadows: expected begin before levels");
    return *levels_;
}

}  // namespace nacre
