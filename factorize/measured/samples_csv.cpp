#include <fmt/format.h>

#include <array>
#include <charconv>
#include <optional>

#include "core/error.hpp"
#include "factorize/measured/samples.hpp"

namespace nacre {

static constexpr double kHorizon = 1e-6;  // a cosine below it is the horizon, to the precision of printed angles
static constexpr double kUnitLength = 0.01;

namespace {
enum class Columns { Vectors, Radians, Degrees };
struct Header {
    Columns columns;
    std::string_view text;
};
struct Line {
    const std::string& file;
    std::size_t number;
    std::string_view text;

    [[noreturn]] void complain(const std::string& expected, const std::string& found) const {
        throw Error(fmt::format("{}: line {}: expected {}, found {}", file, number, expected, found));
    }
};
}  // namespace

static constexpr std::array kHeaders = {
    Header{Columns::Vectors, "wix,wiy,wiz,wox,woy,woz,r,g,b"},
    Header{Columns::Radians, "theta_i,phi_i,theta_o,phi_o,r,g,b"},
    Header{Columns::Degrees, "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,r,g,b"},
};

static std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) text.remove_suffix(1);
    return text;
}

/// A piece of a file fit for a one-line message.
static std::string quoted(std::string_view text) {
    std::string out(text.substr(0, 60));
    for (char& c : out)
        if (c < 0x20 || c > 0x7e) c = '?';
    return "'" + out + (text.size() > 60 ? "…'" : "'");
}

static Columns parseHeader(const Line& line) {
    std::string squeezed;
    for (const char c : line.text)
        if (c != ' ' && c != '\t') squeezed += c;
    for (const Header& header : kHeaders)
        if (squeezed == header.text) return header.columns;
    line.complain(fmt::format("a header {} or {} or {}", kHeaders[0].text, kHeaders[1].text, kHeaders[2].text),
                  quoted(line.text));
}

static std::vector<double> parseNumbers(const Line& line, std::size_t count) {
    std::vector<double> out;
    std::string_view rest = line.text;
    for (bool more = true; more;) {
        const std::size_t comma = rest.find(',');
        more = comma != std::string_view::npos;
        std::string_view field = trimmed(rest.substr(0, comma));
        if (more) rest.remove_prefix(comma + 1);
        if (field.starts_with('+')) field.remove_prefix(1);
        double value = 0;
        const auto result = std::from_chars(field.data(), field.data() + field.size(), value);
        // Out of range (1e999) is a number all the same: an infinite one.
        if (result.ec == std::errc::result_out_of_range)
            value = std::numeric_limits<double>::infinity();
        else if (result.ec != std::errc())
            line.complain("a number", quoted(field));
        if (result.ptr != field.data() + field.size()) line.complain("a number", quoted(field));
        out.push_back(value);
    }
    if (out.size() != count) line.complain(fmt::format("{} numbers", count), fmt::format("{}", out.size()));
    return out;
}

static Vec3 checkedDirection(const Line& line, const Vec3& v) {
    const double length = glm::length(v);
    if (!(std::abs(length - 1) <= kUnitLength))
        line.complain("unit directions", fmt::format("one of length {:g}", length));
    if (v.z < -kHorizon) line.complain("directions above the horizon", fmt::format("z = {:g}", v.z / length));
    return v / length;
}

static DirectionPair directionsOf(const Line& line, Columns columns, const std::vector<double>& n) {
    if (columns == Columns::Vectors)
        return {checkedDirection(line, Vec3(n[0], n[1], n[2])), checkedDirection(line, Vec3(n[3], n[4], n[5]))};
    const double unit = columns == Columns::Degrees ? kPi / 180 : 1;
    for (const int theta : {0, 2})
        if (!(n[theta] >= 0)) line.complain("elevations >= 0", fmt::format("{:g}", n[theta]));
    return {checkedDirection(line, sphericalDirection(n[0] * unit, n[1] * unit)),
            checkedDirection(line, sphericalDirection(n[2] * unit, n[3] * unit))};
}

constexpr double kLargest = 1e18;  // its square is still a single-precision number; no BRDF comes near

static void addSample(const Line& line, Columns columns, ParsedSamples& out) {
    const std::vector<double> numbers = parseNumbers(line, columns == Columns::Vectors ? 9 : 7);
    const DirectionPair pair = directionsOf(line, columns, numbers);
    const Rgb f(numbers[numbers.size() - 3], numbers[numbers.size() - 2], numbers[numbers.size() - 1]);
    ++out.data.entries;
    if (!isFinite(f) || maxComponent(f) > kLargest)
        ++out.data.nonFinite;
    else if (std::min({f.r, f.g, f.b}) < 0)
        ++out.data.negative;
    else if (std::min(pair.wi.z, pair.wo.z) <= kHorizon)
        ++out.data.missing;
    else
        out.samples.push_back({pair, f});
}

ParsedSamples parseSamples(std::string_view text, const std::string& name) {
    ParsedSamples out;
    std::optional<Columns> columns;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const Line line{name, number, trimmed(text.substr(0, end))};
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.text.empty() || line.text.front() == '#') continue;
        if (columns)
            addSample(line, *columns, out);
        else
            columns = parseHeader(line);
    }
    if (!columns) throw Error(fmt::format("{}: expected a header line {}, found none", name, kHeaders[0].text));
    if (out.samples.empty())
        throw Error(
            fmt::format("{}: expected samples, found none usable in {} lines ({} negative, {} not finite, {} at "
                        "the horizon)",
                        name, out.data.entries, out.data.negative, out.data.nonFinite, out.data.missing));
    return out;
}

}  // namespace nacre
