#include "demos/transfer_study.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/shadow_view.hpp"
#include "demos/picture.hpp"
#include "demos/recipe.hpp"
#include "demos/stage.hpp"
#include "reference/raytrace.hpp"
#include "shading/motion.hpp"
#include "shading/timing.hpp"
#include "transfer/chess.hpp"
#include "transfer/exitant_radiance.hpp"
#include "transfer/front_facing.hpp"
#include "transfer/mask_tables.hpp"

namespace nacre {
namespace {

constexpr int kOrder = 4;
constexpr std::size_t kCoefficients = (kOrder + 1) * (kOrder + 1);
constexpr double kAlbedo = 0.8;

bool isFile(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored);
}

ShownMotion motionOf(const Task& task, const TransferModel& model) {
    const std::filesystem::path folder = task.options.animatedFolder, pieces = folder / "chess",
                                file = folder / model.motion;
    if (model.boardVertices > 0)
        return {chessAnimation(turnedChessSet(), {.boardVertices = model.boardVertices}), {}, {}, ""};
    MotionOptions options;
    if (model.motion == "chess" && isFile(pieces / "king.obj")) {
        options.chessPieces = pieces;
        return {loadMotion("chess", options), {}, {}, ""};
    }
    if (model.motion == "chess" || model.motion == "cloth") return {loadMotion(model.motion), {}, {}, model.motion};
    if (isFile(file)) return {loadMotion(file.string()), {}, {}, shellQuoted(file.string())};
    task.notes.push_back(
        fmt::format("{}: {} is not there (demos/fetch.sh gets it): another cloth stands in", task.id, file.string()));
    options.frames = 120;
    options.seed = 7;
    return {loadMotion("cloth", options), {}, {}, "", true};
}

Camera cameraOf(const ShownMotion& motion, const TransferModel& model) {
    Bounds bounds;
    for (const std::size_t f : motion.frames)
        for (const glm::vec3& p : motion.animation.frames[f]) bounds.add(Vec3(p));
    const double radius = glm::length(bounds.high - bounds.low) / 2;
    Camera camera;
    camera.fovY = 0.5;
    camera.target = 0.5 * (bounds.low + bounds.high);
    const double distance = radius / std::sin(camera.fovY / 2) / model.zoom;
    camera.eye = camera.target + distance * directionFromDeg(model.azimuthDeg, model.elevationDeg);
    camera.near = std::max(0.02 * distance, distance - 1.1 * radius);
    camera.far = distance + 1.1 * radius;
    return camera;
}

std::vector<glm::vec3> radianceOf(std::span<const float> transfer, const SphericalHarmonics& light) {
    return exitantRadiance(transfer, light.coefficients, Rgb(kAlbedo));
}

/// U_l √(4π/(2l + 1)) y_lm(n): the zonal transfer turned to the normal.
std::vector<float> openVectors(std::span<const glm::vec3> normals) {
    const std::vector<double> zonal = openTransfer(kOrder);
    std::vector<float> out(normals.size() * kCoefficients, 0);
    for (std::size_t v = 0; v < normals.size(); ++v) {
        if (normals[v] == glm::vec3(0)) continue;
        const std::vector<double> y = realHarmonics(kOrder, normals[v]);
        for (std::size_t l = 0; l <= kOrder; ++l)
            for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i)
                out[v * kCoefficients + i] =
                    static_cast<float>(zonal[l] * std::sqrt(4 * kPi / (2.0 * static_cast<double>(l) + 1)) * y[i]);
    }
    return out;
}

/// Of all vertices; 0 for those of no triangle, which have no normal.
std::vector<double> truthOf(const WeldedMesh& mesh, std::span<const glm::vec3> positions,
                            std::span<const glm::vec3> normals, std::size_t rays) {
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < normals.size(); ++v)
        if (normals[v] != glm::vec3(0)) vertices.push_back(v);
    const std::vector<double> found = tracedTransfer(mesh.triangles, positions, normals, vertices, kOrder, rays);
    std::vector<double> out(normals.size() * kCoefficients, 0);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        std::copy_n(found.begin() + static_cast<std::ptrdiff_t>(i * kCoefficients), kCoefficients,
                    out.begin() + static_cast<std::ptrdiff_t>(vertices[i] * kCoefficients));
    return out;
}

SelfTransfer transferOf(const AnimatedMesh& animation, const SelfTransferOptions& options) {
    WeldedMesh mesh = weldMesh(animation, "the exhibit's mesh");
    const std::vector<glm::vec3> rest = weldedPositions(mesh, animation.frames[0]);
    const std::vector<std::vector<glm::vec3>> poses = motionPoses(mesh, animation);
    return {std::move(mesh), rest, options, poses};
}

}  // namespace

ShownMotion openMotion(const Task& task, const TransferModel& model) {
    ShownMotion out = motionOf(task, model);
    const double count = static_cast<double>(out.animation.frames.size());
    for (const double share : model.shown) out.frames.push_back(static_cast<std::size_t>(share * count));
    out.camera = cameraOf(out, model);
    return out;
}

