#include "envmaps/export_dds.hpp"

#include <array>
#include <bit>

namespace nacre {

using exporting::appendNumber;

std::string ddsBytes(std::span<const EnvMap> levels, const CubeExport& options) {
    static constexpr std::uint32_t kFlags =
        0x1 | 0x2 | 0x4 | 0x8 | 0x1000 | 0x20000;  // caps, sizes, pitch, format, mips
    static constexpr std::uint32_t kFourCc = 0x4, kDx10 = 0x30315844, kMark = 0x4552434e;  // "DX10", "NCRE"
    static constexpr std::uint32_t kCaps = 0x8 | 0x1000 | 0x400000;                        // complex, texture, mipmap
    static constexpr std::uint32_t kCubeAllFaces = 0xfe00;
    static constexpr std::uint32_t kRgba16Float = 10, kTexture2d = 3, kTextureCube = 4;
    exporting::requireChain(levels, options.scale);
    const auto size = static_cast<std::uint32_t>(levels.front().size());
    std::string out = "DDS ";
    for (const std::uint32_t number :
         {124u, kFlags, size, size, size * 8, 0u, static_cast<std::uint32_t>(levels.size())})
        appendNumber(out, number);
    std::array<std::uint32_t, 11> reserved{std::bit_cast<std::uint32_t>(static_cast<float>(options.scale)), kMark};
    for (const std::uint32_t number : reserved) appendNumber(out, number);
    for (const std::uint32_t number : {32u, kFourCc, kDx10, 0u, 0u, 0u, 0u, 0u}) appendNumber(out, number);
    for (const std::uint32_t number : {kCaps, kCubeAllFaces, 0u, 0u, 0u}) appendNumber(out, number);
    for (const std::uint32_t number : {kRgba16Float, kTexture2d, kTextureCube, 1u, 0u}) appendNumber(out, number);
    for (int face = 0; face < 6; ++face)
        for (const EnvMap& level : levels) exporting::appendFace(level, face, options.scale, out);
    return out;
}

}  // namespace nacre
