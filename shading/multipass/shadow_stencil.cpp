#include "shading/multipass/shadow_stencil.hpp"

#include <epoxy/gl.h>

#include <algorithm>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"
#include "shading/multipass/stencil_counter.hpp"
#include "shading/pass_state.hpp"

namespace nacre {
namespace {

constexpr StencilCounter kCounter;
constexpr GLuint kAll = kCounter.range() - 1, kShadowMin = kCounter.shadowMin(), kShadowZero = kCounter.shadowZero();
constexpr GLuint kCounts =
    kShadowMin - 1;  ///< mask of the bits that count; the highest count that isn't taken for none

const void* offset(std::size_t indices) { return reinterpret_cast<const void*>(indices * sizeof(std::uint32_t)); }

bool reachesBeyondFar(const Bounds& box, const glm::dmat4& worldToClip) {
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                     corner & 4 ? box.high.z : box.low.z);
        const Vec4 clip = worldToClip * Vec4(p, 1);
        if (clip.z >= clip.w) return true;
    }
    return false;
}

/// Of a volume's program: what of its triangles counts.
constexpr unsigned kBeyondFar = 1;  ///< what is beyond the far plane
constexpr unsigned kClipped = 2;    ///< what is in front of the sight's clip plane
constexpr unsigned kCut = 4;        ///< what is in front of the volume's cuts

bool isParallel(const glm::dmat4& worldToClip) {
    return worldToClip[0][3] == 0 && worldToClip[1][3] == 0 && worldToClip[2][3] == 0;
}

void frontFaces(bool clockwise) { glFrontFace(clockwise ? GL_CW : GL_CCW); }

}  // namespace

GpuShadowPoints::GpuShadowPoints(const ShadowMesh& mesh) {
    require(!mesh.positions.empty(), "shadow volume: a mesh without points");
    std::vector<glm::vec4> points;
    for (const glm::vec3& p : mesh.positions) points.insert(points.end(), {glm::vec4(p, 0), glm::vec4(p, 1)});
    std::vector<std::uint32_t> triangles;
    for (const glm::uvec3& t : mesh.triangles) triangles.insert(triangles.end(), {2 * t.x, 2 * t.y, 2 * t.z});
    const std::size_t pointBytes = points.size() * sizeof(glm::vec4);
    const std::size_t listBytes = triangles.size() * sizeof(std::uint32_t);
    bytes_ = pointBytes + listBytes;
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(pointBytes), points.data(), GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(glm::vec4), nullptr);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles_.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(listBytes), triangles.data(), GL_STATIC_DRAW);
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    checkGl("uploading a shadow volume's points");
}

GpuShadowVolume::GpuShadowVolume(const GpuShadowPoints& points, const ShadowVolume& volume,
                                 const GpuShadowPoints* pieces)
    : points_(&points), farPoints_(pieces ? pieces : &points), shape_(volume), bytes_(volume.bytes()) {
    require(volume.cut == (pieces != nullptr), "shadow volume: pieces belong to the volumes of cut meshes");
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, farPoints_->buffer_.name());
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(glm::vec4), nullptr);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(volume.indices.size() * sizeof(std::uint32_t)),
                 volume.indices.data(), GL_DYNAMIC_DRAW);
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    shape_.indices = {};
    checkGl("uploading a shadow volume");
}

void GpuShadowVolume::drawSides() const {
    glBindVertexArray(array_.name());
    for (const ShadowVolume::Sides& s : shape_.sides)
        for (int i = 0; i < s.times; ++i)
            glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(s.count), GL_UNSIGNED_INT, offset(s.first));
}

void GpuShadowVolume::drawCaps(bool far, bool mirrored) const {
    const ShadowVolume::Caps& caps = far && shape_.cut ? shape_.farCaps : shape_.caps;
    glBindVertexArray((far ? farPoints_ : points_)->array_.name());
    for (const bool turned : {false, true}) {
        frontFaces(mirrored != (turned != far));
        for (const ShadowVolume::Run& run : turned ? caps.turned : caps.facing)
            glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(3 * run.count), GL_UNSIGNED_INT,
                                     offset(3 * std::size_t(run.first)), far ? 1 : 0);
    }
}

ShadowSight ShadowSight::of(const Camera& camera, double aspect) {
    ShadowSight out;
    out.worldToClip = camera.projection(aspect) * camera.view();
    out.window = nearWindow(glm::inverse(out.worldToClip));
    return out;
}

