// Radiance pictures (.hdr, .pic). Source: G. Ward, "Real Pixels", Graphics Gems II, 1991, and the file format chapter
// of the Radiance manual.
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstring>
#include <string_view>

#include "core/asset_exr.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/image_file.hpp"

namespace nacre {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// The bytes that are left, with the file's name for messages.
struct Cursor {
    std::span<const std::uint8_t> rest;
    const std::string& name;

    [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
        throw Error(fmt::format("{}: expected {}, found {}", name, expected, found));
    }
    /// The next line without its end.
    std::string_view line() {
        static constexpr std::size_t kMaxLine = 4096;
        const auto* begin = reinterpret_cast<const char*>(rest.data());
        const void* end = rest.empty() ? nullptr : std::memchr(begin, '\n', std::min(rest.size(), kMaxLine));
        if (!end) fail("a Radiance header of lines", "the end of the file or a line without end");
        const std::string_view text(begin, static_cast<std::size_t>(static_cast<const char*>(end) - begin));
        rest = rest.subspan(text.size() + 1);
        return text;
    }
    void take(std::uint8_t* target, std::size_t count, int row) {
        if (count > rest.size())
            fail("complete pixel data", fmt::format("the end of the file in row {}: it is truncated", row));
        std::memcpy(target, rest.data(), count);
        rest = rest.subspan(count);
    }
};

struct Resolution {
    int width = 0, height = 0;
    bool flipX = false, flipY = false;
};

}  // namespace

static std::string quoted(std::string_view text) {
    std::string out(text.substr(0, 60));
    for (char& c : out)
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = '?';
    return "'" + out + "'";
}

/// "-Y 512 +X 1024": rows from the top, columns from the left; other signs are mirrored.
static Resolution resolutionOf(std::string_view line, const Cursor& in) {
    Resolution out;
    const auto refuse = [&] { in.fail("a resolution such as -Y 512 +X 1024", quoted(line)); };
    const auto number = [&](std::string_view text, int& value) {
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (failure != std::errc{} || end != text.data() + text.size()) refuse();
    };
    std::array<std::string_view, 4> words;
    std::size_t count = 0;
    for (std::string_view left = line; !left.empty();) {
        const std::size_t end = std::min(left.find(' '), left.size());
        if (end > 0 && count == 4) refuse();
        if (end > 0) words[count++] = left.substr(0, end);
        left.remove_prefix(std::min(end + 1, left.size()));
    }
    if (count != 4 || words[0].size() != 2 || words[2].size() != 2 || words[0][1] != 'Y' || words[2][1] != 'X')
        refuse();
    number(words[1], out.height);
    number(words[3], out.width);
    out.flipY = words[0][0] == '+';
    out.flipX = words[2][0] == '-';
    if (out.width < 1 || out.height < 1 || out.width > exr::kMaxEdge || out.height > exr::kMaxEdge)
        in.fail(fmt::format("edges of 1 to {} texels", exr::kMaxEdge), fmt::format("{} x {}", out.width, out.height));
    return out;
}

/// The lines up to the empty one. \return the product of the EXPOSURE lines
static double readHeader(Cursor& in) {
    if (const std::string_view magic = in.line(); magic.substr(0, 2) != "#?")
        in.fail("a Radiance picture that starts with #?", quoted(magic));
    double exposure = 1;
    for (std::string_view line = in.line(); !line.empty() && line != "\r"; line = in.line()) {
        if (line.substr(0, 7) == "FORMAT=" && line.substr(7, 15) != "32-bit_rle_rgbe")
            in.fail("FORMAT=32-bit_rle_rgbe", quoted(line));
        if (line.substr(0, 9) != "EXPOSURE=") continue;
        std::string_view text = line.substr(9);
        while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
        double value = 0;
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
        exposure *= value;
        if (failure != std::errc{} || !(exposure > 0) || !std::isfinite(exposure) || !std::isfinite(1 / exposure))
            in.fail("a number > 0 after EXPOSURE=", quoted(line));
    }
    return exposure;
}

/// Each component for itself: count > 128 repeats a byte count − 128 times, else count bytes follow.
static void readComponents(Cursor& in, std::vector<Rgbe>& row, int y) {
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t x = 0; x < row.size();) {
            std::uint8_t count = 0, value = 0;
            in.take(&count, 1, y);
            const bool run = count > 128;
            const std::size_t length = run ? count - 128u : count;
            if (length == 0 || x + length > row.size())
                in.fail(fmt::format("runs that fill row {}", y), fmt::format("one of {} texels", length));
            if (run) in.take(&value, 1, y);
            for (std::size_t end = x + length; x < end; ++x) {
                if (!run) in.take(&value, 1, y);
                row[x][c] = value;
            }
        }
}

/// Texels as they are; (1, 1, 1, n) repeats the last one n times, and each further such one 256 times as often.
static void readFlat(Cursor& in, std::vector<Rgbe>& row, int y, Rgbe texel) {
    int shift = 0;
    for (std::size_t x = 0;;) {
        if (texel[0] == 1 && texel[1] == 1 && texel[2] == 1 && x > 0) {
            const std::size_t length = shift > 24 ? row.size() + 1 : std::size_t{texel[3]} << shift;
            if (x + length > row.size()) in.fail(fmt::format("runs that fill row {}", y), "a longer one");
            std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(x), length, row[x - 1]);
            x += length;
            shift += 8;
        } else {
            row[x++] = texel;
            shift = 0;
        }
        if (x == row.size()) return;
        in.take(texel.data(), 4, y);
    }
}

static void readRow(Cursor& in, std::vector<Rgbe>& row, int y) {
    Rgbe start{};
    in.take(start.data(), 4, y);
    const std::size_t stated = start[2] * 256u + start[3];
    if (row.size() >= 8 && row.size() < 32768 && start[0] == 2 && start[1] == 2 && start[2] < 128) {
        if (stated != row.size()) in.fail(fmt::format("row {} of {} texels", y, row.size()), fmt::format("{}", stated));
        readComponents(in, row, y);
    } else {
        readFlat(in, row, y, start);
    }
}

ImageFile parseRadianceImage(std::span<const std::uint8_t> bytes, const std::string& name) {
    static constexpr int kExponentBias = 128 + 8;
    Cursor in{bytes, name};
    ImageFile out;
    out.format = "radiance";
    out.sampleType = "rgbe";
    out.exposure = readHeader(in);
    const Resolution size = resolutionOf(in.line(), in);
    const std::size_t values =
        std::size_t{3} * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    if (values > exr::kMaxValues) in.fail(fmt::format("at most {} values", exr::kMaxValues), fmt::format("{}", values));
    if (static_cast<std::size_t>(size.height) > in.rest.size() / 4)  // a row takes four bytes or more
        in.fail("complete pixel data",
                fmt::format("{} bytes for {} rows: it is truncated", in.rest.size(), size.height));
    out.image = Image(size.width, size.height, 3);
    std::vector<Rgbe> row(static_cast<std::size_t>(size.width));
    for (int j = 0; j < size.height; ++j) {
        readRow(in, row, j);
        const int y = size.flipY ? size.height - 1 - j : j;
        for (int i = 0; i < size.width; ++i) {
            const Rgbe& texel = row[static_cast<std::size_t>(i)];
            if (texel[3] == 0) continue;
            const double unit = std::ldexp(1.0, texel[3] - kExponentBias) / out.exposure;
            out.image.setRgb(size.flipX ? size.width - 1 - i : i, y, unit * Rgb(texel[0], texel[1], texel[2]));
        }
    }
    out.hash = contentHash({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    return out;
}

}  // namespace nacre
