// Light of `nacre transfer`, and its frames as coloured meshes.
#pragma once

#include <string>

#include "core/progress.hpp"
#include "shading/transfer_player.hpp"

namespace nacre::cli {

struct TransferLight {
    std::vector<std::string> files;  ///< none: radiance 1 from everywhere
    std::vector<double> weights;     ///< one a file; none: equal ones, of sum 1
    double turnDeg = 0;              ///< about y, from +z towards +x [degrees a second]
    double white = 0;                ///< radiance shown as white; 0: pictureWhite of the first frame
    unsigned threads = 0;
};

/// \param text  numbers ≥ 0 separated by commas, one for each file; empty: none are given \throws UsageError
void takeWeights(TransferLight& light, const std::string& text);

/// Each environment's coefficients, and what each weighs. \throws as readEnvironment
PlayedLight readLights(const TransferLight& light, int order);
/// The same, blended.
LightCoefficients readLight(const TransferLight& light, int order);

/// The file of a frame: numberedName, or, without any #, pattern/frame_0000.ply.
std::string plyName(const std::string& pattern, int frame);

/// \throws UsageError for # in two places or in a folder's name; nacre::Error when nothing can be written there
void requirePlyPlace(const std::string& pattern, int frame);

/// One PLY file a frame, albedo 1. \return the white that was used
double writePlyFrames(const TransferRecording& recording, const LightCoefficients& coefficients,
                      const TransferLight& light, const std::string& pattern, const Progress& progress);

}  // namespace nacre::cli
