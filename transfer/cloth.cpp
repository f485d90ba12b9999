#include "transfer/cloth.hpp"

#include <random>

#include "core/error.hpp"

namespace nacre {
namespace {

constexpr double kGravity = 9.81;     // [m/s²]
constexpr double kThickness = 0.01;   // kept from ball and floor: blockers apart from what they shade [m]
constexpr double kFriction = 0.6;     // Coulomb's, of ball and floor
constexpr double kDrag = 2.5;         // of the air on a triangle facing it [1/s]
constexpr double kAirDamping = 0.15;  // of any motion [1/s]
constexpr double kGust = 0.8;         // of the mean wind
constexpr int kGusts = 4;             // waves that the gusts are made of
constexpr double kBend = 0.02;        // share of a bending constraint's error that one sweep corrects
constexpr double kShear = 0.5;        // the same across squares

struct Link {
    std::size_t a, b;
    double length, stiffness;
};

/// Waves that pass over the cloth, with pseudo-random phases.
class Breeze {
public:
    Breeze(double speed, std::uint64_t seed) : speed_(speed) {
        std::mt19937_64 random(seed);
        const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
        for (int i = 0; i < kGusts; ++i) waves_.push_back({unit() * 2 * kPi, 0.3 + 1.2 * unit(), 0.5 + 2 * unit()});
    }
    Vec3 at(const Vec3& p, double time) const {
        double gust = 0;
        for (const Wave& w : waves_) gust += std::sin(w.phase + 2 * kPi * w.frequency * time - w.number * (p.x + p.z));
        return speed_ * (1 + kGust * gust / std::sqrt(kGusts)) * Vec3(0.8, 0.1, 0.6);
    }

private:
    struct Wave {
        double phase, frequency, number;  // [rad], [1/s], [rad/m]
    };
    double speed_;
    std::vector<Wave> waves_;
};

AnimatedMesh gridMesh(int n, double edge, double y) {
    AnimatedMesh out;
    out.frames.resize(1);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const glm::dvec2 uv = glm::dvec2(i, j) / double(n - 1);
            out.uvs.push_back(uv);
            out.frames[0].push_back(Vec3((uv.x - 0.5) * edge, y, (uv.y - 0.5) * edge));
        }
    for (int j = 0; j + 1 < n; ++j)
        for (int i = 0; i + 1 < n; ++i) {
            const auto a = static_cast<std::uint32_t>(j * n + i), b = a + 1, c = a + static_cast<std::uint32_t>(n);
            if ((i + j) % 2)  // diagonals alternate, so that the cloth folds in no direction more easily
                out.triangles.insert(out.triangles.end(), {{a, c, b}, {b, c, c + 1}});
            else
                out.triangles.insert(out.triangles.end(), {{a, c, c + 1}, {a, c + 1, b}});
        }
    return out;
}

class Cloth {
public:
    Cloth(const ClothOptions& options, const AnimatedMesh& grid)
        : options_(options),
          triangles_(grid.triangles),
          breeze_(options.breeze, options.seed),
          places_(grid.frames[0].begin(), grid.frames[0].end()),
          velocities_(places_.size(), Vec3(0)) {
        link(1, 1, kShear);
        link(-1, 1, kShear);
        link(2, 0, kBend);
        link(0, 2, kBend);
        link(1, 0, 1);  // edges come last: what the others do to them is put right
        link(0, 1, 1);
    }

    void step(double h, double time) {
        const std::vector<Vec3> before = places_;
        blow(h, time);
        for (std::size_t i = 0; i < places_.size(); ++i) {
            velocities_[i].y -= kGravity * h;
            velocities_[i] /= 1 + kAirDamping * h;
            places_[i] += h * velocities_[i];
        }
        for (const Link& l : links_) satisfy(l);
        for (std::size_t i = 0; i < places_.size(); ++i) {
            collide(places_[i], before[i]);
            velocities_[i] = (places_[i] - before[i]) / h;
        }
    }

    const std::vector<Vec3>& places() const { return places_; }

private:
    void link(int dx, int dy, double stiffness) {
        const int n = options_.clothVertices;
        for (int j = 0; j + dy < n; ++j)
            for (int i = std::max(0, -dx); i + std::max(0, dx) < n; ++i) {
                const auto a = static_cast<std::size_t>(j * n + i), b = static_cast<std::size_t>((j + dy) * n + i + dx);
                links_.push_back({a, b, glm::length(places_[a] - places_[b]), stiffness});
            }
    }