TransferStudy::TransferStudy(ProgramLoader& loader, const ShownMotion& motion, std::size_t rays,
                             const SelfTransferOptions& options)
    : loader_(loader),
      camera_(motion.camera),
      transfer_(transferOf(motion.animation, options)),
      gpu_(motion.animation.triangles, transfer_.mesh().weldOf) {
    for (const std::size_t f : motion.frames)
        addFrame(weldedPositions(transfer_.mesh(), motion.animation.frames[f]), rays);
}

void TransferStudy::addFrame(std::vector<glm::vec3> positions, std::size_t rays) {
    TransferStudyFrame frame;
    TransferFrame found = transfer_.compute(positions);
    const std::vector<double> truth = truthOf(transfer_.mesh(), positions, found.normals, rays);
    frame.truth.assign(truth.begin(), truth.end());
    frame.open = openVectors(found.normals);
    frame.error = transferError(found.coefficients, truth, kCoefficients);
    frame.withoutShadows = transferError(frame.open, truth, kCoefficients);
    frame.listed = found.listed, frame.drawn = found.drawn, frame.seconds = found.seconds;
    frame.positions = std::move(positions), frame.normals = std::move(found.normals);
    frames_.push_back(std::move(frame));
}

void TransferStudy::draw(const RenderTarget& target, std::size_t frame, std::span<const glm::vec3> radiance) {
    gpu_.update(frames_[frame].positions, radiance);
    renderVertexLight(loader_, target, gpu_, camera_);
}

TransferStudy::Draw TransferStudy::shadowed(std::size_t frame, const SphericalHarmonics& light) {
    return [this, frame, &light](const RenderTarget& target) {
        const std::vector<glm::vec3>& positions = frames_[frame].positions;
        const TransferFrame found = transfer_.compute(positions, frontFacing(transfer_.mesh(), positions, camera_.eye));
        draw(target, frame, radianceOf(found.coefficients, light));
    };
}

TransferStudy::Draw TransferStudy::withoutShadows(std::size_t frame, const SphericalHarmonics& light) {
    return [this, frame, &light](const RenderTarget& target) {
        draw(target, frame, radianceOf(frames_[frame].open, light));
    };
}

TransferStudy::Draw TransferStudy::rayTraced(std::size_t frame, const SphericalHarmonics& light) {
    return [this, frame, &light](const RenderTarget& target) {
        draw(target, frame, radianceOf(frames_[frame].truth, light));
    };
}

RaytracedPicture pictureOf(const TransferStudy::Draw& draw, int size) {
    const RenderTarget target({.width = kSupersample * size, .height = kSupersample * size});
    target.clear();
    draw(target);
    return {halved(target.read()), channelOf(halved(target.read(4)), 3)};
}

RaytracedPicture TransferStudy::tracedPixels(std::size_t frame, const SphericalHarmonics& light, int size,
                                             std::size_t rays) const {
    const TransferStudyFrame& f = frames_[frame];
    Mesh mesh;
    mesh.positions = f.positions, mesh.normals = f.normals, mesh.triangles = transfer_.mesh().triangles;
    mesh.tangents.assign(f.positions.size(), glm::vec4(0));
    mesh.uvs.assign(f.positions.size(), glm::vec2(0));
    const TracedSurface surface =
        traceSurface(mesh, camera_, {.width = size, .height = size, .supersample = kSupersample});
    std::vector<glm::vec3> positions = f.positions, normals = f.normals;  // and the samples' after them, in no triangle
    std::vector<std::uint32_t> samples;
    for (const SurfacePoint& p : surface.points) {
        if (!TracedSurface::hit(p)) continue;
        samples.push_back(static_cast<std::uint32_t>(positions.size()));
        positions.emplace_back(p.position), normals.emplace_back(p.normal);
    }
    const std::vector<double> vectors = tracedTransfer(mesh.triangles, positions, normals, samples, kOrder, rays);
    const std::vector<glm::vec3> found = radianceOf(std::vector<float>(vectors.begin(), vectors.end()), light);
    std::vector<Rgb> radiance(surface.points.size(), Rgb(0));
    std::size_t next = 0;
    for (std::size_t i = 0; i < radiance.size(); ++i)
        if (TracedSurface::hit(surface.points[i])) radiance[i] = found[next++];
    return assemblePicture(surface, radiance);
}

TransferStudy::Seconds TransferStudy::secondsAFrame(int repeats) const {
    std::vector<std::function<void()>> computations;
    for (const TransferStudyFrame& f : frames_) {
        computations.emplace_back([this, &f] { transfer_.compute(f.positions); });
        computations.emplace_back(
            [this, &f] { transfer_.compute(f.positions, frontFacing(transfer_.mesh(), f.positions, camera_.eye)); });
    }
    const std::vector<double> seconds = medianFrameSeconds(computations, {.repeats = repeats});
    Seconds out;
    for (std::size_t i = 0; i < seconds.size(); ++i)
        (i % 2 == 0 ? out.all : out.facing) += seconds[i] / static_cast<double>(frames_.size());
    return out;
}

TransferLight transferLight(const Task& task, const std::string& surrounding) {
    const Surrounding s = task.open(surrounding);
    return {projectEnvironment(s.map, kOrder), s.file, s.words};
}

}  // namespace nacre
