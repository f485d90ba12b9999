// Cube maps as other programs arrange and turn their faces, into OpenEXR's strip.
#pragma once

#include "core/environment.hpp"

namespace nacre {

/// What lies where. One cell is one face; F = +Z seen in the file's own coordinates, B = −Z.
///
///   Strip   Row             HorizontalCross      VerticalCross
///   +X      +X −X +Y …         +Y                   +Y
///   −X                      −X  F  +X  B         −X  F  +X
///   +Y                         −Y                   −Y
///   −Y                                               B   turned by 180°
///   +Z
///   −Z
///
/// Six files are a Strip when stacked. Crosses are unfolded cubes seen from inside (P. Debevec's light probe gallery;
/// HDRShop and cmft write them so).
enum class CubeArrangement { Strip, Row, HorizontalCross, VerticalCross };

/// Which way up faces lie, and which hand their coordinates are of.
///   OpenExr  ImfEnvmap.h: right-handed, faces as seen from inside. In a cross F is then −Z, B is +Z.
///   Gl       OpenGL 4.6 table 8.19, the same in Direct3D, KTX and DDS: left-handed.
/// Under Gl directions are kept, (x, y, z) of the file is (x, y, z) of the map, so that a photograph appears mirrored
/// when seen from inside our right-handed world. Pictures from tools that mean z or x the other way need flip or yaw.
enum class FaceOrientation { OpenExr, Gl };

/// \throws std::invalid_argument unless the image has three channels and the arrangement's proportions
EnvMap cubeFromArrangement(const Image& image, CubeArrangement arrangement, FaceOrientation orientation);

/// One face as it lies in the map's strip, turned to the orientation of OpenGL, Direct3D, KTX and DDS: ±X and ±Z left
/// and right exchanged, ±Y upside down. Derivation: OpenEXR's +X has right = +z, down = −y; OpenGL's right = −z, down =
/// −y (and so on for ±X, ±Z); OpenEXR's +Y has right = +x, down = −z; OpenGL's right = +x, down = +z (−Y: the signs of
/// z exchanged). It is its own inverse.
Image glFace(const EnvMap& cube, int face);

/// How badly faces fit along the cube's twelve edges: mean of |a − b| / (a + b) over facing border texels, 0 to 1.
double seamMismatch(const EnvMap& cube);

}  // namespace nacre
