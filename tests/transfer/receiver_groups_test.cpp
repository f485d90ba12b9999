#include "transfer/receiver_groups.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace nacre {
namespace {

/// A row of vertices from x on.
void addRow(std::vector<glm::vec3>& positions, int count, float x) {
    for (int i = 0; i < count; ++i) positions.emplace_back(x + 0.01f * static_cast<float>(i), 0, 0);
}

TEST(ReceiverGroups, EachVertexWithANormalIsInOne) {
    std::vector<glm::vec3> positions;
    addRow(positions, 100, 0);
    std::vector<glm::vec3> normals(100, glm::vec3(0, 0, 1));
    normals[7] = glm::vec3(0);
    std::vector<std::uint32_t> all;
    for (const std::vector<std::uint32_t>& group : groupReceivers(positions, normals, 16)) {
        EXPECT_LE(group.size(), 16u);
        all.insert(all.end(), group.begin(), group.end());
    }
    std::sort(all.begin(), all.end());
    ASSERT_EQ(all.size(), 99u);
    EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
    EXPECT_FALSE(std::binary_search(all.begin(), all.end(), 7u));
}

TEST(ReceiverGroups, APartFarFromTheOthersIsNotTorn) {  // cut in the middle, at 32, one group would span both
    std::vector<glm::vec3> positions;
    addRow(positions, 16, 0);
    addRow(positions, 48, 10);
    const std::vector<std::vector<std::uint32_t>> groups =
        groupReceivers(positions, std::vector<glm::vec3>(64, glm::vec3(0, 0, 1)), 16);
    EXPECT_EQ(groups.size(), 4u);
    for (const std::vector<std::uint32_t>& group : groups) {
        const auto [low, high] = std::minmax_element(group.begin(), group.end());
        EXPECT_EQ(*low < 16, *high < 16);
    }
}

TEST(ReceiverGroups, VerticesInOnePlaceAreParted) {
    const std::vector<glm::vec3> same(40, glm::vec3(1));
    std::size_t count = 0;
    for (const std::vector<std::uint32_t>& group : groupReceivers(same, same, 16)) {
        EXPECT_LE(group.size(), 16u);
        count += group.size();
    }
    EXPECT_EQ(count, 40u);
    EXPECT_TRUE(groupReceivers({}, {}, 16).empty());
}

}  // namespace
}  // namespace nacre
