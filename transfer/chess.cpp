#include "transfer/chess.hpp"

#include <meshoptimizer.h>

#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <map>
#include <tuple>

#include "core/error.hpp"

namespace nacre {
namespace {

constexpr double kPly = 1.5, kMoveTime = 1.0;  // from move to move, and of one [s]
constexpr double kBase = 0.8;                  // widest base of the set, in squares
constexpr double kBoardEdge = 10;              // with the margin that receives shadows and the queen
constexpr double kGap = 0.01;                  // below a piece: blockers apart from what they shade
constexpr double kLift = 0.7, kKnightLift = 1.8;

struct Placed {
    ChessPiece kind;
    bool white;
    const char* square;
};
constexpr Placed kPieces[] = {
    {ChessPiece::King, true, "g1"},  {ChessPiece::Queen, true, "c4"}, {ChessPiece::Knight, true, "g5"},
    {ChessPiece::Pawn, true, "f2"},  {ChessPiece::Pawn, true, "g2"},  {ChessPiece::Pawn, true, "h2"},
    {ChessPiece::King, false, "h8"}, {ChessPiece::Rook, false, "d8"}, {ChessPiece::Pawn, false, "a7"},
    {ChessPiece::Pawn, false, "g7"}, {ChessPiece::Pawn, false, "h7"}};
constexpr std::size_t kQueen = 1, kKnight = 2, kBlackKing = 6, kRook = 7;

struct Move {
    std::size_t piece;
    int ply;
    Vec3 to;
};

Vec3 squareAt(const std::string& name) { return {name[0] - 'a' - 3.5, kGap, 3.5 - (name[1] - '1')}; }

std::vector<Move> moves() {
    return {{kKnight, 0, squareAt("f7")},      {kBlackKing, 1, squareAt("g8")}, {kKnight, 2, squareAt("h6")},
            {kBlackKing, 3, squareAt("h8")},   {kQueen, 4, squareAt("g8")},     {kRook, 5, squareAt("g8")},
            {kQueen, 5, Vec3(4.55, kGap, -2)}, {kKnight, 6, squareAt("f7")}};
}

/// Cubic Bézier curve with one control point straight above each end, slow at both.
Vec3 onCurve(const Vec3& a, const Vec3& b, double lift, double share) {
    const double s = share * share * (3 - 2 * share);
    Vec3 p = a + (b - a) * (s * s * (3 - 2 * s));
    p.y += 4 * lift * s * (1 - s);  // control points at 4/3 of the lift
    return p;
}

Vec3 placeAt(std::size_t piece, double time) {
    Vec3 place = squareAt(kPieces[piece].square);
    const double lift = kPieces[piece].kind == ChessPiece::Knight ? kKnightLift : kLift;
    for (const Move& move : moves()) {
        const double share = (time - move.ply * kPly) / kMoveTime;
        if (move.piece == piece && share > 0) place = onCurve(place, move.to, lift, std::min(share, 1.0));
    }
    return place;
}

/// Joins vertices at one place and simplifies to at most so many triangles. Drops what is left unused.
Mesh simplified(const Mesh& in, std::size_t triangles) {
    std::map<std::tuple<float, float, float>, std::uint32_t> known;
    std::vector<glm::vec3> places;
    std::vector<std::uint32_t> numberOf, indices;
    for (const glm::vec3& p : in.positions) {
        const auto [found, isNew] = known.emplace(std::tuple(p.x, p.y, p.z), static_cast<std::uint32_t>(places.size()));
        if (isNew) places.push_back(p);
        numberOf.push_back(found->second);
    }
    for (const glm::uvec3& t : in.triangles) {
        const glm::uvec3 n(numberOf[t.x], numberOf[t.y], numberOf[t.z]);
        if (n.x != n.y && n.y != n.z && n.z != n.x) indices.insert(indices.end(), {n.x, n.y, n.z});
    }
    if (indices.size() > 3 * triangles) {
        std::vector<std::uint32_t> fewer(indices.size());
        fewer.resize(meshopt_simplify(fewer.data(), indices.data(), indices.size(), &places[0].x, places.size(),
                                      sizeof(glm::vec3), 3 * triangles, 1e3f, 0, nullptr));
        if (fewer.size() > 3 * triangles)  // its topology forbids: without it
            fewer.resize(meshopt_simplifySloppy(fewer.data(), indices.data(), indices.size(), &places[0].x,
                                                places.size(), sizeof(glm::vec3), 3 * triangles, 1e3f, nullptr));
        indices = std::move(fewer);
    }
    Mesh out;
    std::map<std::uint32_t, std::uint32_t> used;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        glm::uvec3 t;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto [found, isNew] = used.emplace(indices[i + c], static_cast<std::uint32_t>(out.positions.size()));
            if (isNew) out.positions.push_back(places[indices[i + c]]);
            t[static_cast<int>(c)] = found->second;
        }
        out.triangles.push_back(t);
    }
    return out;
}

