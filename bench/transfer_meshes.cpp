#include "bench/transfer_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>

#include "core/error.hpp"
#include "core/math.hpp"
#include "shading/motion.hpp"

namespace nacre::bench {
namespace {

namespace fs = std::filesystem;

struct Source {
    const char *name, *file;
};
constexpr Source kSources[] = {
    {"runner", "Testwuson.X"}, {"dancer", "BCN_Epileptic.X"}, {"fixer", "mrfixit.iqm"}, {"hand", "hand.glb"}};

std::optional<fs::path> find(const fs::path& folder, const std::string& file) {
    std::error_code failed;
    std::vector<fs::path> found;
    for (fs::recursive_directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed))
        if (it->path().filename() == file) found.push_back(it->path());
    if (found.empty()) return std::nullopt;
    return *std::min_element(found.begin(), found.end());
}

TransferMesh fromMotion(const std::string& name, const AnimatedMesh& motion) {
    TransferMesh out{name, weldMesh(motion, name), {}, {}, {}};
    out.poses = motionPoses(out.mesh, motion);
    out.rest = weldedPositions(out.mesh, motion.frames[0]);
    for (const std::size_t sixth : {1, 3, 5})
        out.frames.push_back(weldedPositions(out.mesh, motion.frames[motion.frames.size() * sixth / 6]));
    return out;
}

/// A closed tube about a trefoil knot that breathes and twists: 3000 vertices without edges, corners and gaps.
AnimatedMesh tube() {
    constexpr int kAlong = 150, kAround = 20, kFrames = 48;
    AnimatedMesh out;
    for (int i = 0; i < kAlong; ++i)
        for (int k = 0; k < kAround; ++k) {
            const auto at = [&](int a, int b) {
                return static_cast<std::uint32_t>((i + a) % kAlong * kAround + (k + b) % kAround);
            };
            out.triangles.push_back({at(0, 0), at(0, 1), at(1, 1)});
            out.triangles.push_back({at(0, 0), at(1, 1), at(1, 0)});
        }
    for (int f = 0; f < kFrames; ++f) {
        const double phase = 2 * kPi * f / kFrames;
        const auto middle = [&](double t) {
            const double r = 2 + (0.8 + 0.2 * std::sin(phase)) * std::cos(3 * t);
            return Vec3(r * std::cos(2 * t), r * std::sin(2 * t), (1.1 + 0.3 * std::cos(phase + t)) * std::sin(3 * t));
        };
        out.frames.emplace_back();
        for (int i = 0; i < kAlong; ++i) {
            const double t = 2 * kPi * i / kAlong;
            const Vec3 along = glm::normalize(middle(t + 1e-4) - middle(t - 1e-4));
            const Vec3 x = glm::normalize(glm::cross(along, Vec3(0, 0, 1))), y = glm::cross(along, x);
            for (int k = 0; k < kAround; ++k) {
                const double phi = 2 * kPi * k / kAround;
                out.frames.back().emplace_back(middle(t) + 0.45 * (std::cos(phi) * x + std::sin(phi) * y));
            }
        }
    }
    return out;
}

}  // namespace

fs::path animatedFolder() {
    const char* folder = std::getenv("NACRE_ANIMATED");
    return folder != nullptr ? folder : "build/data/animated";
}

TransferMeshList transferMeshes(const fs::path& folder, bool quick) {
    TransferMeshList out;
    for (const Source& source : kSources) {
        if (quick && !out.meshes.empty()) break;
        if (const std::optional<fs::path> path = find(folder, source.file))
            out.meshes.push_back(fromMotion(source.name, loadMotion(path->string())));
        else
            out.notes.push_back(std::string("Transfer: no ") + source.file + " in " + folder.string() + ".");
    }
    out.meshes.push_back(fromMotion("cloth", loadMotion("cloth")));
    if (quick) return out;
    out.meshes.push_back(fromMotion("chess", loadMotion("chess")));
    out.meshes.push_back(fromMotion("tube", tube()));
    return out;
}

TransferMesh subdivided(const TransferMesh& mesh) {
    TransferMesh out = mesh;
    out.name += ", each triangle four";
    out.mesh.triangles.clear();
    const std::size_t vertices = mesh.mesh.vertexCount();
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto next = static_cast<std::uint32_t>(vertices + middles.size());
        return middles.try_emplace(std::minmax(a, b), next).first->second;
    };
    for (const glm::uvec3& t : mesh.mesh.triangles) {
        const std::uint32_t ab = middle(t.x, t.y), bc = middle(t.y, t.z), ca = middle(t.z, t.x);
        for (const glm::uvec3& part : {glm::uvec3(t.x, ab, ca), {ab, t.y, bc}, {ca, bc, t.z}, {ab, bc, ca}})
            out.mesh.triangles.push_back(part);
    }
    const auto extend = [&](std::vector<glm::vec3>& positions) {
        positions.resize(vertices + middles.size());
        for (const auto& [edge, at] : middles) positions[at] = 0.5f * (positions[edge.first] + positions[edge.second]);
    };
    extend(out.rest);
    for (std::vector<glm::vec3>& pose : out.poses) extend(pose);
    for (std::vector<glm::vec3>& frame : out.frames) extend(frame);
    // No animation has these vertices: each stands for itself.
    out.mesh.firstOf.resize(vertices + middles.size());
    for (std::uint32_t v = 0; v < out.mesh.firstOf.size(); ++v) out.mesh.firstOf[v] = v;
    out.mesh.weldOf = out.mesh.firstOf;
    return out;
}

}  // namespace nacre::bench
