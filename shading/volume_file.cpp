#include "shading/volume_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/file.hpp"

namespace nacre {
namespace {

constexpr int kLargestEdge = 1024;
constexpr std::size_t kDenHeader = 62, kInrHeader = 256;
constexpr std::string_view kInrMagic = "#INRIMAGE-4#{";

std::size_t countOf(const glm::ivec3& size, const std::string& name) {
    for (int c = 0; c < 3; ++c)
        if (size[c] < 1 || size[c] > kLargestEdge)
            throw Error(fmt::format("{}: expected 1 to {} texels along an edge, found {} x {} x {}", name, kLargestEdge,
                                    size.x, size.y, size.z));
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
}

void checkLength(std::size_t expected, std::size_t found, const std::string& name) {
    if (expected != found) throw Error(fmt::format("{}: expected {} bytes of data, found {}", name, expected, found));
}

std::uint32_t littleEndian(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t width) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < width; ++i) value |= static_cast<std::uint32_t>(bytes[at + i]) << (8 * i);
    return value;
}

/// Sixteen-bit words from byte 0: version 1, nine triples (the last three of the map itself: least, greatest, length),
/// warps; then the length of the data in 32 bits.
bool isDen(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < kDenHeader || littleEndian(bytes, 0, 2) != 1) return false;
    for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t low = littleEndian(bytes, 38 + 2 * c, 2), high = littleEndian(bytes, 44 + 2 * c, 2);
        if (littleEndian(bytes, 50 + 2 * c, 2) != high - low + 1) return false;
    }
    return true;
}

Volume parseDen(std::span<const std::uint8_t> bytes, const std::string& name) {
    Volume out;
    for (int c = 0; c < 3; ++c)
        out.size[c] = static_cast<int>(littleEndian(bytes, 50 + 2 * static_cast<std::size_t>(c), 2));
    const std::size_t count = countOf(out.size, name);
    if (littleEndian(bytes, 58, 4) != count)
        throw Error(fmt::format("{}: expected {} x {} x {} bytes in the header, found {}", name, out.size.x, out.size.y,
                                out.size.z, littleEndian(bytes, 58, 4)));
    checkLength(count, bytes.size() - kDenHeader, name);
    out.values.assign(bytes.begin() + kDenHeader, bytes.end());
    return out;
}

using Fields = std::map<std::string, std::string>;

Fields inrFields(std::span<const std::uint8_t> bytes) {
    Fields out;
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), kInrHeader);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size() - 1);
        const std::string_view line = text.substr(0, end);
        if (const std::size_t equals = line.find('='); equals != std::string_view::npos)
            out[std::string(line.substr(0, equals))] = line.substr(equals + 1);
        text.remove_prefix(end + 1);
    }
    return out;
}

double number(const Fields& fields, const std::string& key, double otherwise, const std::string& name) {
    const auto found = fields.find(key);
    if (found == fields.end()) return otherwise;
    try {
        return std::stod(found->second);  // PIXSIZE says "32 bits"
    } catch (const std::exception&) {
        throw Error(fmt::format("{}: expected a number for {}, found '{}'", name, key, found->second));
    }
}

template <class T>
void read(Volume& out, std::span<const std::uint8_t> data, bool swap) {
    for (std::size_t i = 0; i < out.values.size(); ++i) {
        std::uint8_t raw[sizeof(T)];
        std::memcpy(raw, data.data() + i * sizeof(T), sizeof(T));
        if (swap) std::reverse(raw, raw + sizeof(T));
        T value;
        std::memcpy(&value, raw, sizeof(T));
        out.values[i] = static_cast<float>(value);
    }
}

Volume parseInr(std::span<const std::uint8_t> bytes, const std::string& name) {
    const Fields fields = inrFields(bytes);
    const auto integer = [&](const char* key) {
        const double value = number(fields, key, 0, name);
        return value >= 0 && value <= 1e6 ? static_cast<int>(value) : -1;
    };
    Volume out;
    out.size = {integer("XDIM"), integer("YDIM"), integer("ZDIM")};
    out.spacing = {number(fields, "VX", 1, name), number(fields, "VY", 1, name), number(fields, "VZ", 1, name)};
    if (integer("VDIM") != 1) throw Error(fmt::format("{}: expected VDIM 1, found {}", name, integer("VDIM")));
    out.values.resize(countOf(out.size, name));
    const std::string type = fields.count("TYPE") ? fields.at("TYPE") : "";
    const int bits = integer("PIXSIZE");
    const std::string cpu = fields.count("CPU") ? fields.at("CPU") : "decm";
    const bool little = cpu != "sun" && cpu != "sgi";
    const bool swap = little != (std::endian::native == std::endian::little);
    const std::span<const std::uint8_t> data = bytes.subspan(kInrHeader);
    checkLength(out.values.size() * static_cast<std::size_t>(std::max(bits, 0)) / 8, data.size(), name);
    if (type == "float" && bits == 32)
        read<float>(out, data, swap);
    else if (type == "float" && bits == 64)
        read<double>(out, data, swap);
    else if (type == "unsigned fixed" && bits == 8)
        read<std::uint8_t>(out, data, swap);
    else if (type == "unsigned fixed" && bits == 16)
        read<std::uint16_t>(out, data, swap);
    else if (type == "signed fixed" && bits == 16)
        read<std::int16_t>(out, data, swap);
    else
        throw Error(
            fmt::format("{}: expected float of 32 or 64 bits or fixed of 8 or 16, found '{}' of {}", name, type, bits));
    return out;
}

}  // namespace

Volume parseVolume(std::span<const std::uint8_t> bytes, const std::string& name) {
    const std::string_view start(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), kInrMagic.size()));
    Volume out;
    if (start == kInrMagic && bytes.size() >= kInrHeader)
        out = parseInr(bytes, name);
    else if (isDen(bytes))
        out = parseDen(bytes, name);
    else
        throw Error(name + ": expected a volume (.den or .inr), found another format");
    try {
        checkVolume(out);
    } catch (const std::invalid_argument& e) {
        throw Error(fmt::format("{}: {}", name, e.what()));
    }
    return out;
}

Volume readVolume(const std::filesystem::path& path) {
    constexpr std::uint64_t kLimit = std::uint64_t{1} << 31;
    return parseVolume(readFile(path, kLimit), path.string());
}

}  // namespace nacre
