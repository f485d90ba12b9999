#include "envmaps/cube_layouts.hpp"

#include <fmt/format.h>

#include <array>

#include "core/error.hpp"

namespace nacre {
namespace {

struct Cell {
    int column, row;
    bool turned = false;  ///< by 180°
};
struct Arrangement {
    int columns, rows;
    std::array<Cell, 6> faces;  ///< +X −X +Y −Y +Z −Z, of OpenGL's coordinates
};

constexpr Arrangement kStrip{1, 6, {{{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}}}};
constexpr Arrangement kRow{6, 1, {{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}}}};
constexpr Arrangement kHorizontal{4, 3, {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}}}};
constexpr Arrangement kVertical{3, 4, {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {1, 3, true}}}};

const Arrangement& cellsOf(CubeArrangement arrangement) {
    switch (arrangement) {
        case CubeArrangement::Strip:
            return kStrip;
        case CubeArrangement::Row:
            return kRow;
        case CubeArrangement::HorizontalCross:
            return kHorizontal;
        case CubeArrangement::VerticalCross:
            break;
    }
    return kVertical;
}

/// Texel of a face in OpenEXR's orientation that lies at (x, y) in OpenGL's, and the other way round.
glm::ivec2 turnedTexel(int face, int size, int x, int y) {
    const bool poles = face == 2 || face == 3;
    return poles ? glm::ivec2(x, size - 1 - y) : glm::ivec2(size - 1 - x, y);
}

}  // namespace

EnvMap cubeFromArrangement(const Image& image, CubeArrangement arrangement, FaceOrientation orientation) {
    const Arrangement& cells = cellsOf(arrangement);
    const int size = image.width() / cells.columns;
    require(
        image.channels() == 3 && size >= 1 && size * cells.columns == image.width() &&
            size * cells.rows == image.height(),
        fmt::format("cubeFromArrangement: expected three channels and proportions {}:{}", cells.columns, cells.rows));
    const bool cross = arrangement == CubeArrangement::HorizontalCross || arrangement == CubeArrangement::VerticalCross;
    const bool gl = orientation == FaceOrientation::Gl;
    EnvMap out(EnvLayout::Cube, size);
    for (int face = 0; face < 6; ++face) {
        // The middle of a cross is what one sees looking ahead: −Z in a right-handed world.
        const Cell& cell = cells.faces[static_cast<std::size_t>(cross && !gl && face >= 4 ? 9 - face : face)];
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                glm::ivec2 from = gl ? turnedTexel(face, size, x, y) : glm::ivec2(x, y);
                if (cell.turned) from = size - 1 - from;
                out.image.setRgb(x, face * size + y, image.rgb(cell.column * size + from.x, cell.row * size + from.y));
            }
    }
    return out;
}

Image glFace(const EnvMap& cube, int face) {
    require(cube.layout == EnvLayout::Cube && face >= 0 && face < 6, "glFace: expected a cube and a face 0 to 5");
    const int size = cube.size();
    Image out(size, size, 3);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const glm::ivec2 from = turnedTexel(face, size, x, y);
            out.setRgb(x, y, cube.image.rgb(from.x, face * size + from.y));
        }
    return out;
}

double seamMismatch(const EnvMap& cube) {
    require(cube.layout == EnvLayout::Cube && cube.size() >= 1, "seamMismatch: expected a cube");
    const int size = cube.size();
    double sum = 0;
    for (int face = 0; face < 6; ++face)
        for (int side = 0; side < 4; ++side)
            for (int i = 0; i < size; ++i) {
                const bool vertical = side < 2, far = side % 2;
                const int x = vertical ? (far ? size - 1 : 0) : i, y = vertical ? i : (far ? size - 1 : 0);
                // Exactly on the edge the filter gives the mean of both texels; just inside it does so nearly.
                const double inset = 1e-6;
                const double px = vertical ? (far ? size - inset : inset) : i + 0.5;
                const double py = vertical ? i + 0.5 : (far ? size - inset : inset);
                const Rgb own = cube.image.rgb(x, face * size + y);
                const Rgb both = sampleEnv(cube, envDirection(EnvLayout::Cube, size, px, face * size + py));
                const double total = 2 * mean(glm::abs(both));
                if (total > 0) sum += std::min(1.0, mean(glm::abs(own - both)) * 2 / total);
            }
    return sum / (24.0 * size);
}

}  // namespace nacre
