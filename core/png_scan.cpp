#include "core/png_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "core/error.hpp"

namespace nacre {

void scanPng(std::span<const std::uint8_t> bytes, const std::string& name) {
    static constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    if (bytes.size() < kMagic.size() || !std::equal(kMagic.begin(), kMagic.end(), bytes.begin())) return;
    std::size_t at = kMagic.size();
    while (bytes.size() - at >= 12) {  // length, type, data, checksum
        const std::size_t length = static_cast<std::size_t>(bytes[at]) << 24 |
                                   static_cast<std::size_t>(bytes[at + 1]) << 16 |
                                   static_cast<std::size_t>(bytes[at + 2]) << 8 | bytes[at + 3];
        const std::string_view type(reinterpret_cast<const char*>(bytes.data()) + at + 4, 4);
        if (length > bytes.size() - at - 12) break;
        if (type == "IEND") return;
        at += 12 + length;
    }
    throw Error(fmt::format("{}: expected a complete PNG picture, found one that is cut: no IEND within {} bytes", name,
                            bytes.size()));
}

}  // namespace nacre
