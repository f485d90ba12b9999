// Objects that shadow each other: HEMI section 4.1's projection of coarse stand-ins onto the receiver's light.
#include <fmt/format.h>

#include "core/shadow_view.hpp"
#include "demos/recipe.hpp"
#include "demos/stage.hpp"
#include "demos/transfer_study.hpp"
#include "shading/primitives.hpp"
#include "shading/timing.hpp"
#include "transfer/proxy_shadow.hpp"

namespace nacre {
namespace {

constexpr int kOrder = 6;  ///< light has 4; what is hidden of it has edges
constexpr std::size_t kCount = (kOrder + 1) * (kOrder + 1);
constexpr std::size_t kProxyTriangles = 200;
constexpr int kFloorVertices = 41;
const Rgb kAlbedo(0.8);

/// One object of the scene: its own transfer, and what it casts.
struct Object {
    std::vector<glm::vec3> positions;
    SelfTransfer transfer;
    ShadowProxy proxy;
    TransferFrame frame;
    std::size_t first = 0;  ///< its first vertex among all objects'
};

Object objectOf(AnimatedMesh mesh, const char* name) {
    WeldedMesh welded = weldMesh(mesh, name);
    std::vector<glm::vec3> positions = weldedPositions(welded, mesh.frames[0]);
    ShadowProxy proxy(welded, positions, kProxyTriangles);
    proxy.move(positions);
    SelfTransfer transfer(std::move(welded), positions, {.order = kOrder});
    TransferFrame frame = transfer.compute(positions);
    return {std::move(positions), std::move(transfer), std::move(proxy), std::move(frame)};
}

/// The motion's frame turned about y and moved.
AnimatedMesh placed(const AnimatedMesh& motion, std::size_t frame, double angle, const Vec3& by) {
    AnimatedMesh out{motion.triangles, motion.uvs, {motion.frames[frame]}};
    const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    for (glm::vec3& p : out.frames[0]) p = glm::vec3(c * p.x + s * p.z, p.y, c * p.z - s * p.x) + glm::vec3(by);
    return out;
}

AnimatedMesh floorBelow(const Bounds& bounds) {
    const double edge = 1.3 * std::max(bounds.high.x - bounds.low.x, bounds.high.z - bounds.low.z);
    const Vec3 middle = 0.5 * (bounds.low + bounds.high);
    AnimatedMesh out;
    out.frames.emplace_back();
    for (int z = 0; z < kFloorVertices; ++z)
        for (int x = 0; x < kFloorVertices; ++x)
            out.frames[0].emplace_back(middle.x + edge * (x / double(kFloorVertices - 1) - 0.5), bounds.low.y,
                                       middle.z + edge * (z / double(kFloorVertices - 1) - 0.5));
    for (unsigned z = 0; z + 1 < kFloorVertices; ++z)
        for (unsigned x = 0; x + 1 < kFloorVertices; ++x) {
            const unsigned i = z * kFloorVertices + x;
            out.triangles.push_back({i, i + kFloorVertices, i + 1});
            out.triangles.push_back({i + 1, i + kFloorVertices, i + kFloorVertices + 1});
        }
    return out;
}

/// How many lights each object has.
struct Cells {
    glm::ivec3 figure, floor;
};

/// Two figures on a floor.
class Group {
public:
    Group(const Task& task, AnimatedMesh a, AnimatedMesh b, std::size_t rays) : loader_(task.loader) {
        Bounds bounds;
        for (const AnimatedMesh* mesh : {&a, &b})
            for (const glm::vec3& p : mesh->frames[0]) bounds.add(Vec3(p));
        objects_.push_back(objectOf(std::move(a), "one figure"));
        objects_.push_back(objectOf(std::move(b), "the other figure"));
        objects_.push_back(objectOf(floorBelow(bounds), "the floor"));
        for (Object& object : objects_) {
            object.first = positions_.size();
            for (glm::uvec3 t : object.transfer.mesh().triangles)
                triangles_.push_back(t + glm::uvec3(static_cast<std::uint32_t>(object.first)));
            positions_.insert(positions_.end(), object.positions.begin(), object.positions.end());
            normals_.insert(normals_.end(), object.frame.normals.begin(), object.frame.normals.end());
        }
        std::vector<std::uint32_t> all(positions_.size());
        for (std::uint32_t v = 0; v < all.size(); ++v) all[v] = v;
        const std::vector<double> traced = tracedTransfer(triangles_, positions_, normals_, all, kOrder, rays);
        truth_.assign(traced.begin(), traced.end());
        gpu_.emplace(triangles_, all);
        camera_.fovY = 0.5;
        camera_.target = 0.5 * (bounds.low + bounds.high);
        const double radius = glm::length(bounds.high - bounds.low);
        camera_.eye = camera_.target + radius / std::sin(camera_.fovY / 2) / 1.9 * directionFromDeg(25, 28);
        camera_.near = 0.2 * radius, camera_.far = 12 * radius;
    }

