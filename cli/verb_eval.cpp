// nacre eval: what the shader computes from a file, for directions on standard input, beside the truth.
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <memory>
#include <optional>

#include "cli/data_report.hpp"
#include "cli/direction_lines.hpp"
#include "cli/terminal.hpp"
#include "cli/verb.hpp"
#include "core/asset.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "reference/factored_metrics.hpp"

namespace nacre::cli {

namespace {

constexpr std::size_t kBatch = 1 << 16;  ///< pairs that are evaluated together: bounded memory for any input
constexpr std::size_t kBlock = 1 << 16;  ///< bytes read at once
constexpr std::size_t kMaxLine = 1 << 16;

struct Settings {
    std::string file, source;
    unsigned threads = 0;
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

/// Calls take(line) for each line of standard input, the last one with or without its line end.
template <typename Take>
static void forEachLine(Take&& take) {
    std::string pending;
    std::vector<char> block(kBlock);
    while (const std::size_t count = std::fread(block.data(), 1, block.size(), stdin)) {
        pending.append(block.data(), count);
        std::size_t begin = 0;
        for (std::size_t end; (end = pending.find('\n', begin)) != std::string::npos; begin = end + 1)
            take(std::string_view(pending).substr(begin, end - begin));
        pending.erase(0, begin);
        if (pending.size() > kMaxLine)
            throw Error(
                fmt::format("standard input: expected lines of at most {} bytes, found a longer one", kMaxLine));
    }
    if (std::ferror(stdin)) throw Error(fmt::format("standard input: can't read: {}", std::strerror(errno)));
    if (!pending.empty()) take(pending);
}

static void runEval(const Settings& s) {
    const Asset asset = readAsset(s.file);
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
    forEachLine([&](std::string_view line) {
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
        "f [1/sr] without the cosine; with --source r,g,b,R,G,B, where R,G,B is the unbaked truth.";
    const auto threads = [s](long long v) { s->threads = static_cast<unsigned>(v); };
    verb.options = {{"file", "FILE", "A baked asset of kind brdf", into(s->file), true},
                    {"--source", "SOURCE", "Model or file that the truth comes from", into(s->source)},
                    {"--threads", "N", "0 = all cores", integerInto(threads, 0, 1024)}};
    verb.run = [s] { runEval(*s); };
    return verb;
}

}  // namespace nacre::cli
