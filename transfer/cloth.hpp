// A simulated cloth that falls over a ball and onto a floor: HEMI's first model, made here.
#pragma once

#include "core/animation.hpp"

namespace nacre {

/// The defaults give HEMI's 1378 vertices and 2560 triangles.
struct ClothOptions {
    int clothVertices = 33;  ///< along an edge, ≥ 2
    int floorVertices = 17;  ///< along an edge, ≥ 2
    int frames = 300;
    double framesPerSecond = 30;
    int stepsPerFrame = 40;    ///< of the simulation; fewer stretch the cloth more, but none is unstable
    std::uint64_t seed = 1;    ///< of the breeze's gusts
    double breeze = 1.5;       ///< mean speed of the wind [m/s]; 0: none
    double clothEdge = 2;      ///< length of the cloth's edges [m]
    double floorEdge = 4;      ///< of the floor's, centred below the cloth at y = 0
    double height = 1.4;       ///< of the cloth at first, when it lies flat
    Vec3 ball{0, 0.65, 0};     ///< centre of the ball, which is not part of the mesh
    double ballRadius = 0.45;  ///< 0: none
};

/// Position-based dynamics (Müller et al. 2007) with one sweep over the constraints in each of many small steps
/// (Macklin et al. 2019): distances between neighbours along the edges, across the squares, and between every second
/// vertex against bending. Gravity, wind pressure on the triangles, friction on ball and floor; the cloth does not
/// collide with itself. It keeps a hundredth of the floor's distance from it. Same bits in every run.
/// \return  the cloth's vertices row by row, then the floor's, which stand still; uvs in [0,1]² of each
/// \throws std::invalid_argument when a number is out of range or not finite
AnimatedMesh clothAnimation(const ClothOptions& options = {});

}  // namespace nacre
