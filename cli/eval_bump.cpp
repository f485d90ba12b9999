#include "cli/eval_bump.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <optional>

#include "bump/bump_lookup.hpp"
#include "bump/read_height.hpp"
#include "cli/numbers.hpp"
#include "cli/terminal.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "reference/relief_rays.hpp"

namespace nacre::cli {

void BumpQueryReader::take(std::string_view line, std::vector<BumpQuery>& queries) {
    ++lineNumber_;
    line = trimmed(line);
    if (line.empty() || line.front() == '#') return;
    const bool first = !sawContent_;
    sawContent_ = true;
    std::array<double, 5> v{};
    const auto fail = [&](const std::string& expected) {
        throw Error(fmt::format("standard input: line {}: expected {}, found '{}'", lineNumber_, expected,
                                line.size() > 80 ? line.substr(0, 80) : line));
    };
    const bool normal = question_ == BumpQuestion::Normal;
    if (!parseNumbers(line, std::span(v).first(normal ? 2 : 5))) {
        if (first && line.front() == 'u') return;  // a header
        fail(normal ? "two numbers u,v" : "five numbers u,v,x,y,z");
    }
    BumpQuery query{{v[0], v[1]}, {0, 0, 1}};
    if (!std::isfinite(v[0]) || !std::isfinite(v[1])) fail("finite u and v");
    if (!normal) {
        query.direction = {v[2], v[3], v[4]};
        const double longest = maxComponent(glm::abs(query.direction));
        if (!isFinite(query.direction) || longest == 0) fail("a finite direction that is not 0");
        query.direction = glm::normalize(query.direction / longest);  // squares neither overflow nor vanish
    }
    queries.push_back(query);
}

namespace {

struct Evaluator {
    BumpMaps maps;
    BumpQuestion question = BumpQuestion::Lit;
    std::optional<Relief> truth;
    unsigned threads = 0;
    bool saidNearest = false;
};

/// The heights as the asset says they were read.
HeightOptions optionsOf(const Asset& asset, const std::string& file, Wrap wrap) {
    try {
        return heightOptionsFrom(asset.meta.at("input"), wrap);
    } catch (const nlohmann::json::exception& error) {
        throw Error(fmt::format("{}: expected 'input' with scale, texel_size, nodata and channel, found {}", file,
                                error.what()));
    }
}

std::optional<Relief> truthOf(const Asset& asset, const BumpMaps& maps, const std::string& file,
                              const std::string& source) {
    if (source.empty()) return maps.heights ? std::optional<Relief>(HeightMap{*maps.heights, maps.wrap}) : std::nullopt;
    const HeightField field = readHeight(source, optionsOf(asset, file, maps.wrap));
    if (field.map.width() != maps.width || field.map.height() != maps.height)
        throw Error(fmt::format("{}: expected {} x {} texels as in {}, found {} x {}", source, maps.width, maps.height,
                                file, field.map.width(), field.map.height()));
    if (asset.meta.value("source_hash", "") != field.report.hash)
        tell(fmt::format("{}: baked from other bytes than {}", file, source));
    return Relief(field.map);
}

/// Beside a texel's centre, where four patches meet in a crease, the truth is another one than at it: a centre that was
/// printed with few digits is still meant as one.
Vec2 texelsOf(const Evaluator& e, const Vec2& uv) {
    constexpr double kMeant = 2e-3;  // texels
    const auto meant = [](double x) {
        const double centre = std::floor(x) + 0.5;
        return std::abs(x - centre) < kMeant ? centre : x;
    };
    return {meant(uv.x * e.maps.width), meant(uv.y * e.maps.height)};
}

std::string litLine(const Evaluator& e, const BumpQuery& q) {
    const int lit = litMargin(e.maps, q.uv.x, q.uv.y, q.direction) >= 0;
    if (!e.truth) return fmt::format("{},nan\n", lit);
    return fmt::format("{},{}\n", lit, static_cast<int>(isLit(*e.truth, texelsOf(e, q.uv), q.direction)));
}

std::string hitText(bool hit, const Vec2& uv) { return hit ? fmt::format("1,{:.9g},{:.9g}", uv.x, uv.y) : "0,nan,nan"; }

std::string seenLine(const Evaluator& e, const BumpQuery& q) {
    const Seen seen = seenFrom(e.maps, q.uv.x, q.uv.y, q.direction);
    std::string text = hitText(seen.hit, seen.uv);
    if (!e.truth) return text + ",nan,nan,nan\n";
    const Vec2 from = texelsOf(e, q.uv);
    const double height = e.truth->heightAt(from);
    const auto hit = std::isnan(height) ? std::nullopt : firstHit(*e.truth, Vec3(from, height), q.direction);
    const Vec2 at = hit ? Vec2(hit->point) / Vec2(e.maps.width, e.maps.height) : Vec2(0);
    return text + "," + hitText(hit.has_value(), at) + "\n";
}

std::string normalLine(const Evaluator& e, const BumpQuery& q) {
    const Vec3 n = normalAt(e.maps, q.uv.x, q.uv.y);
    return fmt::format("{:.9g},{:.9g},{:.9g}\n", n.x, n.y, n.z);
}

void tellNearest(Evaluator& e, const std::vector<BumpQuery>& queries) {
    static constexpr double kSame = 1e-5;  // 1 − cos of a quarter of a degree
    if (e.question != BumpQuestion::Seen || e.saidNearest) return;
    for (const BumpQuery& q : queries) {
        const Vec3& stored = e.maps.scatter->directions[nearestDirection(*e.maps.scatter, q.direction)];
        if (1 - glm::dot(stored, q.direction) <= kSame) continue;
        tell(
            fmt::format("direction {:.4g},{:.4g},{:.4g} is not stored: the nearest stored one answers, here and below "
                        "({:.6g},{:.6g},{:.6g})",
                        q.direction.x, q.direction.y, q.direction.z, stored.x, stored.y, stored.z));
        e.saidNearest = true;
        return;
    }
}

void answer(Evaluator& e, std::vector<BumpQuery>& queries) {
    tellNearest(e, queries);
    std::vector<std::string> lines(queries.size());
    parallelFor(queries.size(), e.threads, [&](std::size_t i) {
        lines[i] = e.question == BumpQuestion::Lit    ? litLine(e, queries[i])
                   : e.question == BumpQuestion::Seen ? seenLine(e, queries[i])
                                                      : normalLine(e, queries[i]);
    });
    for (const std::string& line : lines) putData(line);
    queries.clear();
}

void requireAnswers(const BumpMaps& maps, BumpQuestion question, const std::string& file) {
    if (question == BumpQuestion::Lit && !maps.ellipses && !maps.horizons)
        throw Error(
            fmt::format("{}: expected ellipses or horizons for lines u,v,lx,ly,lz, found neither (--normal and "
                        "--seen ask other questions)",
                        file));
    if (question == BumpQuestion::Seen && !maps.scatter)
        throw Error(fmt::format("{}: expected a scatter map for --seen, found none", file));
    if (question == BumpQuestion::Normal && !maps.normals)
        throw Error(fmt::format("{}: expected normals for --normal, found none", file));
}

}  // namespace

void evalBump(const Asset& asset, const std::string& file, const std::string& source, BumpQuestion question,
              unsigned threads) {
    static constexpr std::size_t kBatch = 1 << 14;  // bounded memory for any input
    Evaluator e{bumpFromAsset(asset, file), question, {}, threads};
    requireAnswers(e.maps, question, file);
    e.truth = truthOf(asset, e.maps, file, source);
    BumpQueryReader reader(question);
    std::vector<BumpQuery> queries;
    forEachInputLine([&](std::string_view line) {
        reader.take(line, queries);
        if (queries.size() == kBatch) answer(e, queries);
    });
    answer(e, queries);
}

}  // namespace nacre::cli
