// Lobes: closed forms of their coefficients, and the kernels by angle against the lobes by half vectors.
#include "envmaps/lobes.hpp"

#include <gtest/gtest.h>

#include "reference/environment_error.hpp"

namespace nacre {
namespace {

constexpr double kQuadrature = 1e-9;

TEST(ZonalCoefficients, LambertsClosedForm) {  // Ramamoorthi & Hanrahan 2001, eq. 8, over its l = 0
    const std::vector<double> k = zonalCoefficients(zonalKernel({LobeKind::Diffuse}), 8);
    const double expected[] = {1, 2.0 / 3, 0.25, 0, -1.0 / 24, 0, 1.0 / 64, 0, -1.0 / 128};
    for (int l = 0; l <= 8; ++l) EXPECT_NEAR(k[l], expected[l], kQuadrature) << l;
}

TEST(ZonalCoefficients, PhongsRecurrence) {  // k_l = k_{l−2} (n + 2 − l)/(n + l + 1), k_0 = 1, k_1 = (n + 1)/(n + 2)
    for (const double n : {0.0, 1.0, 10.0, 100.0, 2048.0, 1e6}) {
        const std::vector<double> k = zonalCoefficients(zonalKernel({LobeKind::Phong, n}), 60);
        std::vector<double> expected{1, (n + 1) / (n + 2)};
        for (int l = 2; l <= 60; ++l) expected.push_back(expected[l - 2] * (n + 2 - l) / (n + l + 1));
        for (int l = 0; l <= 60; ++l) EXPECT_NEAR(k[l], expected[l], kQuadrature) << "n " << n << " l " << l;
    }
}

TEST(ZonalKernel, IntegralsHaveClosedForms) {
    EXPECT_NEAR(zonalIntegral(zonalKernel({LobeKind::Diffuse})), kPi, kQuadrature);
    for (const double n : {0.0, 1.0, 50.0, 1e4, 1e6})
        EXPECT_NEAR(zonalIntegral(zonalKernel({LobeKind::Phong, n})) * (n + 1) / (2 * kPi), 1, 1e-8) << n;
}

TEST(ZonalKernel, IsTheLobeByHalfVectors) {
    const Vec3 r(0, 0, 1);
    for (const LobeKind kind : {LobeKind::Diffuse, LobeKind::Phong, LobeKind::Ggx, LobeKind::Beckmann,
                                LobeKind::GgxRefraction, LobeKind::BeckmannRefraction})
        for (const double alpha : {0.05, 0.3, 1.0})
            for (const double ior : {0.5, 0.9, 1.1, 1.5, 2.4, 200.0}) {
                const Lobe lobe{kind, 37, alpha, ior};
                const ZonalKernel kernel = zonalKernel(lobe);
                const auto weightAt = [&](double t) { return lobeWeight(lobe, r, {std::sin(t), 0, std::cos(t)}); };
                const double scale = weightAt(1e-4) / kernel.value(1e-4);
                EXPECT_GT(scale, 0);
                for (double t = 1e-3; t < 1.55; t += 0.01)
                    EXPECT_NEAR(kernel.value(t) * scale, weightAt(t), 1e-6 * weightAt(1e-4))
                        << toString(kind) << " alpha " << alpha << " ior " << ior << " theta " << t;
            }
}

TEST(ZonalKernel, IsFiniteWhereParametersAreExtreme) {
    for (const Lobe& lobe : {Lobe{LobeKind::Phong, 1e6},
                             {LobeKind::Ggx, 0, 1e-3},
                             {LobeKind::Beckmann, 0, 1e-3},
                             {LobeKind::GgxRefraction, 0, 1, 1.0001},
                             {LobeKind::GgxRefraction, 0, 1e-3, 200},
                             {LobeKind::BeckmannRefraction, 0, 1, 0.01}}) {
        const ZonalKernel kernel = zonalKernel(lobe);
        for (double t = 0; t <= kPi; t += 1e-3) {
            EXPECT_TRUE(std::isfinite(kernel.value(t))) << toString(lobe.kind) << t;
            EXPECT_GE(kernel.value(t), 0);
        }
        EXPECT_GT(zonalIntegral(kernel), 0);
    }
}

TEST(Lobe, RejectsBadParametersAndNames) {
    EXPECT_THROW(zonalKernel({LobeKind::Mirror}), std::invalid_argument);
    EXPECT_THROW(zonalKernel({LobeKind::Phong, -1}), std::invalid_argument);
    EXPECT_THROW(zonalKernel({LobeKind::Phong, INFINITY}), std::invalid_argument);
    EXPECT_THROW(zonalKernel({LobeKind::Ggx, 0, 0}), std::invalid_argument);
    EXPECT_THROW(zonalKernel({LobeKind::Ggx, 0, 1.5}), std::invalid_argument);
    EXPECT_THROW(zonalKernel({LobeKind::GgxRefraction, 0, 0.5, 0}), std::invalid_argument);
    EXPECT_THROW(validateLobe({LobeKind::GgxAnisotropic, 0, 0.5, 1, 0}), std::invalid_argument);
    EXPECT_THROW(validateLobe({LobeKind::GgxAnisotropic, 0, 0.5, 1, 0.5, Vec3(0)}), std::invalid_argument);
    EXPECT_THROW(zonalKernel({LobeKind::GgxAnisotropic, 0, 0.5, 1, 0.5}), std::invalid_argument);
    EXPECT_THROW(lobeKindFromString("gloss"), std::invalid_argument);
    for (const std::string& name : lobeNames()) EXPECT_EQ(toString(lobeKindFromString(name)), name);
}

}  // namespace
}  // namespace nacre
