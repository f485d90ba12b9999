// What holds for every analytic model: the text, the hard cases, reciprocity, pieces that multiply back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "core/file.hpp"
#include "model_test_util.hpp"

using namespace nacre;
using namespace nacre::test;
using testing::HasSubstr;

constexpr double kRounding = 1e-9;  // relative: exponents of 1e6 amplify 1e-16 by 1e6, slopes of 1e-3 by 1e6

namespace {

/// One of each, and the extremes of each.
const std::vector<std::string> kModels = {
    "lambert:kd=0.9/0.5/0.1",
    "phong:n=20,kd=0.2",
    "phong:n=0",
    "phong:n=1000000",
    "blinn-phong:n=80,kd=0.1/0.2/0.3",
    "blinn-phong:n=0",
    "blinn-phong:n=1000000",
    "cosine-lobe:cxy=-0.8,cz=0.9,n=30",
    "cosine-lobe:cx=0.7,cy=-1,cz=0.5,n=30",
    "torrance-sparrow",
    "torrance-sparrow:alpha=0.001",
    "torrance-sparrow:alpha=1",
    "torrance-sparrow:d=ggx,alpha=0.001,f=conductor,eta=0.2/0.4/1.4,k=3.9/2.4/1.6",
    "torrance-sparrow:d=ggx,alpha=1,f=none",
    "torrance-sparrow:d=gaussian,alpha=0.001,g=v-cavity,kd=0.3",
    "torrance-sparrow:d=gaussian,alpha=1,f=schlick,f0=0.9/0.5/0.1",
    "torrance-sparrow:eta=1,kd=0.5",
    "torrance-sparrow:eta=200",
    "torrance-sparrow:f=conductor,eta=200,k=200",
    "torrance-sparrow:f=conductor,eta=1,k=0",
    "torrance-sparrow:eta=0.6",
    "cook-torrance:alpha=0.1",
    "ggx:alphax=0.1,alphay=0.4",
    "ggx:alphax=0.001,alphay=1,g=smith",
    "ggx:alpha=0.001,f=none",
    "ward:alphax=0.1,alphay=0.3",
    "ward:alpha=0.001,variant=duer",
    "ward:alpha=1,variant=duer",
    "ward:alphax=0.001,alphay=1,variant=gmd",
    "ashikhmin-shirley:nu=50,nv=500,rd=0.5",
    "ashikhmin-shirley:nu=0,nv=1000000",
    "ashikhmin-shirley:n=1000000,rs=1",
    "schlick:r=0.04",
    "schlick:r=0.000001,f0=1",
    "schlick:r=1,p=0.01,kd=0.3",
    "banks:kd=0,n=1000000",
    "banks:kd=0,ks=1/0.5/0.2,r=2",
    "sgd:gold-paint",
    "sgd:material=nickel",
};

/// Directions at and near everything that can go wrong.
std::vector<Vec3> hardDirections() {
    std::vector<Vec3> list = {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0.6, 0, -0.8), Vec3(0, 0, -1)};
    for (double deg : {1e-6, 30., 89.9, 89.999999, 90.})
        for (double phi : {0., 1e-9, 0.7, kPi / 2, kPi, kPi + 1e-9, 5.})
            list.push_back(sphericalDirection(deg * kDegree, phi));
    return list;
}

std::string messageOf(const std::string& text) {
    try {
        makeModel(text);
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
    return "accepted";
}

void expectClose(const Rgb& a, const Rgb& b, double relative, const std::string& where) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], relative * std::max(std::abs(a[c]), std::abs(b[c]))) << where;
}

}  // namespace

TEST(Models, FiniteAndNonNegativeAtGrazingAnglesAndExtremeParameters) {
    const std::vector<Vec3> directions = hardDirections();
    for (const std::string& text : kModels) {
        const Reflectance model = makeModel(text);
        for (const Vec3& wi : directions)
            for (const Vec3& wo : directions) {
                const Rgb f = model.f(wi, wo);
                ASSERT_TRUE(isFinite(f) && f.r >= 0 && f.g >= 0 && f.b >= 0)
                    << text << " wi " << wi.x << "," << wi.y << "," << wi.z << " wo " << wo.x << "," << wo.y << ","
                    << wo.z;
                if (wi.z <= 0 || wo.z <= 0) {
                    ASSERT_EQ(f, Rgb(0)) << text;
                }
            }
    }
}

