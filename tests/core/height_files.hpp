// Small height files, byte by byte.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace nacre::tests {

inline void put(std::string& out, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>(value >> (8 * i)));
}

/// 24 bits a texel, grey; first row first in `codes`.
inline std::string greyBmp(int width, int height, const std::vector<int>& codes) {
    const int row = (3 * width + 3) / 4 * 4;
    std::string out = "BM";
    put(out, static_cast<std::uint64_t>(54 + row * height), 4);
    put(out, 0, 4);
    put(out, 54, 4);
    put(out, 40, 4);
    put(out, static_cast<std::uint64_t>(width), 4);
    put(out, static_cast<std::uint64_t>(height), 4);
    put(out, 1, 2);
    put(out, 24, 2);
    for (int i = 0; i < 6; ++i) put(out, 0, 4);
    for (int y = height - 1; y >= 0; --y) {  // bottom up
        for (int x = 0; x < width; ++x)
            out.append(3, static_cast<char>(codes[static_cast<std::size_t>(y * width + x)]));
        out.append(static_cast<std::size_t>(row - 3 * width), '\0');
    }
    return out;
}

/// Little-endian TIFF of one strip of 16-bit codes, with GDAL's nodata tag unless `nodata` is empty.
inline std::string tiff16(int width, int height, const std::vector<int>& codes, bool isSigned,
                          const std::string& nodata) {
    const int entries = nodata.empty() ? 11 : 12;
    const std::uint64_t textAt = 8 + 2 + 12u * static_cast<unsigned>(entries) + 4, textSize = nodata.size() + 1,
                        pixelsAt = textAt + textSize + textSize % 2;
    std::string out = "II";
    put(out, 42, 2);
    put(out, 8, 4);
    put(out, static_cast<std::uint64_t>(entries), 2);
    const auto entry = [&](int tag, int type, std::uint64_t count, std::uint64_t value) {
        put(out, static_cast<std::uint64_t>(tag), 2);
        put(out, static_cast<std::uint64_t>(type), 2);
        put(out, count, 4);
        put(out, value, 4);
    };
    entry(256, 4, 1, static_cast<std::uint64_t>(width));
    entry(257, 4, 1, static_cast<std::uint64_t>(height));
    entry(258, 3, 1, 16);
    entry(259, 3, 1, 1);
    entry(262, 3, 1, 1);
    entry(273, 4, 1, pixelsAt);
    entry(274, 3, 1, 1);
    entry(277, 3, 1, 1);
    entry(278, 4, 1, static_cast<std::uint64_t>(height));
    entry(279, 4, 1, 2 * codes.size());
    entry(339, 3, 1, isSigned ? 2 : 1);
    if (!nodata.empty()) {
        std::uint64_t value = textAt;
        if (textSize <= 4) {
            value = 0;
            for (std::size_t i = 0; i < nodata.size(); ++i)
                value |= std::uint64_t{static_cast<std::uint8_t>(nodata[i])} << (8 * i);
        }
        entry(42113, 2, textSize, value);
    }
    put(out, 0, 4);
    out += nodata;
    out.append(static_cast<std::size_t>(pixelsAt - textAt - nodata.size()), '\0');
    for (const int code : codes) put(out, static_cast<std::uint64_t>(code) & 0xffff, 2);
    return out;
}

}  // namespace nacre::tests
