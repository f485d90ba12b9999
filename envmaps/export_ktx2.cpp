#include "envmaps/export_ktx2.hpp"

#include <fmt/format.h>

#include <bit>
#include <vector>

#include "core/version.hpp"

namespace nacre {

using exporting::appendNumber;

static constexpr std::size_t kTexelBytes = 8;

/// Data format descriptor (Khronos Data Format 1.3, section 5): four signed floats of 16 bits, linear, Rec. 709.
static std::string dataFormat() {
    static constexpr std::uint8_t kRgbsda = 1, kBt709 = 1, kLinear = 1, kSignedFloat = 0xc0, kAlpha = 15;
    static constexpr std::uint32_t kSamples = 4, kBlock = 24 + 16 * kSamples;
    std::string out;
    appendNumber<std::uint32_t>(out, kBlock + 4);
    appendNumber<std::uint32_t>(out, 0);  // vendor Khronos, type basic
    appendNumber<std::uint16_t>(out, 2);  // version
    appendNumber<std::uint16_t>(out, kBlock);
    for (const std::uint8_t byte : {kRgbsda, kBt709, kLinear, std::uint8_t{0}}) appendNumber(out, byte);
    appendNumber<std::uint32_t>(out, 0);            // one texel a block
    appendNumber<std::uint64_t>(out, kTexelBytes);  // in plane 0 alone
    for (std::uint8_t channel = 0; channel < kSamples; ++channel) {
        appendNumber(out, static_cast<std::uint16_t>(16 * channel));
        appendNumber<std::uint8_t>(out, 15);  // bits − 1
        appendNumber(out, static_cast<std::uint8_t>(kSignedFloat | (channel == 3 ? kAlpha : channel)));
        appendNumber<std::uint32_t>(out, 0);
        appendNumber(out, std::bit_cast<std::uint32_t>(-1.0f));
        appendNumber(out, std::bit_cast<std::uint32_t>(1.0f));
    }
    return out;
}

/// Pairs in the order of their keys, each padded to 4 bytes.
static std::string keyValues(double scale) {
    std::string out;
    const auto add = [&](const std::string& key, const std::string& value) {
        const std::string pair = key + '\0' + value + '\0';
        appendNumber(out, static_cast<std::uint32_t>(pair.size()));
        out += pair;
        out.resize((out.size() + 3) / 4 * 4, '\0');
    };
    add("KTXorientation", "rd");
    add("KTXwriter", "nacre " + nacreVersion());
    add("nacre", fmt::format("{{\"scale\": {:.17g}}}", scale));
    return out;
}

std::string ktx2Bytes(std::span<const EnvMap> levels, const CubeExport& options) {
    static constexpr std::uint32_t kRgba16Float = 97;  // VK_FORMAT_R16G16B16A16_SFLOAT
    exporting::requireChain(levels, options.scale);
    const std::string format = dataFormat(), pairs = keyValues(options.scale);
    const std::size_t formatAt = 80 + 24 * levels.size(), pairsAt = formatAt + format.size();
    std::size_t next = (pairsAt + pairs.size() + kTexelBytes - 1) / kTexelBytes * kTexelBytes;

    std::string out("\xabKTX 20\xbb\r\n\x1a\n", 12);
    const auto size = static_cast<std::uint32_t>(levels.front().size());
    for (const std::uint32_t number :
         {kRgba16Float, 2u, size, size, 0u, 0u, 6u, static_cast<std::uint32_t>(levels.size()), 0u})
        appendNumber(out, number);
    for (const std::size_t number : {formatAt, format.size(), pairsAt, pairs.size()})
        appendNumber(out, static_cast<std::uint32_t>(number));
    for (int i = 0; i < 2; ++i) appendNumber<std::uint64_t>(out, 0);  // no supercompression

    // The index goes from the finest level, the texels from the coarsest.
    std::vector<std::uint64_t> begin(levels.size());
    std::string texels;
    for (std::size_t i = levels.size(); i-- > 0;) {
        begin[i] = next + texels.size();
        for (int face = 0; face < 6; ++face) exporting::appendFace(levels[i], face, options.scale, texels);
    }
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const std::uint64_t bytes = 6 * kTexelBytes * static_cast<std::uint64_t>(levels[i].size()) * levels[i].size();
        for (const std::uint64_t number : {begin[i], bytes, bytes}) appendNumber(out, number);
    }
    out += format + pairs;
    out.resize(next, '\0');
    return out + texels;
}

}  // namespace nacre
