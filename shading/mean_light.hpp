// Where a light stands over a relief that is spread on a mesh.
#pragma once

#include "core/scene_description.hpp"

namespace nacre {

/// The mean direction from which a light comes, in the frames of a mesh's points (x along the tangent, z the normal),
/// weighted by the irradiance that it gives them; (0, 0, 1) when it gives none. What an indirect light of a relief is
/// made for: exact for a plane and a directional light. \param samples  points on the mesh, even in its area
Vec3 meanLightDirection(const Mesh& mesh, const glm::dmat4& toWorld, const Light& light, int samples = 4096);

}  // namespace nacre
