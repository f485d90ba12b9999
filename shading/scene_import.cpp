#include "shading/scene_import.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/Importer.hpp>
#include <map>

#include "core/error.hpp"
#include "factorize/models/models.hpp"
#include "shading/assimp_mesh.hpp"
#include "shading/assimp_replaced.hpp"
#include "shading/gltf_scene.hpp"
#include "shading/scene_bounds.hpp"

namespace nacre {

namespace fs = std::filesystem;
using Note = std::function<void(const std::string&)>;

namespace {

const aiScene& open(Assimp::Importer& importer, const std::string& name, unsigned steps) {
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_LINE | aiPrimitiveType_POINT);
    const aiScene* scene = importer.ReadFile(name, aiProcess_Triangulate | aiProcess_SortByPType | steps);
    if (!scene) throw Error(fmt::format("{}: expected a mesh, found: {}", name, importer.GetErrorString()));
    return *scene;
}

void tell(const Note& note, bool left, const std::string& name, const std::string& what) {
    if (left && note) note(fmt::format("{}: {}", name, what));
}

SceneMaterial greyMaterial() {
    SceneMaterial out;
    out.name = "grey";
    out.model = makeModel("lambert:kd=0.5").source;
    return out;
}

/// \return its index; -1 when nothing is left of it
int addMesh(SceneDescription& scene, const aiMesh& in, const std::string& name, const std::string& path,
            const Note& note) {
    SceneMesh out{name, {}};
    const bool hasNormals = appendAssimpMesh(out.mesh, in, path);
    const MeshReport report = completeMesh(out.mesh, hasNormals);
    tell(note, report.degenerateTriangles > 0, path,
         fmt::format("left out: {} triangles without area of \"{}\"", report.degenerateTriangles, name));
    tell(note, in.HasVertexColors(0), path, fmt::format("left out: colours of vertices of \"{}\"", name));
    if (out.mesh.triangles.empty()) return -1;
    scene.meshes.push_back(std::move(out));
    return static_cast<int>(scene.meshes.size()) - 1;
}

void requireTriangles(const SceneDescription& scene, const std::string& name) {
    if (scene.meshes.empty()) throw Error(name + ": expected triangles, found none with area");
}

// ---- glTF

std::map<std::string, const aiNode*> childrenByName(const aiScene& scene) {
    std::map<std::string, const aiNode*> out;
    if (!scene.mRootNode) return out;
    out[scene.mRootNode->mName.C_Str()] = scene.mRootNode;
    for (unsigned i = 0; i < scene.mRootNode->mNumChildren; ++i)
        out[scene.mRootNode->mChildren[i]->mName.C_Str()] = scene.mRootNode->mChildren[i];
    return out;
}

/// What a glTF mesh became: one for each primitive that has triangles.
struct Primitive {
    int mesh = -1, material = -1;
};

class GltfGeometry {
public:
    GltfGeometry(const aiScene& in, GltfScene& out, const std::string& name, const Note& note)
        : in_(in), nodes_(childrenByName(in)), out_(out), name_(name), note_(note) {}

    const std::vector<Primitive>& primitives(int gltfMesh) {
        const auto known = primitives_.find(gltfMesh);
        if (known != primitives_.end()) return known->second;
        std::vector<Primitive> made;
        const auto node = nodes_.find("m" + std::to_string(gltfMesh));
        const std::string& name = out_.meshNames[static_cast<std::size_t>(gltfMesh)];
        const unsigned count = node == nodes_.end() ? 0 : node->second->mNumMeshes;
        for (unsigned i = 0; i < count; ++i) {
            const aiMesh& mesh = *in_.mMeshes[node->second->mMeshes[i]];
            const int index =
                addMesh(out_.scene, mesh, count > 1 ? fmt::format("{}/{}", name, i + 1) : name, name_, note_);
            if (index >= 0) made.push_back({index, materialOf(mesh)});
        }
        tell(note_, made.empty(), name_, fmt::format("left out: \"{}\", which has no triangles", name));
        return primitives_.emplace(gltfMesh, std::move(made)).first->second;
    }