TEST(Models, Reciprocity) {
    std::mt19937 random(1);
    for (const std::string& text : kModels) {
        const Reflectance model = makeModel(text);
        for (int i = 0; i < 300; ++i) {
            const DirectionPair d = randomPairInLobe(random, i % 3 == 0 ? 1 : i % 3 == 1 ? 0.1 : 1e-3);
            expectClose(model.f(d.wi, d.wo), model.f(d.wo, d.wi), kRounding, text);
        }
    }
}

TEST(Models, IsotropicFlagMeansInvarianceUnderRotation) {
    std::mt19937 random(2);
    constexpr double kRotation = 1e-7;  // rounding of the rotation, amplified by exponents of 1e6
    for (const std::string& text : kModels) {
        const Reflectance model = makeModel(text);
        double worst = 0;
        for (int i = 0; i < 300; ++i) {
            const DirectionPair d = randomPairInLobe(random, i % 2 ? 0.3 : 3e-3);
            const double angle = 0.1 + 0.02 * i, c = std::cos(angle), s = std::sin(angle);
            const auto turn = [&](const Vec3& w) { return Vec3(c * w.x - s * w.y, s * w.x + c * w.y, w.z); };
            const Rgb a = model.f(d.wi, d.wo), b = model.f(turn(d.wi), turn(d.wo));
            if (maxComponent(a) > 1e-250) worst = std::max(worst, maxComponent(glm::abs(a - b)) / maxComponent(a));
        }
        EXPECT_EQ(worst < kRotation, model.isotropic) << text << " " << worst;
    }
}

TEST(Models, PiecesMultiplyBackToF) {
    std::mt19937 random(3);
    for (const std::string& text : kModels) {
        const Reflectance model = makeModel(text);
        const bool separate = model.source.rfind("sgd", 0) == 0;  // its D, G and F differ per channel: no pieces
        ASSERT_EQ(separate, !(model.microfacet || model.singleLobe || model.tangent)) << text;
        if (separate) continue;
        for (int i = 0; i < 300; ++i) {
            const auto [wi, wo] = randomPairInLobe(random, i % 3 == 0 ? 1 : i % 3 == 1 ? 0.1 : 1e-3);
            if (wi.z <= 0) continue;
            const Vec3 h = halfVector(wi, wo);
            Rgb value(0);
            if (model.microfacet) {
                const MicrofacetPieces& m = *model.microfacet;
                value = m.diffuse(wi, wo) +
                        m.fresnel(0.5 * glm::length(wi + wo)) * m.distribution(h) * m.visibility(wi, wo);
                if (m.diffuseIsConstant) {
                    EXPECT_EQ(m.diffuse(wi, wo), m.diffuse(Vec3(0, 0, 1), Vec3(0, 0, 1))) << text;
                }
            } else if (model.singleLobe) {
                const SingleLobePieces& s = *model.singleLobe;
                value = s.diffuse +
                        s.lobe(s.argument == SingleLobePieces::Argument::Half ? h.z : glm::dot(s.axis, wi * wo));
            } else {
                value = model.tangent->value(wi.x, wo.x);
            }
            expectClose(model.f(wi, wo), value, kRounding, text);
        }
    }
}

TEST(Models, VisibilityOfTheElevationsAloneWhenItSaysSo) {
    std::mt19937 random(4);
    for (const std::string& text : kModels) {
        const Reflectance model = makeModel(text);
        if (!model.microfacet || !model.microfacet->visibilityIsIsotropic) continue;
        for (int i = 0; i < 50; ++i) {
            const Vec3 wi = randomDirection(random), wo = randomDirection(random);
            const Vec3 turned = sphericalDirection(std::acos(wi.z), 0.1 * i);
            EXPECT_NEAR(model.microfacet->visibility(wi, wo) / model.microfacet->visibility(turned, wo), 1, 1e-9)
                << text;
        }
    }
}