ShadowSight ShadowSight::of(const SpecularView& view) { return {view.toClip, view.mirrored, {}, view.clip}; }

static void requireDesktop() {
    if (!epoxy_is_desktop_gl())
        throw Error("shadow volumes: expected desktop OpenGL 3.3, which clamps depths, found OpenGL ES");
}

ShadowStencil::ShadowStencil(ProgramLoader& loader)
    : loader_(&loader), fill_((requireDesktop(), loader.load("fullscreen.vert.glsl", "stencil.frag.glsl"))) {}

/// Puts the program of a kind in use.
void ShadowStencil::place(unsigned kind, const PlacedShadowVolume& placed, const Vec4& light,
                          const ShadowSight& sight) {
    if (!volumes_[kind]) {
        ShaderDefines defines;
        if (kind & kBeyondFar) defines.emplace_back("NACRE_STENCIL_BEYOND_FAR", "1");
        if (kind & kClipped) defines.emplace_back("NACRE_VIEW", "1");
        if (kind & kCut) defines.emplace_back("NACRE_STENCIL_CUT", "1");
        volumes_[kind] = &loader_->load("stencil_volume.vert.glsl", "stencil.frag.glsl", defines);
    }
    const Program& program = *volumes_[kind];
    program.set("nacre_world_to_clip", glm::mat4(sight.worldToClip));
    program.set("nacre_stencil_light", glm::vec4(light));
    program.set("nacre_stencil_nearer", isParallel(sight.worldToClip) ? 1e-5f : 0.0f);
    if (kind & kClipped) program.set("nacre_view_clip", glm::vec4(*sight.clip));
    if (kind & kCut) {
        std::array<glm::vec4, kMostCuts> cuts;
        cuts.fill(glm::vec4(0, 0, 0, 1));
        std::copy(placed.cuts.begin(), placed.cuts.end(), cuts.begin());
        program.set("nacre_stencil_cut", cuts);
    }
    setModel(program, placed.toWorld);
    program.use();
    (kind & (kBeyondFar | kClipped) ? glEnable : glDisable)(GL_CLIP_DISTANCE0);
}

/// One triangle over the target, where (stencil & mask) = (reference & mask).
void ShadowStencil::everywhere(unsigned reference, unsigned mask, unsigned op, unsigned writes) const {
    glDisable(GL_DEPTH_TEST);
    glStencilFunc(GL_EQUAL, static_cast<GLint>(reference), mask);
    glStencilOp(GL_KEEP, GL_KEEP, op);
    glStencilMask(writes);
    fill_.use();
    drawFullscreen(empty_);
    glEnable(GL_DEPTH_TEST);
}

void ShadowStencil::begin(const RenderTarget& target, int level) {
    require(level >= 0 && level <= kCounter.deepest(), "shadow volumes: a view's level must be below SHAD_MIN");
    setDrawState(target);
    glDepthMask(GL_FALSE);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glEnable(GL_STENCIL_TEST);
    level_ = static_cast<unsigned>(level);
    everywhere(level_, kAll, GL_INVERT, kShadowZero);
    layers_ = 0;
    settled_ = zPasses_ = zFails_ = 0;
}

/// What a count has in the stencil: SHAD_ZERO and what is added, modulo 128 below SHAD_MIN's bit.
unsigned ShadowStencil::valueOf(unsigned count) const {
    return kShadowMin | (((level_ ^ kShadowZero) + count) & kCounts);
}

void ShadowStencil::count(const RenderTarget& target, std::span<const PlacedShadowVolume> volumes, const Vec4& light,
                          const ShadowSight& sight, ShadowCounting counting, bool levels) {
    target.bind();
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDepthMask(GL_FALSE);
    for (const PlacedShadowVolume& placed : volumes) {
        if (!levels && level_ == 0 && layers_ > 0 && layers_ + placed.mostLayers > kCounts) settle(target);
        layers_ += placed.mostLayers;
        glStencilFunc(GL_EQUAL, static_cast<GLint>(kShadowMin), kShadowMin);
        glStencilMask(kCounts);
        const bool pass = counting == ShadowCounting::Auto
                              ? !placed.image && !sight.window.empty() && windowIsLit(sight.window, placed.box, light)
                              : counting == ShadowCounting::ZPass;
        if (pass)
            drawZPass(placed, light, sight);
        else
            drawZFail(placed, light, sight);
        ++(pass ? zPasses_ : zFails_);
    }
    glBindVertexArray(0);
    glFrontFace(GL_CCW);
    checkGl("counting shadow volumes");
}

