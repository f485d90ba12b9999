#include "transfer/harmonic_rotation.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/math.hpp"
#include "envmaps/spherical_harmonics.hpp"

namespace nacre {
namespace {

TEST(HarmonicRotation, TurnsFunctions) {  // f'(R s) = f(s), by values of both at random directions
    std::mt19937 random(5);
    const auto uniform = [&] { return static_cast<double>(random()) / 2147483648.0 - 1; };
    for (int order = 0; order <= kMaxTransferOrder; ++order) {
        const HarmonicRotation rotation(order);
        const auto size = static_cast<std::size_t>((order + 1) * (order + 1));
        std::vector<Receiver> receivers(11);
        std::vector<float> local(size * 16), world(size * receivers.size());
        for (Receiver& r : receivers) {
            r.normal = glm::normalize(glm::vec3(uniform(), uniform(), uniform()));
            r.tangent = glm::normalize(glm::cross(r.normal, glm::vec3(uniform(), uniform(), uniform())));
            r.bitangent = glm::cross(r.normal, r.tangent);
        }
        for (float& x : local) x = static_cast<float>(uniform());
        rotation.turn(receivers.data(), receivers.size(), local.data(), world.data());
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            const Vec3 s = glm::normalize(Vec3(uniform(), uniform(), uniform()));
            const Receiver& r = receivers[i];
            const Vec3 turned = s.x * Vec3(r.tangent) + s.y * Vec3(r.bitangent) + s.z * Vec3(r.normal);
            const std::vector<double> y = realHarmonics(order, s), z = realHarmonics(order, turned);
            double before = 0, after = 0;
            for (std::size_t c = 0; c < size; ++c) {
                before += local[c * 16 + i] * y[c];
                after += world[i * size + c] * z[c];
            }
            EXPECT_NEAR(after, before, 1e-5 * static_cast<double>(size)) << order << " " << i;
        }
    }
}

TEST(HarmonicRotation, RefusesOrders) {
    EXPECT_THROW(HarmonicRotation(-1), std::invalid_argument);
    EXPECT_THROW(HarmonicRotation(7), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
