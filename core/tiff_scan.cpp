#include "core/tiff_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>

#include "core/error.hpp"

namespace nacre {

namespace {

enum Tag : std::uint64_t {
    kStripOffsets = 273,
    kStripBytes = 279,
    kTileOffsets = 324,
    kTileBytes = 325,
    kNodata = 42113
};
constexpr std::uint64_t kMaxEntries = 4096;

/// Numbers of a file in its byte order; what lies behind the end is absent.
struct Bytes {
    std::span<const std::uint8_t> data;
    bool little = true;

    std::optional<std::uint64_t> number(std::uint64_t at, unsigned size) const {
        if (at > data.size() || data.size() - at < size) return {};
        std::uint64_t value = 0;
        for (unsigned i = 0; i < size; ++i) value |= std::uint64_t{data[at + i]} << (8 * (little ? i : size - 1 - i));
        return value;
    }
};

/// What differs between TIFF 6.0 and BigTIFF.
struct Layout {
    std::uint64_t firstDirectory;              ///< where its offset is
    unsigned countSize, entrySize, valueSize;  ///< bytes of the entry count, of an entry, of an offset
};

std::optional<Layout> layoutOf(Bytes& bytes) {
    if (bytes.data.size() < 8 || bytes.data[0] != bytes.data[1]) return {};
    if (bytes.data[0] != 'I' && bytes.data[0] != 'M') return {};
    bytes.little = bytes.data[0] == 'I';
    const std::uint64_t version = *bytes.number(2, 2);
    if (version == 42) return Layout{4, 2, 12, 4};
    if (version == 43) return Layout{8, 8, 20, 8};
    return {};
}

/// An entry's values: where they are, how many, of which size.
struct Values {
    std::uint64_t at = 0, count = 0;
    unsigned size = 0;
};

std::optional<Values> valuesOf(const Bytes& bytes, const Layout& layout, std::uint64_t tag) {
    static constexpr unsigned kSizes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8, 8};  // of types 0 to 18
    const auto directory = bytes.number(layout.firstDirectory, layout.valueSize);
    const auto entries = directory ? bytes.number(*directory, layout.countSize) : std::nullopt;
    for (std::uint64_t i = 0; i < std::min(entries.value_or(0), kMaxEntries); ++i) {
        const std::uint64_t at = *directory + layout.countSize + i * layout.entrySize;
        if (bytes.number(at, 2) != tag) continue;
        const auto type = bytes.number(at + 2, 2), count = bytes.number(at + 4, layout.valueSize);
        if (!count || *type >= std::size(kSizes) || kSizes[*type] == 0) return {};
        Values out{at + 4 + layout.valueSize, *count, kSizes[*type]};
        if (out.count > layout.valueSize / out.size) {
            const auto elsewhere = bytes.number(out.at, layout.valueSize);
            if (!elsewhere) return {};
            out.at = *elsewhere;
        }
        return out;
    }
    return {};
}

void requireInside(const Bytes& bytes, const Layout& layout, Tag offsetTag, Tag sizeTag, const std::string& name) {
    const auto offsets = valuesOf(bytes, layout, offsetTag), sizes = valuesOf(bytes, layout, sizeTag);
    if (!offsets || !sizes) return;
    for (std::uint64_t i = 0; i < std::min(offsets->count, sizes->count); ++i) {
        const auto offset = bytes.number(offsets->at + i * offsets->size, offsets->size);
        const auto size = bytes.number(sizes->at + i * sizes->size, sizes->size);
        if (offset && size && *offset <= bytes.data.size() && bytes.data.size() - *offset >= *size) continue;
        throw Error(fmt::format("{}: expected a complete TIFF picture, found a file cut within its block {} of {}",
                                name, i, offsets->count));
    }
}

std::optional<std::string> textOf(const Bytes& bytes, const Layout& layout, Tag tag) {
    static constexpr std::uint64_t kMaxText = 64;
    const auto values = valuesOf(bytes, layout, tag);
    if (!values || values->size != 1 || values->count == 0) return {};
    const std::uint64_t length = std::min(values->count, kMaxText);
    if (values->at > bytes.data.size() || bytes.data.size() - values->at < length) return {};
    const auto* text = reinterpret_cast<const char*>(bytes.data.data() + values->at);
    return std::string(text, ::strnlen(text, length));
}

double numberOf(const std::string& text, const std::string& name) {
    std::string_view word = text;
    while (!word.empty() && word.front() == ' ') word.remove_prefix(1);
    while (!word.empty() && word.back() == ' ') word.remove_suffix(1);
    double value = 0;
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (failure == std::errc{} && end == word.data() + word.size()) return value;
    std::string shown(word.substr(0, 20));
    for (char& c : shown)
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = '?';
    throw Error(fmt::format("{}: expected a number in the tag GDAL_NODATA, found '{}'", name, shown));
}

}  // namespace

std::optional<double> scanTiff(std::span<const std::uint8_t> data, const std::string& name) {
    Bytes bytes{data};
    const auto layout = layoutOf(bytes);
    if (!layout) return {};
    requireInside(bytes, *layout, kStripOffsets, kStripBytes, name);
    requireInside(bytes, *layout, kTileOffsets, kTileBytes, name);
    const auto text = textOf(bytes, *layout, kNodata);
    return text ? std::optional(numberOf(*text, name)) : std::nullopt;
}

}  // namespace nacre
