// What skinned, morphed and node-animated files hold, whatever their format, and its motion as an AnimatedMesh.
#pragma once

#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <string>

#include "core/animation.hpp"

namespace nacre {

using Mat4 = glm::dmat4;

struct RigNode {
    std::string name;
    int parent = -1;  ///< before this node in the list; -1: none
    Mat4 local{1};    ///< to the parent's coordinates, when nothing animates it
};

/// Values between keys are linear (rotations: on the shortest great circle), constant before the first and after the
/// last. Values may be non-finite: so are the frames that they touch, and no others.
template <class T>
struct RigKeys {
    std::vector<double> times;  ///< finite, in order [s]
    std::vector<T> values;      ///< as many, at least one
};

/// A node's local transformation: translation · rotation · scale.
struct RigTrack {
    int node = 0;
    RigKeys<Vec3> translation;
    RigKeys<glm::dquat> rotation;  ///< any length but 0
    RigKeys<Vec3> scale;
};

/// The weights of the morph targets of all parts at a node.
struct RigMorphTrack {
    int node = 0;
    RigKeys<std::vector<double>> weights;
};

struct RigClip {
    std::string name;
    double seconds = 0;          ///< from 0 to the last key
    double framesPerSecond = 0;  ///< the file's; 0: it names none
    std::vector<RigTrack> tracks;
    std::vector<RigMorphTrack> morphs;
};

struct RigBone {
    int node = 0;
    Mat4 inverseBind{1};  ///< from the part's coordinates to the bone's, in the pose that it was bound in
};

struct RigInfluence {
    std::uint32_t vertex = 0, bone = 0;
    double weight = 0;
};

struct RigMorphTarget {
    std::vector<glm::vec3> positions;  ///< of all vertices, not differences
    double weight = 0;                 ///< where no track says otherwise
};

struct RigPart {
    int node = 0;  ///< that it hangs on; vertices without bones follow it
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> uvs;  ///< one a vertex, or none
    std::vector<glm::uvec3> triangles;
    std::vector<RigBone> bones;
    std::vector<RigInfluence> influences;
    std::vector<RigMorphTarget> targets;
};

struct Rig {
    std::vector<RigNode> nodes;
    std::vector<RigPart> parts;
    std::vector<RigClip> clips;
};

/// All parts at the times i / framesPerSecond of a clip, its end included when it is one of them; without a clip one
/// frame. Linear blend skinning: p' = Σ w M B⁻¹ p / Σ w over the bones of p, with M a bone's node at that time and B⁻¹
/// its inverse bind matrix; p is morphed first: p + Σ weight (target − p).
/// \param clip             of this rig, or null  \param framesPerSecond  0: the clip's own, else 30
/// \param note             is told of weights that don't sum to 1 and of vertices of a skin that no bone moves
/// \throws nacre::Error naming the rig: indices out of range, weights that are negative or not finite, times that
///         aren't finite or out of order, more than 100000 frames, no triangle
AnimatedMesh animateRig(const Rig& rig, const RigClip* clip, double framesPerSecond, const std::string& name,
                        const std::function<void(const std::string&)>& note);

}  // namespace nacre
