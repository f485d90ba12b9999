#include "transfer/colored_ply.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace nacre {

std::string coloredPly(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions,
                       std::span<const std::uint8_t> codes, const std::string& comment) {
    require(codes.size() == 3 * positions.size(), "PLY: expected three codes a position");
    std::string out = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment {}\nelement vertex {}\nproperty float x\nproperty float y\n"
        "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face {}\n"
        "property list uchar int vertex_indices\nend_header\n",
        comment, positions.size(), triangles.size());
    const auto put = [&](const void* bytes, std::size_t count) { out.append(static_cast<const char*>(bytes), count); };
    for (std::size_t v = 0; v < positions.size(); ++v) {
        put(&positions[v], sizeof(glm::vec3));
        put(&codes[3 * v], 3);
    }
    for (const glm::uvec3& t : triangles) {
        out += '\3';
        put(&t, sizeof(t));
    }
    return out;
}

}  // namespace nacre