struct Box {
    Vec3 low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};
};

Box boxOf(const Mesh& mesh) {
    Box box;
    for (const glm::vec3& p : mesh.positions) {
        box.low = glm::min(box.low, Vec3(p));
        box.high = glm::max(box.high, Vec3(p));
    }
    return box;
}

/// One scale for all, each piece on its middle, its foot at y = 0.
ChessSet fitted(const ChessSet& set, std::size_t triangles) {
    double widest = 0;
    for (const Mesh& mesh : set) {
        require(!mesh.triangles.empty(), "chessAnimation: a piece is empty");
        const Box box = boxOf(mesh);
        widest = std::max({widest, box.high.x - box.low.x, box.high.z - box.low.z});
    }
    require(std::isfinite(widest) && widest > 0, "chessAnimation: the pieces have no extent");
    ChessSet out;
    for (std::size_t i = 0; i < set.size(); ++i) {
        const Box box = boxOf(set[i]);
        const Vec3 foot(0.5 * (box.low.x + box.high.x), box.low.y, 0.5 * (box.low.z + box.high.z));
        out[i] = simplified(set[i], triangles);
        for (glm::vec3& p : out[i].positions) p = (Vec3(p) - foot) * (kBase / widest);
    }
    return out;
}

MovingBody boardBody(int n, std::size_t frames) {
    MovingBody out;
    out.frames.assign(frames, glm::dmat4(1));
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            out.positions.push_back(Vec3(i / double(n - 1) - 0.5, 0, j / double(n - 1) - 0.5) * kBoardEdge);
    for (int j = 0; j + 1 < n; ++j)
        for (int i = 0; i + 1 < n; ++i) {
            const auto a = static_cast<std::uint32_t>(j * n + i), c = a + static_cast<std::uint32_t>(n);
            out.triangles.insert(out.triangles.end(), {{a, c, c + 1}, {a, c + 1, a + 1}});
        }
    return out;
}

}  // namespace

AnimatedMesh chessAnimation(const ChessSet& set, const ChessOptions& options) {
    const double rate = options.framesPerSecond;
    require(std::isfinite(rate) && rate > 0 && rate <= 1e4, "chessAnimation: rate must be finite, > 0 and <= 10000");
    require(options.frames >= 0, "chessAnimation: frames must be >= 0");
    require(options.boardVertices >= 2 && options.boardVertices <= 1024,
            "chessAnimation: expected 2 to 1024 vertices along the board");
    require(options.triangles >= 8, "chessAnimation: expected at least 8 triangles a piece");
    const auto all = static_cast<std::size_t>(7 * kPly * rate + 1e-6) + 1;
    const std::size_t frames = options.frames > 0 ? std::min(all, static_cast<std::size_t>(options.frames)) : all;
    const ChessSet pieces = fitted(set, options.triangles);
    std::vector<MovingBody> bodies = {boardBody(options.boardVertices, frames)};
    for (std::size_t i = 0; i < std::size(kPieces); ++i) {
        const Mesh& mesh = pieces[static_cast<std::size_t>(kPieces[i].kind)];
        MovingBody body{mesh.positions, {}, mesh.triangles, {}};
        for (std::size_t f = 0; f < frames; ++f) {
            const glm::dmat4 place = glm::translate(glm::dmat4(1), placeAt(i, static_cast<double>(f) / rate));
            body.frames.push_back(kPieces[i].white ? place : glm::rotate(place, kPi, Vec3(0, 1, 0)));
        }
        bodies.push_back(std::move(body));
    }
    return rigidAnimation(bodies, rate, "chess");
}

}  // namespace nacre
