// KTX2 and DDS byte by byte against their specifications, and that values come back in OpenGL's orientation.
#include <gtest/gtest.h>
#include <half.h>

#include <cstring>

#include "core/texture.hpp"
#include "envmaps/convert.hpp"
#include "envmaps/cube_layouts.hpp"
#include "envmaps/export_dds.hpp"
#include "envmaps/export_ktx2.hpp"

namespace nacre {
namespace {

/// A texel holds its own direction, exactly in half floats nearly.
std::vector<EnvMap> directionChain(int size) {
    std::vector<EnvMap> levels;
    for (; size >= 1; size /= 2) {
        EnvMap map(EnvLayout::Cube, size);
        for (int y = 0; y < 6 * size; ++y)
            for (int x = 0; x < size; ++x) map.image.setRgb(x, y, envTexelDirection(EnvLayout::Cube, size, x, y));
        levels.push_back(std::move(map));
    }
    return levels;
}

template <typename Integer>
Integer at(const std::string& bytes, std::size_t offset) {
    Integer value{};
    if (offset + sizeof value > bytes.size()) throw std::out_of_range("beyond the file");
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

/// The direction that OpenGL 4.6 table 8.19 gives to the face's texel (s, t in [−1, 1], row 0 = t −1).
Vec3 glDirection(int face, double s, double t) {
    switch (face) {
        case 0:
            return {1, -t, -s};
        case 1:
            return {-1, -t, s};
        case 2:
            return {s, 1, t};
        case 3:
            return {s, -1, -t};
        case 4:
            return {s, -t, 1};
        default:
            return {-s, -t, -1};
    }
}

/// Every texel of a face at `offset` holds the direction under which OpenGL finds it.
void expectDirections(const std::string& bytes, std::size_t offset, int face, int size) {
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x, offset += 8) {
            const Vec3 want = glm::normalize(glDirection(face, (2 * x + 1.0) / size - 1, (2 * y + 1.0) / size - 1));
            for (int c = 0; c < 4; ++c) {
                half value;
                value.setBits(at<std::uint16_t>(bytes, offset + 2 * static_cast<std::size_t>(c)));
                ASSERT_NEAR(value, c < 3 ? want[c] : 1, 1e-3) << "face " << face << " texel " << x << ' ' << y;
            }
        }
}

TEST(ExportKtx2, HeaderIndexAndTexelsFollowTheSpecification) {
    const std::string bytes = ktx2Bytes(directionChain(8), {.scale = 1});
    EXPECT_EQ(bytes.substr(0, 12), std::string("\xabKTX 20\xbb\r\n\x1a\n", 12));
    const std::uint32_t header[] = {97, 2, 8, 8, 0, 0, 6, 4, 0};  // format, type size, w, h, d, layers, faces, levels
    for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(at<std::uint32_t>(bytes, 12 + 4 * i), header[i]) << i;
    const auto formatAt = at<std::uint32_t>(bytes, 48), formatSize = at<std::uint32_t>(bytes, 52);
    const auto pairsAt = at<std::uint32_t>(bytes, 56), pairsSize = at<std::uint32_t>(bytes, 60);
    EXPECT_EQ(formatAt, 80u + 4 * 24);
    EXPECT_EQ(formatSize, at<std::uint32_t>(bytes, formatAt));
    EXPECT_EQ(formatSize, 92u);
    EXPECT_EQ(pairsAt, formatAt + formatSize);
    EXPECT_EQ(at<std::uint64_t>(bytes, 64), 0u);
    std::uint64_t end = bytes.size();
    for (std::size_t level = 0; level < 4; ++level) {
        const auto offset = at<std::uint64_t>(bytes, 80 + 24 * level), size = at<std::uint64_t>(bytes, 88 + 24 * level);
        const int edge = 8 >> level;
        EXPECT_EQ(size, 6u * 8 * edge * edge);
        EXPECT_EQ(at<std::uint64_t>(bytes, 96 + 24 * level), size);
        EXPECT_EQ(offset % 8, 0u);
        EXPECT_EQ(offset + size, end) << "the finest level is the last";
        end = offset;
        for (int face = 0; face < 6; ++face)
            expectDirections(bytes, offset + static_cast<std::size_t>(face) * 8 * edge * edge, face, edge);
    }
    EXPECT_GE(end, pairsAt + pairsSize);
}

TEST(ExportKtx2, DataFormatDescribesFourSignedHalves) {
    const std::string bytes = ktx2Bytes(directionChain(1));
    const std::size_t d = at<std::uint32_t>(bytes, 48) + 4;
    EXPECT_EQ(at<std::uint32_t>(bytes, d), 0u);
    EXPECT_EQ(at<std::uint16_t>(bytes, d + 4), 2u);
    EXPECT_EQ(at<std::uint16_t>(bytes, d + 6), 88u);
    EXPECT_EQ(at<std::uint32_t>(bytes, d + 8), 0x00010101u);  // RGBSDA, BT709, linear, no flags
    EXPECT_EQ(at<std::uint32_t>(bytes, d + 12), 0u);
    EXPECT_EQ(at<std::uint64_t>(bytes, d + 16), 8u);
    const std::uint32_t channels[] = {0xc00f0000, 0xc10f0010, 0xc20f0020, 0xcf0f0030};
    for (std::size_t c = 0; c < 4; ++c) {
        EXPECT_EQ(at<std::uint32_t>(bytes, d + 24 + 16 * c), channels[c]);
        EXPECT_EQ(at<float>(bytes, d + 32 + 16 * c), -1.0f);
        EXPECT_EQ(at<float>(bytes, d + 36 + 16 * c), 1.0f);
    }
}

TEST(ExportKtx2, MetadataIsSortedPaddedAndStatesTheScale) {
    EnvMap sun(EnvLayout::Cube, 1);
    sun.image.setRgb(0, 0, Rgb(1e6));
    const std::string bytes = ktx2Bytes(std::span(&sun, 1), {.scale = 16});
    std::size_t p = at<std::uint32_t>(bytes, 56);
    const std::size_t end = p + at<std::uint32_t>(bytes, 60);
    std::vector<std::string> keys;
    while (p < end) {
        const auto size = at<std::uint32_t>(bytes, p);
        const std::string pair = bytes.substr(p + 4, size);
        keys.push_back(pair.c_str());
        if (keys.back() == "nacre") {
            EXPECT_NE(pair.find("\"scale\": 16"), std::string::npos);
        }
        p = (p + 4 + size + 3) / 4 * 4;
    }
    EXPECT_EQ(p, end);
    EXPECT_EQ(keys, (std::vector<std::string>{"KTXorientation", "KTXwriter", "nacre"}));
    half value;
    value.setBits(at<std::uint16_t>(bytes, at<std::uint64_t>(bytes, 80)));
    EXPECT_NEAR(value, 62500, 16);  // half an ulp
}

TEST(ExportDds, HeaderAndTexelsFollowTheProgrammingGuide) {
    const std::string bytes = ddsBytes(directionChain(4), {.scale = 2});
    EXPECT_EQ(bytes.substr(0, 4), "DDS ");
    const std::pair<std::size_t, std::uint32_t> fields[] = {
        {4, 124},         {8, 0x2100f},    {12, 4},       {16, 4},   {20, 32}, {28, 3},  {76, 32}, {80, 4},
        {84, 0x30315844}, {108, 0x401008}, {112, 0xfe00}, {128, 10}, {132, 3}, {136, 4}, {140, 1}, {144, 0}};
    for (const auto& [offset, value] : fields) EXPECT_EQ(at<std::uint32_t>(bytes, offset), value) << offset;
    EXPECT_EQ(at<float>(bytes, 32), 2.0f);
    EXPECT_EQ(bytes.substr(36, 4), "NCRE");
    std::size_t offset = 148;
    const std::string unscaled = ddsBytes(directionChain(4));
    for (int face = 0; face < 6; ++face)
        for (int edge = 4; edge >= 1; edge /= 2) {
            expectDirections(unscaled, offset, face, edge);
            offset += 8u * edge * edge;
        }
    EXPECT_EQ(offset, bytes.size());
}

TEST(Export, ValuesAboveHalfAreAnErrorNeverAnInfinity) {
    for (const float bad : {65536.0f, 1e30f, -7e4f, INFINITY, NAN}) {
        EnvMap map(EnvLayout::Cube, 2);
        map.image.at(1, 7, 2) = bad;
        EXPECT_THROW(ktx2Bytes(std::span(&map, 1)), StorageError) << bad;
        EXPECT_THROW(ddsBytes(std::span(&map, 1)), StorageError) << bad;
    }
    EnvMap map(EnvLayout::Cube, 2);
    map.image.at(0, 0, 0) = 65504;
    EXPECT_NO_THROW(ktx2Bytes(std::span(&map, 1)));
}

TEST(Export, RejectsWhatIsNoChainOfCubes) {
    const std::vector<EnvMap> none, latlong{EnvMap(EnvLayout::LatLong, 4)},
        gap{EnvMap(EnvLayout::Cube, 4), EnvMap(EnvLayout::Cube, 1)};
    for (const std::vector<EnvMap>& levels : {none, latlong, gap}) {
        EXPECT_THROW(ktx2Bytes(levels), std::invalid_argument);
        EXPECT_THROW(ddsBytes(levels), std::invalid_argument);
    }
    const std::vector<EnvMap> odd{EnvMap(EnvLayout::Cube, 5), EnvMap(EnvLayout::Cube, 2), EnvMap(EnvLayout::Cube, 1)};
    EXPECT_NO_THROW(ktx2Bytes(odd));
    EXPECT_THROW(ktx2Bytes(odd, {.scale = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
