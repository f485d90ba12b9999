// Float images, row 0 on top, channels interleaved; and the texel lookup that matches the GPU's bilinear filter.
#pragma once

#include <cstddef>
#include <vector>

#include "core/math.hpp"

namespace nacre {

/// width × height texels of `channels` floats. Texel (x, y) has its centre at ((x + 0.5)/width, (y + 0.5)/height).
class Image {
public:
    Image() = default;
    /// All zero. \throws std::invalid_argument unless sizes are ≥ 1 and channels in 1..4
    Image(int width, int height, int channels);

    int width() const { return width_; }
    int height() const { return height_; }
    int channels() const { return channels_; }
    bool empty() const { return data_.empty(); }
    std::size_t texelCount() const { return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_); }

    float& at(int x, int y, int c) { return data_[index(x, y, c)]; }
    float at(int x, int y, int c) const { return data_[index(x, y, c)]; }
    /// First three channels (one-channel images repeat theirs).
    Rgb rgb(int x, int y) const;
    void setRgb(int x, int y, const Rgb& value);

    std::vector<float>& data() { return data_; }
    const std::vector<float>& data() const { return data_; }

private:
    std::size_t index(int x, int y, int c) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)) *
                   static_cast<std::size_t>(channels_) +
               static_cast<std::size_t>(c);
    }
    int width_ = 0, height_ = 0, channels_ = 0;
    std::vector<float> data_;
};

/// What GL_LINEAR with GL_CLAMP_TO_EDGE returns at (u, v) in [0,1]²: 4 channels, those the image lacks are 0,0,0,1.
/// Weights in single precision, as the shader's.
glm::vec4 sampleBilinear(const Image& image, float u, float v);

}  // namespace nacre
