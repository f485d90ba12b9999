// Rooms that a headset scanned, as scenes: WebXR captures in JSON, with one triangle mesh of the whole room and
// labelled rectangles and boxes ("WALL_FACE", "TABLE", …) where its things are.
#pragma once

#include "core/json_field.hpp"
#include "shading/scene_import.hpp"

namespace nacre {

/// Whether a JSON document is such a capture: it has "spatialEntities".
bool isRoomCapture(const nlohmann::json& document);

/// One node and one Lambertian material a label, in metres, y up. A triangle takes the label of the smallest box or
/// rectangle that holds its middle within 6 cm (rectangles: that faces its way, too); where there is none, "OTHER". The
/// mesh is seamless as a whole and open as parts: triangles of different labels share no vertices, so that their
/// normals don't blend. Albedos are guesses by label, as the scan has no colours. The camera stands in the room; one
/// who looks at the file alone has a lamp with an area below the ceiling. \throws nacre::Error with the place in the
/// file: fields missing or of another kind, base64 or sizes that are wrong,
///         indices out of range, no triangle with area
ImportedScene roomCapture(const JsonField& root, const std::filesystem::path& path,
                          const std::function<void(const std::string&)>& note);

}  // namespace nacre