    void satisfy(const Link& l) {
        const Vec3 along = places_[l.b] - places_[l.a];
        const double length = glm::length(along);
        if (length == 0) return;  // no direction to part them: other links will
        const Vec3 move = 0.5 * l.stiffness * (1 - l.length / length) * along;
        places_[l.a] += move;
        places_[l.b] -= move;
    }

    /// Wind takes along what faces it: the velocity's part along the normal decays towards the wind's, implicitly, so
    /// that no step is too long.
    void blow(double h, double time) {
        if (options_.breeze == 0) return;
        std::vector<Vec3> normals(places_.size(), Vec3(0));
        for (const glm::uvec3& t : triangles_) {
            const Vec3 n = glm::cross(places_[t.y] - places_[t.x], places_[t.z] - places_[t.x]);
            for (int c = 0; c < 3; ++c) normals[t[c]] += n;
        }
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const double length = glm::length(normals[i]);
            if (length == 0) continue;
            const Vec3 n = normals[i] / length;
            const double behind = glm::dot(n, breeze_.at(places_[i], time) - velocities_[i]);
            velocities_[i] += n * behind * (kDrag * h / (1 + kDrag * h));
        }
    }

    /// Out of ball and floor, with Coulomb's friction on the way since the last step.
    void collide(Vec3& place, const Vec3& before) const {
        const Vec3 out = place - options_.ball;
        const double radius = options_.ballRadius + kThickness, distance = glm::length(out);
        if (options_.ballRadius > 0 && distance < radius && distance > 0)
            pushOut(place, before, out / distance, radius - distance);
        if (place.y < kThickness) pushOut(place, before, {0, 1, 0}, kThickness - place.y);
        place.y = std::max(place.y, kThickness);
    }

    static void pushOut(Vec3& place, const Vec3& before, const Vec3& normal, double depth) {
        place += depth * normal;
        const Vec3 way = place - before, slide = way - glm::dot(way, normal) * normal;
        const double length = glm::length(slide);
        if (length > 0) place -= slide * std::min(1.0, kFriction * depth / length);
    }

    const ClothOptions& options_;
    const std::vector<glm::uvec3>& triangles_;
    const Breeze breeze_;
    std::vector<Vec3> places_, velocities_;
    std::vector<Link> links_;
};

void check(const ClothOptions& o) {
    require(o.clothVertices >= 2 && o.floorVertices >= 2,
            "clothAnimation: grids need at least 2 vertices along an edge");
    require(o.clothVertices <= 1024 && o.floorVertices <= 1024,
            "clothAnimation: grids have at most 1024 vertices along an edge");
    require(o.frames >= 1 && o.frames <= 100'000, "clothAnimation: expected 1 to 100000 frames");
    require(o.stepsPerFrame >= 1, "clothAnimation: expected at least one step a frame");
    for (const double positive : {o.framesPerSecond, o.clothEdge, o.floorEdge, o.height})
        require(std::isfinite(positive) && positive > 0,
                "clothAnimation: rate, edges and height must be finite and > 0");
    for (const double any : {o.breeze, o.ballRadius})
        require(std::isfinite(any) && any >= 0, "clothAnimation: breeze and ball must be finite and >= 0");
    require(isFinite(o.ball), "clothAnimation: the ball must be somewhere");
}

}  // namespace

AnimatedMesh clothAnimation(const ClothOptions& options) {
    check(options);
    const AnimatedMesh grid = gridMesh(options.clothVertices, options.clothEdge, options.height);
    const AnimatedMesh floor = gridMesh(options.floorVertices, options.floorEdge, 0);
    AnimatedMesh out = grid;
    out.framesPerSecond = options.framesPerSecond;
    for (const glm::uvec3& t : floor.triangles)
        out.triangles.push_back(t + static_cast<std::uint32_t>(grid.vertexCount()));
    out.uvs.insert(out.uvs.end(), floor.uvs.begin(), floor.uvs.end());
    out.frames.clear();
    Cloth cloth(options, grid);
    const double h = 1 / (options.framesPerSecond * options.stepsPerFrame);
    for (int f = 0; f < options.frames; ++f) {
        for (int s = 0; f > 0 && s < options.stepsPerFrame; ++s)
            cloth.step(h, h * (double(f - 1) * options.stepsPerFrame + s));
        out.frames.emplace_back(cloth.places().begin(), cloth.places().end());
        out.frames.back().insert(out.frames.back().end(), floor.frames[0].begin(), floor.frames[0].end());
    }
    return out;
}

}  // namespace nacre
