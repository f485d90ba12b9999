// nacre sh: a surrounding as spherical harmonics.
#include <fmt/format.h>

#include <memory>

#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "cli/verb.hpp"
#include "core/error.hpp"
#include "envmaps/source.hpp"
#include "envmaps/spherical_harmonics.hpp"

namespace nacre::cli {

using nlohmann::json;

namespace {

struct Settings {
    std::string source, sourceLayout = "auto", negative = "clamp", lobe = "mirror", window = "none";
    SourceOptions in;
    int order = 2;
    bool asJson = false;
};

std::string coefficientsText(const SphericalHarmonics& sh) {
    std::string out;
    for (int l = 0; l <= sh.order; ++l)
        for (int m = -l; m <= l; ++m)
            out += fmt::format("{},{},{:.9g},{:.9g},{:.9g}\n", l, m, sh.at(l, m).x, sh.at(l, m).y, sh.at(l, m).z);
    return out;
}

void runSh(const Settings& given) {
    Settings s = given;
    s.in.layout = sourceLayoutFromString(s.sourceLayout);
    s.in.negative = negativePolicyFromString(s.negative);
    const Environment environment = readEnvironment(s.source, s.in);
    const TexelReport& texels = environment.report.texels;
    if (texels.negative + texels.nonFinite > 0)
        tell(fmt::format("{}: {} of {} texels negative, {} not finite: --negative {}", s.source, texels.negative,
                         texels.texels, texels.nonFinite, s.negative));
    const Stopwatch watch;
    SphericalHarmonics sh = projectEnvironment(environment.map, s.order, s.in.threads);
    if (s.lobe == "diffuse") sh = filterHarmonics(sh, {LobeKind::Diffuse});
    sh = windowHarmonics(sh, harmonicWindowFromString(s.window));
    if (!s.asJson) {
        putData(coefficientsText(sh));
        return;
    }
    json list = json::array();
    for (const Rgb& c : sh.coefficients) list.push_back({c.x, c.y, c.z});
    putData(json{{"kind", "spherical_harmonics"},
                 {"source", s.source},
                 {"source_hash", environment.report.hash},
                 {"order", s.order},
                 {"lobe", s.lobe},
                 {"window", s.window},
                 {"basis", "real, orthonormal, z polar, y up; entry l*l + l + m"},
                 {"input", toJson(environment.report)},
                 {"seconds", watch.seconds()},
                 {"cpu_seconds", watch.cpuSeconds()},
                 {"coefficients", list}}
                .dump(2) +
            "\n");
}

}  // namespace

Verb shVerb(Context&) {
    const auto s = std::make_shared<Settings>();
    Verb verb{"sh", "Project a radiance map onto spherical harmonics", {}, {}, {}};
    verb.details =
        "Prints lines l,m,r,g,b. The basis is real and orthonormal in the world's x, y, z: y_00 = 0.282095,\n"
        "y_1,-1 = 0.488603 y, y_10 = 0.488603 z, y_11 = 0.488603 x, y_2,-2 = 1.092548 xy, y_20 = 0.315392 (3z^2 - 1), "
        "…\n"
        "--lobe diffuse gives irradiance/pi by the normal: the radiance of a white Lambertian.";
    verb.options = {
        {"source", "SOURCE", "Picture, six pictures, or asset", into(s->source), true},
        {"--order", "L", "Highest degree, 0 to 1500 (default 2: nine coefficients)",
         integerInto([s](long long v) { s->order = static_cast<int>(v); }, 0, 1500)},
        {"--lobe",
         "NAME",
         "mirror: the radiance itself (default); diffuse",
         into(s->lobe),
         false,
         {"mirror", "diffuse"}},
        {"--window", "NAME", "Against ringing (default none)", into(s->window), false, {"none", "hann", "lanczos"}},
        {"--source-layout", "NAME", "Of the source (default auto)", into(s->sourceLayout), false, sourceLayoutNames()},
        {"--negative",
         "RULE",
         "For negative texels (default clamp)",
         into(s->negative),
         false,
         {"keep", "clamp", "error"}},
        {"--threads", "N", "0 = all cores",
         integerInto([s](long long v) { s->in.threads = static_cast<unsigned>(v); }, 0, 1024)},
        {"--json", "", "One JSON object on standard output", into(s->asJson)}};
    verb.run = [s] { runSh(*s); };
    return verb;
}

}  // namespace nacre::cli
