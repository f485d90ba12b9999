#include "shading/mesh_file.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/Importer.hpp>

#include "core/error.hpp"
#include "shading/assimp_mesh.hpp"
#include "shading/mesh_attributes.hpp"

namespace nacre {
namespace {

glm::vec3 toGlm(const aiVector3D& v) { return {v.x, v.y, v.z}; }

/// Unit length for every normal. \return false when one has no direction
bool normalise(std::vector<glm::vec3>& normals) {
    for (glm::vec3& n : normals) {
        const double length = glm::length(Vec3(n));
        if (!std::isfinite(length) || length < 1e-12) return false;
        n = glm::vec3(Vec3(n) / length);
    }
    return true;
}

}  // namespace

bool appendAssimpMesh(Mesh& out, const aiMesh& in, const std::string& path) {
    const auto base = static_cast<std::uint32_t>(out.positions.size());
    for (unsigned i = 0; i < in.mNumVertices; ++i) {
        const glm::vec3 position = toGlm(in.mVertices[i]);
        if (!isFinite(Vec3(position))) throw Error(fmt::format("{}: vertex {} is not finite", path, base + i));
        out.positions.push_back(position);
        out.normals.push_back(in.HasNormals() ? toGlm(in.mNormals[i]) : glm::vec3(0));
        out.uvs.push_back(in.HasTextureCoords(0) ? glm::vec2(toGlm(in.mTextureCoords[0][i])) : glm::vec2(0));
    }
    for (unsigned i = 0; i < in.mNumFaces; ++i) {
        const aiFace& face = in.mFaces[i];
        if (face.mNumIndices != 3) continue;
        for (unsigned k = 0; k < 3; ++k)
            if (face.mIndices[k] >= in.mNumVertices)
                throw Error(
                    fmt::format("{}: face {} names vertex {}, of {}", path, i, face.mIndices[k], in.mNumVertices));
        out.triangles.push_back(glm::uvec3(face.mIndices[0], face.mIndices[1], face.mIndices[2]) + base);
    }
    return in.HasNormals();
}

MeshReport completeMesh(Mesh& mesh, bool hasNormals) {
    MeshReport report;
    report.degenerateTriangles = removeDegenerateTriangles(mesh);
    if (mesh.triangles.empty()) return report;
    report.madeNormals = !hasNormals || !normalise(mesh.normals);
    if (report.madeNormals) report.standInNormals = makeNormals(mesh);
    makeTangents(mesh);
    return report;
}

LoadedMesh loadMesh(const std::filesystem::path& path) {
    const std::string name = path.string();
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored))
        throw Error(name + ": expected a mesh file, found no regular file");
    Assimp::Importer importer;
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_LINE | aiPrimitiveType_POINT);
    const aiScene* scene =
        importer.ReadFile(name, aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_PreTransformVertices |
                                    aiProcess_JoinIdenticalVertices);
    if (!scene) throw Error(fmt::format("{}: expected a mesh, found: {}", name, importer.GetErrorString()));
    LoadedMesh out;
    bool hasNormals = true;
    for (unsigned i = 0; i < scene->mNumMeshes; ++i)
        hasNormals = appendAssimpMesh(out.mesh, *scene->mMeshes[i], name) && hasNormals;
    out.report = completeMesh(out.mesh, hasNormals);
    if (out.mesh.triangles.empty())
        throw Error(fmt::format("{}: expected triangles, found none with area ({} degenerate)", name,
                                out.report.degenerateTriangles));
    return out;
}

void fitToBox(Mesh& mesh, float size) {
    require(!mesh.positions.empty(), "fitToBox: empty mesh");
    glm::vec3 low = mesh.positions[0], high = low;
    for (const glm::vec3& p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 extent = high - low;
    const float longest = std::max(extent.x, std::max(extent.y, extent.z));
    require(std::isfinite(longest) && longest > 0, "fitToBox: the mesh has no extent");
    for (glm::vec3& p : mesh.positions) p = (p - 0.5f * (low + high)) * (size / longest);
}

}  // namespace nacre
