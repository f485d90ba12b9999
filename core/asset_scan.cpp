// A look at an EXR file's headers before OpenEXR reads them: it makes room for an attribute as large as the file says
// (a string of 2 GB in a file of 3 KB) before it finds that the bytes aren't there.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "core/asset_exr.hpp"

namespace nacre::exr {

/// Reads a name of at most 255 characters and its zero; false when there is none.
static bool takeName(std::span<const std::uint8_t>& rest, std::string& name) {
    const auto* zero =
        rest.empty()
            ? nullptr
            : static_cast<const std::uint8_t*>(std::memchr(rest.data(), 0, std::min<std::size_t>(rest.size(), 256)));
    if (!zero) return false;
    name.assign(reinterpret_cast<const char*>(rest.data()), static_cast<std::size_t>(zero - rest.data()));
    rest = rest.subspan(name.size() + 1);
    return true;
}

/// For messages: what is no letter, digit or ASCII sign becomes '?'.
static std::string printable(std::string name) {
    for (char& c : name)
        if (c < 0x20 || c > 0x7e) c = '?';
    return name.size() <= 40 ? name : name.substr(0, 37) + "...";
}

std::optional<std::string> brokenStart(std::span<const std::uint8_t> bytes) {
    static constexpr std::size_t kStart = 8;  // magic number, then version and flags; flag 0x1000: several headers
    static constexpr std::array<std::uint8_t, 4> kMagic = {0x76, 0x2f, 0x31, 0x01};
    if (bytes.size() < kStart) return fmt::format("a file of {} bytes", bytes.size());
    if (!std::equal(kMagic.begin(), kMagic.end(), bytes.begin()))
        return fmt::format("a file that starts with bytes {:02x}, not {:02x}",
                           fmt::join(bytes.first(kMagic.size()), " "), fmt::join(kMagic, " "));
    const bool multiPart = bytes[5] & 0x10;
    std::span<const std::uint8_t> rest = bytes.subspan(kStart);
    std::string name, type;
    for (bool lastWasEnd = false; takeName(rest, name);) {
        if (name.empty()) {  // the end of a header; of all headers when there is one, or when it comes twice
            if (!multiPart || lastWasEnd) return {};
            lastWasEnd = true;
            continue;
        }
        lastWasEnd = false;
        std::uint32_t size = 0;
        if (!takeName(rest, type) || rest.size() < sizeof size) break;
        std::memcpy(&size, rest.data(), sizeof size);
        rest = rest.subspan(sizeof size);
        if (size > rest.size())
            return fmt::format("attribute '{}' of {} bytes with {} left in the file: it is cut short or corrupt",
                               printable(name), size, rest.size());
        rest = rest.subspan(size);
    }
    return fmt::format("headers without an end in {} bytes: it is cut short or corrupt", bytes.size());
}

}  // namespace nacre::exr