TEST(Models, CanonicalTextRoundTrips) {
    for (const std::string& text : kModels) {
        const Reflectance model = makeModel(text), again = makeModel(model.source);
        EXPECT_EQ(model.source, again.source);
        EXPECT_EQ(model.kind, "analytic");
        EXPECT_EQ(model.hash, contentHash(model.source));
        const Vec3 wi = sphericalDirection(0.3, 0.2), wo = sphericalDirection(0.31, 3.4);
        EXPECT_EQ(model.f(wi, wo), again.f(wi, wo)) << text;
    }
    EXPECT_EQ(makeModel("lambert:kd=0.1/0.2/0.30000000000000004").source, "lambert:kd=0.1/0.2/0.30000000000000004");
    EXPECT_EQ(makeModel("ward:alpha=0.25").source, "ward:variant=ward1992,alphax=0.25,alphay=0.25,ks=0.5,kd=0");
    EXPECT_EQ(makeModel("phong:n=1e2").source, makeModel("phong:n=100,ks=1/1/1").source);
}

TEST(Models, ListAgreesWithMakeModel) {
    for (const ModelInfo& info : listModels()) {
        EXPECT_FALSE(info.summary.empty() || info.source.empty());
        const std::string canonical = makeModel(info.name).source;  // all defaults
        EXPECT_EQ(canonical.rfind(info.name, 0), 0u);
        for (const ModelParameter& p : info.parameters) {
            EXPECT_FALSE(p.range.empty()) << info.name << " " << p.name;
            if (p.defaultValue.front() == '(') continue;  // a shorthand
            EXPECT_THAT(canonical, HasSubstr(p.name + "=" + p.defaultValue));
            EXPECT_EQ(makeModel(info.name + ":" + p.name + "=" + p.defaultValue).source, canonical);
        }
    }
}

TEST(Models, UnknownNamesAndBadValuesSayWhatIsKnown) {
    EXPECT_THAT(messageOf("gloss"), HasSubstr("known: lambert, phong, blinn-phong"));
    EXPECT_THAT(messageOf(""), HasSubstr("known: lambert"));
    EXPECT_THAT(messageOf("phong:roughness=1"), HasSubstr("unknown parameter 'roughness'; known: kd, ks, n, ambient"));
    EXPECT_THAT(messageOf("ggx:alpha=0"), HasSubstr("alpha=0 is not in [0.0001, 1]"));
    EXPECT_THAT(messageOf("ggx:alphax=nan"), HasSubstr("not in [0.0001, 1]"));
    EXPECT_THAT(messageOf("ggx:alphax=0.1x"), HasSubstr("not in"));
    EXPECT_THAT(messageOf("ggx:alphax="), HasSubstr("not in"));
    EXPECT_THAT(messageOf("ggx:alphax=0.1/0.2/0.3"), HasSubstr("not in"));
    EXPECT_THAT(messageOf("phong:ks=0.1/0.2"), HasSubstr("[0, 1] or r/g/b"));
    EXPECT_THAT(messageOf("phong:ks=0.1/0.2/1.5"), HasSubstr("[0, 1] or r/g/b"));
    EXPECT_THAT(messageOf("phong:n=1000001"), HasSubstr("[0, 1e+06]"));
    EXPECT_THAT(messageOf("torrance-sparrow:d=phong"), HasSubstr("known: beckmann | ggx | gaussian"));
    EXPECT_THAT(messageOf("ward:alpha=0.1,alphax=0.2"), HasSubstr("not both"));
    EXPECT_THAT(messageOf("phong:n=1,n=2"), HasSubstr("given twice"));
    EXPECT_THAT(messageOf("phong:n"), HasSubstr("no key=value"));
    EXPECT_THAT(messageOf("phong:n=1,"), HasSubstr("no key=value"));
    EXPECT_THAT(messageOf("phong:,n=1"), HasSubstr("no key=value"));
    for (const char* text : {"gloss", "phong:x=1", "ggx:alpha=0"})
        EXPECT_EQ(messageOf(text).find('\n'), std::string::npos);
}

TEST(Models, SameFromSeveralThreads) {
    const Reflectance model = makeModel("torrance-sparrow:f=conductor,eta=0.2/0.4/1.4");
    const Vec3 wi = sphericalDirection(0.5, 0), wo = sphericalDirection(0.45, 3);
    const Rgb expected = model.f(wi, wo);
    std::vector<int> same(4, 0);
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 4; ++t)
            threads.emplace_back([&, t] {
                for (int i = 0; i < 1000; ++i) same[t] += model.f(wi, wo) == expected;
            });
    }
    for (int count : same) EXPECT_EQ(count, 1000);
}