    /// \param cells  none: objects don't shadow each other
    std::vector<glm::vec3> radiance(const LightCoefficients& light, const std::optional<Cells>& cells) const {
        std::vector<glm::vec3> out;
        for (std::size_t i = 0; i < objects_.size(); ++i) {
            const Object& object = objects_[i];
            std::vector<const ShadowProxy*> others;
            for (std::size_t other = 0; other < objects_.size(); ++other)
                if (other != i && cells) others.push_back(&objects_[other].proxy);
            const LightGrid grid = shadowedLights(projector_, light, object.positions,
                                                  !cells  ? glm::ivec3(1)
                                                  : i < 2 ? cells->figure
                                                          : cells->floor,
                                                  others);
            const std::vector<glm::vec3> one =
                exitantRadiance(object.frame.coefficients, object.positions, grid, kAlbedo);
            out.insert(out.end(), one.begin(), one.end());
        }
        return out;
    }
    std::vector<glm::vec3> tracedRadiance(const LightCoefficients& light) const {
        return exitantRadiance(truth_, light, kAlbedo);
    }

    /// The objects' own transfer.
    void computeEach() const {
        for (const Object& object : objects_) object.transfer.compute(object.positions);
    }

    /// √(Σ |found − truth|² / Σ |truth|²) over the vertices of objects first to end − 1.
    double error(std::span<const glm::vec3> found, std::span<const glm::vec3> truth, std::size_t first,
                 std::size_t end) const {
        const std::size_t last = end < objects_.size() ? objects_[end].first : positions_.size();
        double off = 0, all = 0;
        for (std::size_t v = objects_[first].first; v < last; ++v) {
            const Vec3 d = Vec3(found[v]) - Vec3(truth[v]), t = truth[v];
            off += glm::dot(d, d), all += glm::dot(t, t);
        }
        return std::sqrt(off / all);
    }

    void draw(const RenderTarget& target, std::span<const glm::vec3> radiance) {
        gpu_->update(positions_, radiance);
        renderVertexLight(loader_, target, *gpu_, camera_);
    }

