// What the command line of nacre_view says.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace nacre {

struct ViewerOptions {
    std::filesystem::path file;
    int width = 800, height = 600;  ///< of the picture; the panel stands beside it
    int samples = 1;                ///< per pixel
    bool panel = true;
    std::optional<double> white;  ///< what becomes 255; none: fitted to the first picture
    std::vector<std::filesystem::path> assetFolders;
    std::filesystem::path screenshots = ".";
    bool liveTransfer = false;              ///< the file's transfer is computed while it is shown
    std::vector<std::string> environments;  ///< that light a moving mesh
    int referencePasses = 16;
    int referenceScale = 2;    ///< the reference has 1/n of the picture's edges
    double target = 0;         ///< of a frame while the picture moves [s]; 0: full quality always
    int benchmark = 0;         ///< frames to draw and time; 0: stay open
    int loseContextAfter = 0;  ///< frames after which the first context counts as lost, for tests; 0: never
    bool trace = false;        ///< one JSON line on standard output for each frame shown
};

}  // namespace nacre
