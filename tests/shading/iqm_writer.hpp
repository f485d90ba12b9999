// Makes small IQM files for tests.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace nacre::tests {

/// Three vertices, one triangle, two joints one above the other along z, a clip "bend" of two frames at 10/s in which
/// the second joint turns by 90 degrees about x. The third vertex, above both joints, follows the second.
class IqmWriter {
public:
    std::array<std::uint8_t, 12> weights = {255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0};
    std::int32_t secondParent = 0;
    std::uint32_t clipFrames = 2;
    float rate = 10;

    std::vector<std::uint8_t> bytes() const {
        std::vector<std::uint8_t> out(124);
        std::memcpy(out.data(), "INTERQUAKEMODEL", 16);
        const auto put = [&](const auto& values) {
            const std::size_t at = out.size();
            const auto* raw = reinterpret_cast<const std::uint8_t*>(values.data());
            out.insert(out.end(), raw, raw + values.size() * sizeof(values[0]));
            return static_cast<std::uint32_t>(at);
        };
        using Words = std::vector<std::uint32_t>;
        using Floats = std::vector<float>;
        const std::uint32_t text = put(std::string("\0bend\0low\0high\0\0\0", 18));
        out.resize(144);
        const std::uint32_t positions = put(Floats{0, 0, 0, 1, 0, 0, 0, 0, 2});
        const std::uint32_t bones = put(std::array<std::uint8_t, 12>{0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
        const std::uint32_t shares = put(weights);
        const std::uint32_t arrays = put(Words{0, 0, 7, 3, positions, 4, 0, 1, 4, bones, 5, 0, 1, 4, shares});
        const std::uint32_t triangles = put(Words{0, 1, 2});
        const Floats low = {0, 0, 0, 0, 0, 0, 1, 1, 1, 1}, high = {0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
        const std::uint32_t joints = put(Words{6, ~0u});
        put(low);
        put(Words{10, static_cast<std::uint32_t>(secondParent)});
        put(high);
        const float half = 0.70710678f;  // sine and cosine of 45 degrees
        const std::uint32_t poses = put(Words{~0u, 0});
        put(low);
        put(Floats(10, 0));
        put(Words{0, 1u << 3 | 1u << 6});
        put(Floats{0, 0, 1, 0, 0, 0, 0, 1, 1, 1});
        put(Floats{0, 0, 0, half / 65535, 0, 0, 1.0f / 65535, 0, 0, 0});
        Words clip = {1, 0, clipFrames, 0, 0};
        std::memcpy(&clip[3], &rate, 4);
        const std::uint32_t clips = put(clip);
        const auto turned = static_cast<std::uint16_t>(half * 65535 + 0.5f);
        const std::uint32_t frames = put(std::array<std::uint16_t, 4>{0, 65535, 65535, turned});
        const std::uint32_t header[] = {2,      static_cast<std::uint32_t>(out.size()),
                                        0,      18,
                                        text,   0,
                                        0,      3,
                                        3,      arrays,
                                        1,      triangles,
                                        0,      2,
                                        joints, 2,
                                        poses,  1,
                                        clips,  2,
                                        2,      frames,
                                        0,      0,
                                        0,      0,
                                        0};
        std::memcpy(out.data() + 16, header, sizeof header);
        return out;
    }
};

}  // namespace nacre::tests
