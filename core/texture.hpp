// A texture as it is baked: its stored values, how they are to be read, and the mapping that addresses it.
#pragma once

#include <stdexcept>
#include <string>

#include "core/image.hpp"

namespace nacre {

/// How a texture's values are stored in the file and on the GPU. Unorm8: code k in 0..255 stands for
/// bias + scale · k/255 per channel; the file holds k/255 as half floats, which gives k back exactly.
enum class TexelFormat { Half, Float, Unorm8 };

std::string toString(TexelFormat format);  ///< half, float, unorm8
/// \throws std::invalid_argument that lists the known names
TexelFormat texelFormatFromString(const std::string& name);
std::size_t bytesPerChannel(TexelFormat format);

/// One texture. `image` holds what a sampler returns: for Unorm8 k/255, still to be scaled; for Half values that are
/// exact in half precision. The value a lookup means is bias + scale · sample.
struct AssetTexture {
    std::string name;     ///< unique in the file: EXR part name
    std::string mapping;  ///< name of the mapping that addresses it, for instance `half_diff`
    TexelFormat format = TexelFormat::Half;
    Image image;
    glm::vec4 scale{1.0f}, bias{0.0f};

    /// Bytes on the GPU: texels × channels × bytes a channel.
    std::size_t bytes() const { return image.data().size() * bytesPerChannel(format); }
};

/// Values that a texel format can't hold: the data's fault, where other std::invalid_argument are the caller's.
class StorageError : public std::invalid_argument {
public:
    using std::invalid_argument::invalid_argument;
};

/// Quantises `values` to `format`. Half: rounds to nearest even. Unorm8: per-channel range of the values becomes
/// bias and scale.
/// \throws StorageError on non-finite values, and on half overflow (|v| > 65504), naming the texel
AssetTexture makeTexture(std::string name, std::string mapping, const Image& values, TexelFormat format);

}  // namespace nacre
