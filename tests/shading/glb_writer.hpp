// Makes glTF containers for tests.
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace nacre::tests {

class GlbWriter {
public:
    nlohmann::json document = {{"asset", {{"version", "2.0"}}}};

    /// \param type  "SCALAR", "VEC3", "VEC4"  \return the accessor's index
    template <typename T>
    std::size_t add(const std::vector<T>& values, const char* type, int components) {
        const std::size_t begin = buffer_.size();
        buffer_.resize(begin + (values.size() * sizeof(T) + 3) / 4 * 4);
        std::memcpy(buffer_.data() + begin, values.data(), values.size() * sizeof(T));
        auto& views = document["bufferViews"];
        views.push_back({{"buffer", 0}, {"byteOffset", begin}, {"byteLength", values.size() * sizeof(T)}});
        auto& accessors = document["accessors"];
        accessors.push_back({{"bufferView", views.size() - 1},
                             {"componentType", std::is_same_v<T, float> ? 5126 : 5125},
                             {"count", values.size() / static_cast<std::size_t>(components)},
                             {"type", type}});
        return accessors.size() - 1;
    }

    std::string bytes() {
        if (!buffer_.empty()) document["buffers"] = {{{"byteLength", buffer_.size()}}};
        std::string text = document.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        const std::size_t bin = buffer_.empty() ? 0 : 8 + buffer_.size();
        std::string out = "glTF" + word(2) + word(20 + text.size() + bin) + word(text.size()) + "JSON" + text;
        if (bin) out += word(buffer_.size()) + std::string("BIN\0", 4) + buffer_;
        return out;
    }

private:
    static std::string word(std::size_t value) {
        std::string out;
        for (int i = 0; i < 4; ++i) out += static_cast<char>(value >> (8 * i));
        return out;
    }
    std::string buffer_;
};

/// With one triangle in mesh 0.
inline GlbWriter triangleGlb() {
    GlbWriter out;
    const std::size_t positions = out.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
    out.document["meshes"] = {{{"name", "leaf"}, {"primitives", {{{"attributes", {{"POSITION", positions}}}}}}}};
    return out;
}

}  // namespace nacre::tests
