// A volume as a 3D texture: gradients in RGB, values in alpha (Westermann & Ertl 1998, the source of HSE figure 7).
#pragma once

#include "core/volume.hpp"
#include "shading/gl_objects.hpp"

namespace nacre {

class GpuVolume {
public:
    /// Half floats; linear filter, clamped to the edge. Values are divided by the largest magnitude among them, and
    /// gradients by theirs, so that both use the format's range. Binds 0 to GL_TEXTURE_3D of the active unit and sets
    /// the unpack alignment to 1.
    /// \throws std::invalid_argument from checkVolume; nacre::Error from the driver
    explicit GpuVolume(const Volume& volume);

    glm::ivec3 size() const { return size_; }
    const glm::dmat4& toLocal() const { return toLocal_; }  ///< volumeToLocal
    double valueScale() const { return valueScale_; }       ///< value = alpha · valueScale
    std::size_t bytes() const { return bytes_; }
    /// Binds to texture unit `unit` and leaves that unit active.
    void bind(int unit) const;

private:
    TextureName texture_;
    glm::ivec3 size_;
    glm::dmat4 toLocal_;
    double valueScale_ = 1;
    std::size_t bytes_ = 0;
};

}  // namespace nacre