    AnimatedMesh joined() const { return {triangles_, {}, {positions_}}; }
    std::size_t vertexCount() const { return positions_.size(); }

private:
    ProgramLoader& loader_;
    LightProjector projector_{kOrder};
    std::vector<Object> objects_;
    std::vector<glm::uvec3> triangles_;
    std::vector<glm::vec3> positions_, normals_;
    std::vector<float> truth_;
    std::optional<GpuVertexLight> gpu_;
    Camera camera_;
};

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

/// Two frames of the figure beside each other; rings where its file isn't there.
std::pair<AnimatedMesh, AnimatedMesh> figures(const Task& task) {
    const ShownMotion motion = openMotion(task, {"mrfixit.iqm", "A skinned figure", {0.1, 0.7}, 25, 12, 1.3});
    if (motion.standsIn) {
        const Mesh ring = makeTorus(1, 0.4f, 48, 24);
        const AnimatedMesh mesh{ring.triangles, {}, {ring.positions}};
        return {placed(mesh, 0, 0, {-1.2, 0, 0}), placed(mesh, 0, 0, {1.7, 0, 0.4})};
    }
    Bounds bounds;
    for (const glm::vec3& p : motion.animation.frames[motion.frames[0]]) bounds.add(Vec3(p));
    const double apart = 1.0 * (bounds.high.x - bounds.low.x);
    return {placed(motion.animation, motion.frames[0], 0, {-0.5 * apart, 0, 0}),
            placed(motion.animation, motion.frames[1], -0.9, {0.5 * apart, 0, 0.2 * apart})};
}

}  // namespace

Exhibit transferObjectsExhibit(const Task& task) {
    const std::size_t rays = task.options.quick ? 256 : 1024;
    report(task.options.progress, task.id + ": rays at the vertices", 0);
    auto [a, b] = figures(task);
    Group group(task, std::move(a), std::move(b), rays);
    const TransferLight light = transferLight(task, "interior");
    LightCoefficients l = light.coefficients.coefficients;
    l.resize(kCount, Rgb(0));
    const std::vector<glm::vec3> truth = group.tracedRadiance(l);
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    const RaytracedPicture traced =
        pictureOf([&](const RenderTarget& target) { group.draw(target, truth); }, task.size(320));
    const std::pair<const char*, std::optional<Cells>> settings[] = {
        {"each object alone", std::nullopt},
        {"one light an object (HEMI)", Cells{glm::ivec3(1), glm::ivec3(1)}},
        {"figures 2 x 4 x 2, floor 8 x 1 x 8", Cells{{2, 4, 2}, {8, 1, 8}}},
        {"figures 4 x 8 x 4, floor 24 x 1 x 24", Cells{{4, 8, 4}, {24, 1, 24}}}};
    ExhibitTable table{{"lights", "error of figures", "error of the floor", "ms a frame"}, {}};
    std::vector<std::function<void()>> timed;
    for (const auto& [title, cells] : settings) {
        builder.row(title, cells && cells->floor.x > 1);
        builder.panel(
            "", [&group, &l, c = cells](const RenderTarget& target) { group.draw(target, group.radiance(l, c)); },
            traced);
        const std::vector<glm::vec3> found = group.radiance(l, cells);
        table.rows.push_back(
            {title, percent(group.error(found, truth, 0, 2)), percent(group.error(found, truth, 2, 3)), ""});
        timed.emplace_back([&group, &l, c = cells] {
            group.computeEach();
            group.radiance(l, c);
        });
    }
    AnimatedMesh all = group.joined();
    WeldedMesh welded = weldMesh(all, "all objects");
    const std::vector<glm::vec3> rest = weldedPositions(welded, all.frames[0]);
    const SelfTransfer together(std::move(welded), rest, {.order = kOrder});
    timed.emplace_back([&] { together.compute(rest); });
    const std::vector<float> shared = together.compute(rest).coefficients;
    std::vector<glm::vec3> found;
    for (const std::uint32_t w : together.mesh().weldOf) {
        const std::vector<glm::vec3> one = exitantRadiance(std::span(shared).subspan(w * kCount, kCount), l, kAlbedo);
        found.push_back(one[0]);
    }
    table.rows.push_back({"all objects as one mesh", percent(group.error(found, truth, 0, 2)),
                          percent(group.error(found, truth, 2, 3)), ""});
    const std::vector<double> seconds = medianFrameSeconds(timed, {.repeats = task.options.timingRepeats});
    for (std::size_t i = 0; i < seconds.size(); ++i) table.rows[i][3] = fmt::format("{:.2f}", 1e3 * seconds[i]);
    Exhibit e;
    e.section = "Self-shadows of moving meshes (HEMI)";
    e.title = "Objects that shadow each other (section 4.1)";
    e.caption = fmt::format(
        "Each object's transfer knows itself alone. What the others hide is projected onto its light: a level of about "
        "{} triangles is drawn into two masks of 32 x 32 bits at the object's middle, and the hidden light's "
        "coefficients are taken away. One light for a whole object is what the paper suggests; it can't put a shadow "
        "anywhere on a floor. Lights at the middles of a grid's cells over the object's box, blended between, can: "
        "their number is the knob. Errors are of radiance, all vertices together, against {} rays a vertex through "
        "all objects. Times are of transfer and light of all vertices; the last row is self-transfer of everything.",
        kProxyTriangles, rays);
    e.scene = fmt::format("Two figures on a floor, {} vertices; {}; albedo 0.8.", group.vertexCount(), light.words);
    e.table = std::move(table);
    builder.finish(e);
    return e;
}

}  // namespace nacre
