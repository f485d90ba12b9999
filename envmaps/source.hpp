// Radiance maps in: which picture is which surrounding.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/environment.hpp"
#include "core/image_file.hpp"
#include "envmaps/cube_layouts.hpp"
#include "envmaps/texel_check.hpp"

namespace nacre {

/// How a file holds the surrounding. Proportions as width:height.
///   LatLong 2:1, CubeStrip 1:6, CubeRow 6:1, CubeHorizontalCross 4:3, CubeVerticalCross 3:4   (cube_layouts.hpp)
///   CubeFaces       six square files
///   Angular, MirrorBall 1:1                                                                  (probe.hpp)
///   DualParaboloid  1:2 (front above back) or 2:1 (front left of back)                (core/environment.hpp)
///   Octahedral 1:1                                                                    (core/environment.hpp)
///   Auto            OpenEXR's envmap attribute, a nacre asset's own word, or proportions
/// 1:1 and 1:2 may be several and must be named.
enum class SourceLayout {
    Auto,
    LatLong,
    CubeStrip,
    CubeRow,
    CubeHorizontalCross,
    CubeVerticalCross,
    CubeFaces,
    Angular,
    MirrorBall,
    DualParaboloid,
    Octahedral
};

std::string toString(SourceLayout layout);  ///< auto, latlong, cube_strip, …
/// \throws std::invalid_argument that lists the known names
SourceLayout sourceLayoutFromString(const std::string& name);
std::vector<std::string> sourceLayoutNames();

struct SourceOptions {
    SourceLayout layout = SourceLayout::Auto;
    std::string faces = "auto";  ///< openexr, gl (FaceOrientation); auto: the attribute, or whose seams fit better
    NegativePolicy negative = NegativePolicy::Clamp;
    std::string flip = "none";  ///< x: left and right exchanged; y: upside down (after reading, before yaw)
    double yaw = 0;             ///< turns the surrounding about y, from +z towards +x [rad]
    unsigned threads = 0;       ///< 0 = all cores, same bits for any
};

/// What was found and what was done.
struct SourceReport {
    std::string path, hash, format, sampleType;
    SourceLayout layout = SourceLayout::Auto;
    std::string faces;  ///< openexr or gl for cubes, else empty
    int width = 0, height = 0;
    bool srgbDecoded = false;
    double exposure = 1;
    double seamsOpenExr = -1, seamsGl = -1;  ///< seamMismatch under each reading; −1 when not compared
    TexelReport texels;
    std::string flip = "none";
    double yaw = 0;
    NegativePolicy negative = NegativePolicy::Clamp;
};
nlohmann::json toJson(const SourceReport& report);
/// How a file was read, from what toJson wrote of it. \throws nlohmann::json::exception when something is missing
SourceOptions sourceOptionsFrom(const nlohmann::json& report);

struct Environment {
    EnvMap map;  ///< in the file's layout (cubes as OpenEXR's strip, probes as a cube), oriented as CONVENTIONS.md says
    SourceReport report;
};

/// \param source  a picture; a name with %s for px nx py ny pz nz (or posx negx …); or a folder with such six files
/// \throws nacre::Error naming file, expected and found: unreadable, not of the layout's proportions, a face missing or
/// of
///         another size, bad texels under NegativePolicy::Error, a nacre asset of another kind
Environment readEnvironment(const std::string& source, const SourceOptions& options = {});

/// readEnvironment of one picture that is read already.
Environment environmentFromImage(const ImageFile& file, const std::string& name, const SourceOptions& options = {});

}  // namespace nacre
