#include "shading/assimp_rig.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/Importer.hpp>
#include <map>
#include <optional>
#include <set>

#include "core/error.hpp"
#include "shading/assimp_replaced.hpp"
#include "shading/gltf_file.hpp"

namespace nacre {
namespace {

using Note = std::function<void(const std::string&)>;

constexpr double kLowestRate = 1, kHighestRate = 120;  // [frames/s]; other ticks are a clock
constexpr double kDefaultTicks = 25;                   // [1/s] where a file is silent: assimp's own convention

glm::vec3 toGlm(const aiVector3D& v) { return {v.x, v.y, v.z}; }
glm::dquat toGlm(const aiQuaternion& q) {
    glm::dquat out;
    out.w = q.w, out.x = q.x, out.y = q.y, out.z = q.z;
    return out;
}
Mat4 toGlm(const aiMatrix4x4& m) {  // assimp's rows are our columns' components
    Mat4 out;
    for (unsigned r = 0; r < 4; ++r)
        for (unsigned c = 0; c < 4; ++c) out[static_cast<int>(c)][static_cast<int>(r)] = m[r][c];
    return out;
}

class RigReader {
public:
    RigReader(const aiScene& scene, std::string path, const Note& note)
        : scene_(scene), path_(std::move(path)), note_(note) {}

    Rig read() {
        if (scene_.mRootNode) addNode(*scene_.mRootNode, -1);
        for (std::size_t i = 0; i < nodes_.size(); ++i)  // grows: parents first
            for (unsigned c = 0; c < nodes_[i]->mNumChildren; ++c)
                addNode(*nodes_[i]->mChildren[c], static_cast<int>(i));
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            for (unsigned m = 0; m < nodes_[i]->mNumMeshes; ++m) addPart(nodes_[i]->mMeshes[m], static_cast<int>(i));
        for (unsigned i = 0; i < scene_.mNumAnimations; ++i) addClip(*scene_.mAnimations[i], i);
        return std::move(rig_);
    }

private:
    void tell(const std::string& what) const {
        if (note_) note_(path_ + ": " + what);
    }

    void addNode(const aiNode& node, int parent) {
        const std::string name = node.mName.C_Str();
        if (!numberOf_.emplace(name, static_cast<int>(nodes_.size())).second) repeated_.insert(name);
        nodes_.push_back(&node);
        rig_.nodes.push_back({name, parent, toGlm(node.mTransformation)});
    }

    void addPart(unsigned index, int node) {
        if (index >= scene_.mNumMeshes)
            throw Error(fmt::format("{}: expected a mesh below {}, found {}", path_, scene_.mNumMeshes, index));
        const aiMesh& in = *scene_.mMeshes[index];
        if (in.HasBones() && !skinned_.insert(index).second)
            return;  // its place is its bones', whichever node holds it
        RigPart part;
        part.node = node;
        for (unsigned v = 0; v < in.mNumVertices; ++v) part.positions.push_back(toGlm(in.mVertices[v]));
        for (unsigned v = 0; in.HasTextureCoords(0) && v < in.mNumVertices; ++v)
            part.uvs.push_back(glm::vec2(toGlm(in.mTextureCoords[0][v])));
        for (unsigned f = 0; f < in.mNumFaces; ++f)
            if (const aiFace& face = in.mFaces[f]; face.mNumIndices == 3)
                part.triangles.push_back({face.mIndices[0], face.mIndices[1], face.mIndices[2]});
        addBones(part, in);
        for (unsigned t = 0; t < in.mNumAnimMeshes; ++t) {
            const aiAnimMesh& target = *in.mAnimMeshes[t];
            part.targets.push_back({part.positions, target.mWeight});
            if (!target.HasPositions()) continue;
            part.targets.back().positions.clear();
            for (unsigned v = 0; v < target.mNumVertices; ++v)
                part.targets.back().positions.push_back(toGlm(target.mVertices[v]));
        }
        rig_.parts.push_back(std::move(part));
    }

    void addBones(RigPart& part, const aiMesh& in) const {
        for (unsigned b = 0; b < in.mNumBones; ++b) {
            const aiBone& bone = *in.mBones[b];
            const auto node = numberOf_.find(bone.mName.C_Str());
            if (node == numberOf_.end())
                throw Error(fmt::format("{}: expected a node for bone \"{}\", found none", path_, bone.mName.C_Str()));
            for (unsigned w = 0; w < bone.mNumWeights; ++w)
                if (const aiVertexWeight& weight = bone.mWeights[w]; weight.mWeight != 0)
                    part.influences.push_back(
                        {weight.mVertexId, static_cast<std::uint32_t>(part.bones.size()), weight.mWeight});
            part.bones.push_back({node->second, toGlm(bone.mOffsetMatrix)});
        }
    }

    int nodeNamed(const std::string& name, const std::string& clip) const {
        const auto node = numberOf_.find(name);
        if (node == numberOf_.end()) {
            tell(fmt::format("left out: motion of \"{}\" in clip \"{}\", which is no node", name, clip));
            return -1;
        }
        if (repeated_.count(name)) tell(fmt::format("several nodes are named \"{}\": the first moves", name));
        return node->second;
    }

    template <class T, class Key>
    static RigKeys<T> keysOf(const Key* keys, unsigned count, double ticks, const T& otherwise) {
        RigKeys<T> out;
        for (unsigned i = 0; i < count; ++i) {
            out.times.push_back(keys[i].mTime / ticks);
            out.values.push_back(toGlm(keys[i].mValue));
        }
        if (count == 0) out = {{0}, {otherwise}};
        return out;
    }