/// Faces between the eye and the visible point. Its depth isn't clamped: what is before the window doesn't count.
void ShadowStencil::drawZPass(const PlacedShadowVolume& placed, const Vec4& light, const ShadowSight& sight) {
    glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_KEEP, GL_INCR_WRAP);
    glStencilOpSeparate(GL_BACK, GL_KEEP, GL_KEEP, GL_DECR_WRAP);
    place(0, placed, light, sight);
    frontFaces(sight.mirrored != placed.mirrored);
    placed.volume->drawSides();
}

/// Faces behind the visible point, or at its depth. Near caps are drawn as the mesh itself was, clipped alike, so that
/// a point of the mesh finds its own triangle at its own depth, behind it; what of them is beyond the far plane, where
/// the mesh wasn't drawn, is clamped to it.
void ShadowStencil::drawZFail(const PlacedShadowVolume& placed, const Vec4& light, const ShadowSight& sight) {
    const GpuShadowVolume& volume = *placed.volume;
    const bool mirrored = sight.mirrored != placed.mirrored;
    glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_DECR_WRAP, GL_KEEP);
    glStencilOpSeparate(GL_BACK, GL_KEEP, GL_INCR_WRAP, GL_KEEP);
    const unsigned cut = volume.shape().cut ? kCut : 0;
    // Of an image no pixel has the depth of a near cap: it is clamped as sides are.
    if (placed.image) glEnable(GL_DEPTH_CLAMP);
    place(cut | (sight.clip && !placed.image ? kClipped : 0), placed, light, sight);
    volume.drawCaps(false, mirrored);
    glEnable(GL_DEPTH_CLAMP);
    if (!placed.image && !sight.clip && reachesBeyondFar(placed.box, sight.worldToClip)) {
        place(cut | kBeyondFar, placed, light, sight);
        volume.drawCaps(false, mirrored);
    }
    place(0, placed, light, sight);
    frontFaces(mirrored);
    volume.drawSides();
    if (volume.shape().farCap) volume.drawCaps(true, mirrored);
    glDisable(GL_DEPTH_CLAMP);
}

/// A finished count isn't negative: 192 + 1 … 255, or 128 … 191 from 64 on. Those pixels get level 0 back.
void ShadowStencil::settle(const RenderTarget& target) {
    target.bind();
    glDisable(GL_DEPTH_TEST);
    glStencilOp(GL_KEEP, GL_KEEP, GL_ZERO);
    glStencilMask(kAll);
    glStencilFunc(GL_LESS, static_cast<GLint>(kShadowZero), kAll);
    fill_.use();
    drawFullscreen(empty_);
    everywhere(kShadowMin, kShadowZero, GL_ZERO, kAll);
    layers_ = 0;
    ++settled_;
}

void ShadowStencil::narrow(const RenderTarget& target, const PlacedShadowVolume& face, const Vec4& light,
                           const ShadowSight& sight) {
    count(target, {&face, 1}, light, sight);
    everywhere(valueOf(0), kAll, GL_INVERT, valueOf(0) ^ level_);
    everywhere(valueOf(0), kShadowMin, GL_REPLACE, kAll);
    layers_ = 0;
}

void ShadowStencil::lit(unsigned count) {
    require(count == 0 || level_ == 0, "shadow volumes: other counts than zero are for the camera's own view");
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glStencilFunc(GL_EQUAL, static_cast<GLint>(valueOf(count)), kAll);
    glStencilOp(GL_KEEP, GL_KEEP, count == 0 ? GL_INVERT : GL_ZERO);
    glStencilMask(count == 0 ? kShadowZero : kAll);
}

void ShadowStencil::end(const RenderTarget& target) {
    target.bind();
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDisable(GL_DEPTH_TEST);
    glStencilFunc(GL_NOTEQUAL, static_cast<GLint>(level_), kShadowMin);  // every pixel of the count
    glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    glStencilMask(kAll);
    fill_.use();
    drawFullscreen(empty_);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_STENCIL_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
}

}  // namespace nacre