    SceneTrack track(const GltfChannel& channel) const {
        SceneTrack out{out_.nodeOf[static_cast<std::size_t>(channel.gltfNode)], channel.path, {}, {}, channel.step};
        const aiAnimation& animation = *in_.mAnimations[0];
        const double second = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : 1;
        const std::string name = "n" + std::to_string(channel.gltfNode);
        for (unsigned i = 0; i < animation.mNumChannels; ++i) {
            const aiNodeAnim& keys = *animation.mChannels[i];
            if (name != keys.mNodeName.C_Str()) continue;
            if (channel.path == SceneTrack::Path::Rotation) {
                for (unsigned k = 0; k < keys.mNumRotationKeys; ++k) {
                    const aiQuatKey& key = keys.mRotationKeys[k];
                    add(out, key.mTime / second, {key.mValue.x, key.mValue.y, key.mValue.z, key.mValue.w});
                }
            } else {
                const bool moves = channel.path == SceneTrack::Path::Translation;
                for (unsigned k = 0; k < (moves ? keys.mNumPositionKeys : keys.mNumScalingKeys); ++k) {
                    const aiVectorKey& key = moves ? keys.mPositionKeys[k] : keys.mScalingKeys[k];
                    add(out, key.mTime / second, {key.mValue.x, key.mValue.y, key.mValue.z, 0});
                }
            }
        }
        if (out.times.empty())
            throw Error(fmt::format("{}: expected key frames of node {}, found none", name_, channel.gltfNode));
        return out;
    }

private:
    /// The file's own, or the grey one.
    int materialOf(const aiMesh& mesh) {
        aiString name;
        const std::size_t given = out_.scene.materials.size() - (grey_ >= 0 ? 1 : 0);
        if (in_.mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS)
            for (std::size_t i = 0; i < given; ++i)
                if ("m" + std::to_string(i) == name.C_Str()) return static_cast<int>(i);
        if (grey_ < 0) {
            grey_ = static_cast<int>(given);
            out_.scene.materials.push_back(greyMaterial());
        }
        return grey_;
    }
    void add(SceneTrack& track, double time, const Vec4& value) const {
        const bool sound = std::isfinite(time) && std::isfinite(value.w) && isFinite(Vec3(value)) &&
                           (track.times.empty() ? time >= 0 : time > track.times.back()) &&
                           (track.path != SceneTrack::Path::Rotation || glm::length(value) > 0.5);
        if (!sound) throw Error(fmt::format("{}: expected key frames of finite numbers in order, found others", name_));
        track.times.push_back(time);
        track.values.push_back(value);
    }

