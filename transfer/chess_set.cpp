#include "core/error.hpp"
#include "transfer/chess.hpp"

namespace nacre {
namespace {

using Profile = std::vector<glm::dvec2>;  // radius and height, from the foot's rim up; both ends are closed on the axis

const Profile kFoot = {{0.40, 0.00}, {0.42, 0.12}, {0.30, 0.24}};

Profile withHead(Profile head) {
    head.insert(head.begin(), kFoot.begin(), kFoot.end());
    return head;
}

Profile profileOf(ChessPiece kind) {
    switch (kind) {
        case ChessPiece::King:
            return withHead(
                {{0.17, 0.60}, {0.15, 1.20}, {0.25, 1.32}, {0.18, 1.42}, {0.27, 1.75}, {0.08, 1.84}, {0.10, 2.0}});
        case ChessPiece::Queen:
            return withHead(
                {{0.16, 0.60}, {0.14, 1.10}, {0.24, 1.22}, {0.16, 1.32}, {0.28, 1.62}, {0.15, 1.66}, {0.07, 1.78}});
        case ChessPiece::Rook:
            return withHead({{0.23, 0.50}, {0.21, 0.85}, {0.29, 0.95}, {0.29, 1.20}, {0.20, 1.20}, {0.20, 1.08}});
        case ChessPiece::Bishop:
            return withHead(
                {{0.15, 0.60}, {0.13, 0.95}, {0.22, 1.05}, {0.14, 1.12}, {0.20, 1.30}, {0.12, 1.50}, {0.05, 1.60}});
        case ChessPiece::Knight:
            return withHead({{0.20, 0.45}, {0.18, 0.75}, {0.26, 1.00}, {0.24, 1.18}, {0.13, 1.32}});
        case ChessPiece::Pawn:
            break;
    }
    return withHead({{0.14, 0.45}, {0.12, 0.62}, {0.20, 0.68}, {0.11, 0.74}, {0.21, 0.90}, {0.13, 1.05}});
}

Mesh turned(const Profile& profile, int sides) {
    Mesh out;
    const auto n = static_cast<std::uint32_t>(sides);
    for (const glm::dvec2& ring : profile)
        for (int i = 0; i < sides; ++i) {
            const double a = 2 * kPi * i / sides;
            out.positions.push_back(Vec3(ring.x * std::cos(a), ring.y, -ring.x * std::sin(a)));
        }
    const auto foot = static_cast<std::uint32_t>(out.positions.size()), head = foot + 1;
    out.positions.push_back(Vec3(0, profile.front().y, 0));
    out.positions.push_back(Vec3(0, profile.back().y, 0));
    const auto last = static_cast<std::uint32_t>(profile.size() - 1);
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t j = (i + 1) % n;
        out.triangles.push_back({foot, j, i});
        for (std::uint32_t r = 0; r < last; ++r) {
            const std::uint32_t a = r * n + i, b = r * n + j;
            out.triangles.push_back({a, b, b + n});
            out.triangles.push_back({a, b + n, a + n});
        }
        out.triangles.push_back({head, last * n + i, last * n + j});
    }
    return out;
}

}  // namespace

ChessSet turnedChessSet(int sides) {
    require(sides >= 3 && sides <= 1024, "turnedChessSet: expected 3 to 1024 sides");
    ChessSet out;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = turned(profileOf(static_cast<ChessPiece>(i)), sides);
    for (glm::vec3& p : out[static_cast<std::size_t>(ChessPiece::Knight)].positions)  // a head that leans forward
        p.z -= 0.6f * std::max(0.0f, p.y - 0.8f);
    return out;
}

}  // namespace nacre
