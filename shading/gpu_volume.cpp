#include "shading/gpu_volume.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <half.h>

#include <cstdint>

#include "shading/context.hpp"

namespace nacre {
namespace {

/// 1 for a field of zeros.
double orOne(double largest) { return largest > 0 ? largest : 1; }

double largestMagnitude(const std::vector<float>& values) {
    double largest = 0;
    for (const float v : values) largest = std::max(largest, std::abs(static_cast<double>(v)));
    return orOne(largest);
}

double largestComponent(const std::vector<glm::vec3>& vectors) {
    double largest = 0;
    for (const glm::vec3& v : vectors) largest = std::max(largest, maxComponent(glm::abs(Vec3(v))));
    return orOne(largest);
}

const Volume& checked(const Volume& volume) {
    checkVolume(volume);
    return volume;
}

}  // namespace

GpuVolume::GpuVolume(const Volume& volume)
    : size_(checked(volume).size), toLocal_(volumeToLocal(volume)), valueScale_(largestMagnitude(volume.values)) {
    const std::vector<glm::vec3> gradients = volumeGradients(volume);
    const double gradientScale = largestComponent(gradients);
    std::vector<std::uint16_t> texels;
    texels.reserve(4 * volume.values.size());
    const auto push = [&](double v) { texels.push_back(Imath::half(static_cast<float>(v)).bits()); };
    for (std::size_t i = 0; i < volume.values.size(); ++i) {
        for (int c = 0; c < 3; ++c) push(gradients[i][c] / gradientScale);
        push(volume.values[i] / valueScale_);
    }
    bytes_ = texels.size() * sizeof(texels[0]);
    glBindTexture(GL_TEXTURE_3D, texture_.name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA16F, size_.x, size_.y, size_.z, 0, GL_RGBA, GL_HALF_FLOAT, texels.data());
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTexParameteri(GL_TEXTURE_3D, wrap, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAX_LEVEL, 0);
    glBindTexture(GL_TEXTURE_3D, 0);
    checkGl(fmt::format("volume of {} x {} x {} texels", size_.x, size_.y, size_.z));
}

void GpuVolume::bind(int unit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_3D, texture_.name());
}

}  // namespace nacre