    void addClip(const aiAnimation& in, unsigned index) {
        RigClip clip;
        clip.name = in.mName.length ? in.mName.C_Str() : std::to_string(index);
        const double ticks = in.mTicksPerSecond != 0 ? in.mTicksPerSecond : kDefaultTicks;
        if (in.mTicksPerSecond >= kLowestRate && in.mTicksPerSecond <= kHighestRate) clip.framesPerSecond = ticks;
        const auto extend = [&](const auto& keys) { clip.seconds = std::max(clip.seconds, keys.times.back()); };
        for (unsigned i = 0; i < in.mNumChannels; ++i) {
            const aiNodeAnim& channel = *in.mChannels[i];
            const int node = nodeNamed(channel.mNodeName.C_Str(), clip.name);
            if (node < 0) continue;
            aiVector3D scale, place;
            aiQuaternion turn;
            nodes_[static_cast<std::size_t>(node)]->mTransformation.Decompose(scale, turn, place);
            clip.tracks.push_back({node,
                                   keysOf<Vec3>(channel.mPositionKeys, channel.mNumPositionKeys, ticks, toGlm(place)),
                                   keysOf(channel.mRotationKeys, channel.mNumRotationKeys, ticks, toGlm(turn)),
                                   keysOf<Vec3>(channel.mScalingKeys, channel.mNumScalingKeys, ticks, toGlm(scale))});
            extend(clip.tracks.back().translation);
            extend(clip.tracks.back().rotation);
            extend(clip.tracks.back().scale);
        }
        for (unsigned i = 0; i < in.mNumMorphMeshChannels; ++i)
            if (addMorph(clip, *in.mMorphMeshChannels[i], ticks)) extend(clip.morphs.back().weights);
        rig_.clips.push_back(std::move(clip));
    }

    bool addMorph(RigClip& clip, const aiMeshMorphAnim& channel, double ticks) const {
        const int node = nodeNamed(channel.mName.C_Str(), clip.name);
        std::size_t targets = 0;
        for (const RigPart& part : rig_.parts)
            if (part.node == node) targets = std::max(targets, part.targets.size());
        if (node < 0 || channel.mNumKeys == 0) return false;
        RigMorphTrack track{node, {}};
        for (unsigned k = 0; k < channel.mNumKeys; ++k) {
            const aiMeshMorphKey& key = channel.mKeys[k];
            track.weights.times.push_back(key.mTime / ticks);
            track.weights.values.emplace_back(targets);
            for (unsigned i = 0; i < key.mNumValuesAndWeights; ++i) {
                if (key.mValues[i] >= targets)
                    throw Error(fmt::format("{}: clip \"{}\": expected morph targets below {}, found {}", path_,
                                            clip.name, targets, key.mValues[i]));
                track.weights.values.back()[key.mValues[i]] = key.mWeights[i];
            }
        }
        clip.morphs.push_back(std::move(track));
        return true;
    }

    const aiScene& scene_;
    const std::string path_;
    const Note& note_;
    Rig rig_;
    std::vector<const aiNode*> nodes_;
    std::map<std::string, int> numberOf_;
    std::set<std::string> repeated_;
    std::set<unsigned> skinned_;
};

/// The file's own names in place of numbered ones.
void nameNodes(Rig& rig, const GltfFile& file) {
    if (!file.document.contains("nodes")) return;
    const nlohmann::json& nodes = file.document["nodes"];
    std::map<std::string, std::string> names;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].contains("name") && nodes[i]["name"].is_string())
            names["n" + std::to_string(i)] = nodes[i]["name"];
    for (RigNode& node : rig.nodes)
        if (const auto own = names.find(node.name); own != names.end()) node.name = own->second;
}

void tellOfKeys(const GltfFile& file, const Note& note) {
    const std::string text = file.document.value("animations", nlohmann::json::array()).dump();
    for (const char* kind : {"STEP", "CUBICSPLINE"})
        if (note && text.find(fmt::format("\"interpolation\":\"{}\"", kind)) != std::string::npos)
            note(fmt::format("{}: {} keys are read as linear ones", file.path.string(), kind));
}

}  // namespace

Rig readAssimpRig(const std::filesystem::path& path, const Note& note, int keyFrame) {
    const std::string name = path.string();
    const bool isGltf = path.extension() == ".gltf" || path.extension() == ".glb";
    std::optional<GltfFile> gltf;
    std::vector<std::uint8_t> bytes;
    Assimp::Importer importer;
    importer.SetPropertyInteger(AI_CONFIG_IMPORT_GLOBAL_KEYFRAME, keyFrame);
    if (isGltf) {
        gltf = readGltf(path);
        bytes = withNumberedNodes(*gltf);
        importer.SetIOHandler(new AssimpReplaced(name, bytes));  // the importer deletes it
        tellOfKeys(*gltf, note);
    }
    const aiScene* scene = importer.ReadFile(name, aiProcess_Triangulate);
    if (!scene) throw Error(fmt::format("{}: expected a mesh, found: {}", name, importer.GetErrorString()));
    Rig rig = RigReader(*scene, name, note).read();
    if (gltf) nameNodes(rig, *gltf);
    return rig;
}

}  // namespace nacre
