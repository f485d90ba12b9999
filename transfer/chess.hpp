// Moving chess pieces above a board: HEMI's third model, made here. Knows no files: real pieces are given.
#pragma once

#include <array>

#include "core/animation.hpp"

namespace nacre {

enum class ChessPiece { King, Queen, Rook, Bishop, Knight, Pawn };

/// Positions and triangles of each kind, y up, facing −z. Any size: chessAnimation fits them.
using ChessSet = std::array<Mesh, 6>;

/// Pieces of revolution (the knight's head leans forward), closed, about 250 triangles each. \param sides  ≥ 3
ChessSet turnedChessSet(int sides = 12);

struct ChessOptions {
    double framesPerSecond = 30;
    int frames = 0;               ///< the first so many; 0: all, which are 10.5 seconds
    int boardVertices = 17;       ///< along an edge of the board with its margin, ≥ 2
    std::size_t triangles = 260;  ///< of a piece at most: finer ones are simplified
};

/// A smothered mate in four moves (1 Nf7+ Kg8 2 Nh6+ Kh8 3 Qg8+ Rxg8 4 Nf7#) with eleven pieces. A square is 1 wide,
/// the board lies at y = 0. Each piece moves on a Bézier curve, lifted, the knight higher; what is taken goes off the
/// board. \throws std::invalid_argument when a number is out of range or a piece is empty
AnimatedMesh chessAnimation(const ChessSet& set, const ChessOptions& options = {});

}  // namespace nacre