    const aiScene& in_;
    std::map<std::string, const aiNode*> nodes_;
    GltfScene& out_;
    const std::string& name_;
    const Note& note_;
    std::map<int, std::vector<Primitive>> primitives_;
    int grey_ = -1;
};

/// Nodes with the meshes of their primitives: of one, in the node; of several, in nodes below it.
void placeMeshes(SceneDescription& scene, GltfGeometry& geometry) {
    const std::size_t count = scene.nodes.size();
    for (std::size_t i = 0; i < count; ++i) {
        const int mesh = scene.nodes[i].mesh;
        if (mesh < 0) continue;
        scene.nodes[i].mesh = -1;
        const std::vector<Primitive>& parts = geometry.primitives(mesh);
        for (std::size_t k = 0; k < parts.size(); ++k) {
            SceneNode node;
            if (parts.size() > 1) {
                node.name = fmt::format("{}/{}", scene.nodes[i].name, k + 1);
                node.parent = static_cast<int>(i);
                scene.nodes.push_back(node);
            }
            SceneNode& holder = parts.size() > 1 ? scene.nodes.back() : scene.nodes[i];
            holder.mesh = parts[k].mesh;
            holder.material = parts[k].material;
        }
    }
}

ImportedScene importGltf(const fs::path& path, const Note& note) {
    const GltfFile file = readGltf(path);
    GltfScene read = gltfScene(file, note);
    const std::string name = path.string();
    const std::vector<std::uint8_t> bytes = geometryOf(file);
    Assimp::Importer importer;
    if (!read.meshNames.empty() || !read.channels.empty()) {
        importer.SetIOHandler(new AssimpReplaced(name, bytes));  // the importer deletes it
        const aiScene& scene = open(importer, name, 0);
        GltfGeometry geometry(scene, read, name, note);
        placeMeshes(read.scene, geometry);
        for (const GltfChannel& channel : read.channels) {
            if (scene.mNumAnimations == 0) throw Error(name + ": expected key frames, found none");
            read.scene.tracks.push_back(geometry.track(channel));
            read.scene.duration = std::max(read.scene.duration, read.scene.tracks.back().times.back());
        }
    }
    ImportedScene out{std::move(read.scene), read.cameraNode.has_value()};
    if (out.hasCamera) {
        Camera& camera = out.scene.camera;
        camera = cameraAt(camera, nodeTransforms(out.scene, 0)[static_cast<std::size_t>(*read.cameraNode)]);
        const SceneBounds bounds = boundsAt(out.scene, 0);
        const Vec3 ahead = glm::normalize(camera.target - camera.eye);
        const double distance = glm::dot(bounds.centre() - camera.eye, ahead);
        if (!bounds.empty && distance > 0) camera.target = camera.eye + distance * ahead;
    }
    return out;
}

// ---- Everything else

SceneMaterial materialFrom(const aiMaterial& in, const std::string& path, const Note& note) {
    aiString name;
    aiColor3D kd;
    if (in.Get(AI_MATKEY_NAME, name) != aiReturn_SUCCESS || std::string(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME ||
        in.Get(AI_MATKEY_COLOR_DIFFUSE, kd) != aiReturn_SUCCESS)
        return greyMaterial();
    SceneMaterial out = greyMaterial();
    out.name = name.C_Str();
    tell(note, in.GetTextureCount(aiTextureType_DIFFUSE) > 0, path,
         fmt::format("left out: textures of \"{}\"", out.name));
    const bool isAlbedo = kd.r >= 0 && kd.r <= 1 && kd.g >= 0 && kd.g <= 1 && kd.b >= 0 && kd.b <= 1;
    tell(note, !isAlbedo, path,
         fmt::format("left out: the colour of \"{}\", which is no albedo: it is grey", out.name));
    if (isAlbedo) out.model = makeModel(fmt::format("lambert:kd={:.9g}/{:.9g}/{:.9g}", kd.r, kd.g, kd.b)).source;
    return out;
}

ImportedScene importMeshes(const fs::path& path, const Note& note) {
    const std::string name = path.string();
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) throw Error(name + ": expected a mesh file, found no regular file");
    Assimp::Importer importer;
    const aiScene& in = open(importer, name, aiProcess_PreTransformVertices | aiProcess_JoinIdenticalVertices);
    ImportedScene out;
    out.scene.file = path;
    std::map<unsigned, int> materials;
    for (unsigned i = 0; i < in.mNumMeshes; ++i) {
        const aiMesh& mesh = *in.mMeshes[i];
        SceneNode node;
        node.name = in.mNumMeshes > 1 ? fmt::format("{}/{}", path.stem().string(), i + 1) : path.stem().string();
        node.mesh = addMesh(out.scene, mesh, node.name, name, note);
        if (node.mesh < 0) continue;
        const auto [known, isNew] =
            materials.emplace(mesh.mMaterialIndex, static_cast<int>(out.scene.materials.size()));
        if (isNew) out.scene.materials.push_back(materialFrom(*in.mMaterials[mesh.mMaterialIndex], name, note));
        node.material = known->second;
        out.scene.nodes.push_back(std::move(node));
    }
    tell(note, in.mNumLights + in.mNumCameras + in.mNumAnimations > 0, name, "left out: lights, cameras and animation");
    requireTriangles(out.scene, name);
    return out;
}

bool isGltfName(const fs::path& path) { return path.extension() == ".gltf" || path.extension() == ".glb"; }

}  // namespace

ImportedScene importScene(const fs::path& path, const Note& note) {
    return isGltfName(path) ? importGltf(path, note) : importMeshes(path, note);
}

bool isImportName(const fs::path& path) {
    return path.has_extension() && Assimp::Importer().IsExtensionSupported(path.extension().string());
}

}  // namespace nacre
