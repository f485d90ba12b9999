#include "cli/eval_environment.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>

#include "cli/numbers.hpp"
#include "cli/terminal.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre::cli {

void EnvQueryReader::take(std::string_view line, std::vector<EnvQuery>& queries) {
    ++lineNumber_;
    line = trimmed(line);
    if (line.empty() || line.front() == '#') return;
    const bool first = !sawContent_;
    sawContent_ = true;
    std::array<double, 4> v{};
    const auto fail = [&](const std::string& expected) {
        throw Error(fmt::format("standard input: line {}: expected {}, found '{}'", lineNumber_, expected,
                                line.size() > 80 ? line.substr(0, 80) : line));
    };
    const bool withValue = parseNumbers(line, v);
    if (!withValue && !parseNumbers(line, std::span(v).first(3))) {
        if (first && line.front() == 'x') return;  // a header
        fail("three or four numbers x,y,z[,alpha]");
    }
    EnvQuery query{{v[0], v[1], v[2]}, {}};
    // Lengths are squared on the way: neither overflow nor a direction lost to underflow.
    if (!isFinite(query.direction) || maxComponent(glm::abs(query.direction)) == 0)
        fail("a finite direction that is not 0");
    query.direction /= maxComponent(glm::abs(query.direction));
    if (withValue) query.value = v[3];
    if (query.value && !std::isfinite(*query.value)) fail("a finite alpha");
    queries.push_back(query);
}

static void answer(const EnvChain& chain, const std::string& file, unsigned threads, std::vector<EnvQuery>& queries) {
    for (const EnvQuery& query : queries)
        if (query.value && !chain.mapping)
            throw Error(
                fmt::format("{}: expected lines x,y,z, as it has no level_mapping, found a fourth number", file));
    std::vector<Rgb> values(queries.size());
    parallelFor(queries.size(), threads, [&](std::size_t i) {
        const double lod = queries[i].value ? lodOf(*chain.mapping, *queries[i].value) : 0;
        values[i] = sampleChain(chain, queries[i].direction, lod);
    });
    fmt::memory_buffer text;  // 9 digits give back every float
    for (const Rgb& v : values) fmt::format_to(std::back_inserter(text), "{:.9g},{:.9g},{:.9g}\n", v.r, v.g, v.b);
    putData({text.data(), text.size()});
    queries.clear();
}

void evalEnvironment(const Asset& asset, const std::string& file, unsigned threads) {
    static constexpr std::size_t kBatch = 1 << 16;  // bounded memory for any input
    const EnvChain chain = envFromAsset(asset, file);
    EnvQueryReader reader;
    std::vector<EnvQuery> queries;
    forEachInputLine([&](std::string_view line) {
        reader.take(line, queries);
        if (queries.size() == kBatch) answer(chain, file, threads, queries);
    });
    answer(chain, file, threads, queries);
}

}  // namespace nacre::cli
