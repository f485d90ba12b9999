#include "transfer/colored_ply.hpp"

#include <gmock/gmock.h>

#include <cstring>

namespace nacre {
namespace {

TEST(ColoredPly, HeaderAndBytesAgree) {
    const std::vector<glm::vec3> positions = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}};
    const std::vector<std::uint8_t> codes = {10, 20, 30, 40, 50, 60, 70, 80, 90};
    const std::string bytes = coloredPly(triangles, positions, codes, "made");
    const std::size_t body = bytes.find("end_header\n") + 11;
    EXPECT_THAT(bytes.substr(0, body),
                ::testing::AllOf(::testing::StartsWith("ply\n"), ::testing::HasSubstr("comment made\n"),
                                 ::testing::HasSubstr("element vertex 3\n"), ::testing::HasSubstr("element face 1\n")));
    ASSERT_EQ(bytes.size(), body + 3 * 15 + 13);
    float y = 0;
    std::memcpy(&y, &bytes[body + 15 + 4], 4);
    EXPECT_EQ(y, 5.0f);
    EXPECT_EQ(bytes[body + 15 + 12], 40);
    EXPECT_EQ(bytes[body + 45], 3);
    EXPECT_THROW(coloredPly(triangles, positions, {codes.data(), 8}, ""), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
