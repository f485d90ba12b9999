// nacre eval: what the shader computes from a file, for directions on standard input, beside the truth.
#include <fmt/format.h>

#include <iterator>
#include <memory>
#include <optional>

#include "cli/data_report.hpp"
#include "cli/direction_lines.hpp"
#include "cli/eval_bump.hpp"
#include "cli/eval_environment.hpp"
#include "cli/eval_table.hpp"
#include "cli/numbers.hpp"
#include "cli/terminal.hpp"
#include "cli/verb.hpp"
#include "core/asset.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "reference/factored_metrics.hpp"

namespace nacre::cli {

namespace {

constexpr std::size_t kBatch = 1 << 16;  ///< pairs that are evaluated together: bounded memory for any input

struct Settings {
    std::string file, source;
    unsigned threads = 0;
    bool seen = false, normal = false;
};

struct Evaluator {
    FactoredBrdf brdf;
    std::optional<BrdfFunction> truth;
    unsigned threads = 0;
};

}  // namespace

/// Evaluates and prints the pairs, and forgets them.
static void answer(const Evaluator& evaluator, std::vector<DirectionPair>& pairs) {
    std::vector<Rgb> baked(pairs.size()), truth(evaluator.truth ? pairs.size() : 0);
    parallelFor(pairs.size(), evaluator.threads, [&](std::size_t i) {
        baked[i] = evaluate(evaluator.brdf, pairs[i].wi, pairs[i].wo);
        if (evaluator.truth) truth[i] = (*evaluator.truth)(pairs[i].wi, pairs[i].wo);
    });
    fmt::memory_buffer text;  // 9 digits give back every float
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        fmt::format_to(std::back_inserter(text), "{:.9g},{:.9g},{:.9g}", baked[i].r, baked[i].g, baked[i].b);
        if (evaluator.truth)
            fmt::format_to(std::back_inserter(text), ",{:.9g},{:.9g},{:.9g}", truth[i].r, truth[i].g, truth[i].b);
        text.push_back('\n');
    }
    putData({text.data(), text.size()});
    pairs.clear();
}

static void runEval(const Settings& s) {
    const Asset asset = readAsset(s.file);
    if (asset.kind != "bump" && (s.seen || s.normal))
        throw UsageError(fmt::format("--seen, --normal: expected an asset of kind bump, found kind {}", asset.kind));
    if (asset.kind == "bump") {
        if (s.seen && s.normal) throw UsageError("--seen, --normal: expected one of them, found both");
        const BumpQuestion question = s.seen ? BumpQuestion::Seen : s.normal ? BumpQuestion::Normal : BumpQuestion::Lit;
        return evalBump(asset, s.file, s.source, question, s.threads);
    }
    if (asset.kind != "brdf" && !s.source.empty())
        throw UsageError(fmt::format("--source: expected an asset of kind brdf or bump, found kind {}", asset.kind));
    if (asset.kind == "environment") return evalEnvironment(asset, s.file, s.threads);
    if (isTable(asset)) return evalTable(asset, s.file);
    Evaluator evaluator{factoredFromAsset(asset, s.file), {}, s.threads};
    if (!s.source.empty()) {
        const Reflectance reflectance = openReflectance(s.source);
        tellDataReport(reflectance);
        const std::string own = asset.meta.value("source", "");
        if (!own.empty() && own != reflectance.source)
            tell(fmt::format("{}: baked from {}, set against {}", s.file, own, reflectance.source));
        evaluator.truth = truthOf(reflectance);
    }
    DirectionReader reader;
    std::vector<DirectionPair> pairs;
    forEachInputLine([&](std::string_view line) {
        reader.take(line, pairs);
        if (pairs.size() == kBatch) answer(evaluator, pairs);
    });
    answer(evaluator, pairs);
}

Verb evalVerb(Context&) {
    const auto s = std::make_shared<Settings>();
    Verb verb{"eval", "Evaluate an asset as the shader does, for directions on standard input", "", {}, {}};
    verb.details =
        "Standard input: lines wix,wiy,wiz,wox,woy,woz, unit directions away from the surface, z = normal; blank\n"
        "lines, lines that start with # and a header are skipped. Standard output: one line r,g,b for each, the BRDF\n"
        "f [1/sr] without the cosine; with --source r,g,b,R,G,B, where R,G,B is the unbaked truth.\n"
        "For an asset of kind environment: lines x,y,z[,alpha], a direction of any length; alpha (or the parameter "
        "that\n"
        "the asset's level_mapping names) chooses between the levels. Answer r,g,b, the radiance a shader fetches.\n"
        "For kind fresnel: lines cos, answer r,g,b. For kind scale_bias: lines cos,roughness (perceptual), answer "
        "scale,bias.\n"
        "For kind bump: lines u,v,lx,ly,lz, a point of the relief (u along columns, v along rows from row 0, the "
        "file's\n"
        "first) and a light's direction of any length, z out of the surface. Answer lit,lit_truth, 1 or 0: what the\n"
        "shader finds from the ellipses or, without, the horizons, bilinear between texels; and the exact horizon "
        "there\n"
        "(nan without heights: --source HEIGHT, or an asset baked with --heights). With --seen lines u,v,dx,dy,dz, "
        "answer\n"
        "hit,u,v,hit_truth,u_truth,v_truth: the point seen, of the nearest texel and stored direction; not wrapped, "
        "and "
        "nan\n"
        "for misses. With --normal lines u,v, answer x,y,z.\n"
        "Example: echo 0.5,0.5,0.6,0,0.8 | nacre eval rock.exr --source rock.png";
    const auto threads = [s](long long v) { s->threads = static_cast<unsigned>(v); };
    verb.options = {{"file", "FILE", "A baked asset", into(s->file), true},
                    {"--source", "SOURCE", "Model or file that the truth comes from", into(s->source)},
                    {"--seen", "", "Of a bump asset: what is seen in a direction", into(s->seen)},
                    {"--normal", "", "Of a bump asset: the normals", into(s->normal)},
                    {"--threads", "N", "0 = all cores", integerInto(threads, 0, 1024)}};
    verb.run = [s] { runEval(*s); };
    return verb;
}

}  // namespace nacre::cli
