#include "shading/md2_frames.hpp"

#include <fmt/format.h>

#include <cctype>

#include "core/error.hpp"

namespace nacre {
namespace {

constexpr std::size_t kHeader = 68, kFrameSizeAt = 16, kFrameCountAt = 40, kFramesAt = 56;  // [bytes]
constexpr std::size_t kNameAt = 24, kNameLength = 16;                                       // in a frame

std::size_t word(std::span<const std::uint8_t> bytes, std::size_t at) {
    std::size_t out = 0;
    for (std::size_t i = 0; i < 4; ++i) out |= static_cast<std::size_t>(bytes[at + i]) << (8 * i);
    return out;
}

std::string clipName(std::span<const std::uint8_t> text) {
    std::string out;
    for (std::size_t i = 0; i < text.size() && text[i] != 0; ++i) out += static_cast<char>(text[i]);
    for (int i = 0; i < 2 && !out.empty() && std::isdigit(static_cast<unsigned char>(out.back())); ++i) out.pop_back();
    while (!out.empty() && out.back() == '0') out.pop_back();  // of three digits: run001
    return out;
}

}  // namespace

bool isMd2(std::span<const std::uint8_t> bytes) {
    return bytes.size() >= 4 && bytes[0] == 'I' && bytes[1] == 'D' && bytes[2] == 'P' && bytes[3] == '2';
}

std::vector<Md2Clip> md2Clips(std::span<const std::uint8_t> bytes, const std::string& name) {
    if (!isMd2(bytes) || bytes.size() < kHeader)
        throw Error(fmt::format("{}: expected an MD2 file, found {} bytes of another", name, bytes.size()));
    const std::size_t size = word(bytes, kFrameSizeAt), count = word(bytes, kFrameCountAt), at = word(bytes, kFramesAt);
    // All three have 32 bits: the product doesn't overflow.
    if (count == 0 || size < kNameAt + kNameLength || at > bytes.size() || count * size > bytes.size() - at)
        throw Error(fmt::format("{}: expected frames within {} bytes, found {} of {} bytes from byte {}", name,
                                bytes.size(), count, size, at));
    std::vector<Md2Clip> out;
    for (std::size_t f = 0; f < count; ++f) {
        const std::string clip = clipName(bytes.subspan(at + f * size + kNameAt, kNameLength));
        if (out.empty() || out.back().name != clip) out.push_back({clip, f, 0});
        ++out.back().count;
    }
    return out;
}

}  // namespace nacre
