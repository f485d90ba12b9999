#include "bench/transfer_meshes.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>

#include "core/error.hpp"
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
    TransferMesh out{name, weldMesh(motion, name), {}, {}};
    out.rest = weldedPositions(out.mesh, motion.frames[0]);
    for (const std::size_t sixth : {1, 3, 5})
        out.frames.push_back(weldedPositions(out.mesh, motion.frames[motion.frames.size() * sixth / 6]));
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
    if (!quick) out.meshes.push_back(fromMotion("chess", loadMotion("chess")));
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
    for (std::vector<glm::vec3>& frame : out.frames) extend(frame);
    // No animation has these vertices: each stands for itself.
    out.mesh.firstOf.resize(vertices + middles.size());
    for (std::uint32_t v = 0; v < out.mesh.firstOf.size(); ++v) out.mesh.firstOf[v] = v;
    out.mesh.weldOf = out.mesh.firstOf;
    return out;
}

}  // namespace nacre::bench
