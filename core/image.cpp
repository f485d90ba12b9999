#include "core/image.hpp"

#include "core/error.hpp"

namespace nacre {

Image::Image(int width, int height, int channels) : width_(width), height_(height), channels_(channels) {
    require(width >= 1 && height >= 1, "Image: width and height must be >= 1");
    require(channels >= 1 && channels <= 4, "Image: channels must be 1 to 4");
    data_.resize(texelCount() * static_cast<std::size_t>(channels));
}

Rgb Image::rgb(int x, int y) const {
    if (channels_ < 3) return Rgb(at(x, y, 0));
    return {at(x, y, 0), at(x, y, 1), at(x, y, 2)};
}

void Image::setRgb(int x, int y, const Rgb& value) {
    for (int c = 0; c < std::min(3, channels_); ++c) at(x, y, c) = static_cast<float>(value[c]);
}

glm::vec4 sampleBilinear(const Image& image, float u, float v) {
    const auto place = [](float coordinate, int size, int& i0, int& i1) {
        const float t = std::clamp(coordinate * static_cast<float>(size) - 0.5f, 0.0f, static_cast<float>(size - 1));
        i0 = static_cast<int>(t);
        i1 = std::min(i0 + 1, size - 1);
        return t - static_cast<float>(i0);
    };
    int x0 = 0, x1 = 0, y0 = 0, y1 = 0;
    const float a = place(u, image.width(), x0, x1), b = place(v, image.height(), y0, y1);
    glm::vec4 out(0, 0, 0, 1);
    for (int c = 0; c < image.channels(); ++c) {
        const float top = image.at(x0, y0, c) + a * (image.at(x1, y0, c) - image.at(x0, y0, c));
        const float bottom = image.at(x0, y1, c) + a * (image.at(x1, y1, c) - image.at(x0, y1, c));
        out[c] = top + b * (bottom - top);
    }
    return out;
}

}  // namespace nacre
