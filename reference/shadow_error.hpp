// What rays say about a light's shadows, and how far a mask drawn by another method is from that.
#pragma once

#include <vector>

#include "core/shadow_view.hpp"
#include "reference/embree_scene.hpp"

namespace nacre {

struct ShadowErrorOptions {
    int width = 512, height = 512;  ///< [pixels] ≥ 1
    unsigned threads = 0;           ///< 0 = all cores, same bits for any
};

/// Pixels that see a surface which faces eye and light by its shading normal, within the cone; and those of them on
/// which a mask (lit: share > 1/2) differs from the ray to the light.
///
/// At a boundary: within half the filter's edge (n/2 texels of the map, each way) the surface's true visibility
/// changes. On a grid of 5 × 5 rays from the light over that square, the surface hit that is nearest to the pixel's
/// plane is looked for; it is lit when it is the first hit. One that differs from the pixel makes it a boundary pixel.
/// A surface that goes on under another has an edge there, a crease of two that end there is none.
/// Edges narrower than the grid go unseen, and misjudged pixels there count as acne or leaks.
struct ShadowError {
    std::size_t pixels = 0;
    std::size_t acne = 0;      ///< lit, called shadowed, not at a boundary
    std::size_t leaks = 0;     ///< shadowed, called lit, not at a boundary
    std::size_t boundary = 0;  ///< misjudged at a boundary
    double share(std::size_t count) const {
        return pixels == 0 ? 0 : static_cast<double>(count) / static_cast<double>(pixels);
    }
    double misjudged() const { return share(acne + leaks + boundary); }
    double offBoundary() const { return share(acne + leaks); }
};

enum class ShadowPixel : unsigned char { None, Lit, Shadowed };

/// Rays' answer for each pixel of a picture.
class ShadowTruth {
public:
    /// \param mesh  casters and receivers, in the world. \throws std::invalid_argument: sizes < 1, broken light or mesh
    ShadowTruth(const Mesh& mesh, const Camera& camera, const Light& light, const ShadowErrorOptions& options = {});

    ShadowPixel at(int x, int y) const { return pixels_[index(x, y)].truth; }
    /// 1 lit, 0 shadowed, 0.5 no question.
    Image picture() const;
    /// \param mask  one channel of the picture's size: share of the light that arrives
    /// \param view  whose texels and filter say what a boundary is
    ShadowError compare(const Image& mask, const ShadowView& view) const;
    /// Misjudged pixels: 0 none, 1 acne, 2 leak, 3 at a boundary. One channel.
    Image judge(const Image& mask, const ShadowView& view) const;
    /// What shadowLit says of each pixel; 0.5 where there is no question.
    /// \param hyperbolicBits  > 0: resolution is that of a z-buffer with so many bits at the point's depth
    Image mask(const ShadowView& view, const std::vector<Image>& layers, int hyperbolicBits = 0) const;

private:
    struct Pixel {
        Vec3 position{0}, normal{0};  ///< of the triangle, on the seen side
        ShadowPixel truth = ShadowPixel::None;
    };
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(options_.width) + static_cast<std::size_t>(x);
    }
    Pixel trace(const Mesh& mesh, const Ray& ray) const;
    bool atBoundary(const Pixel& pixel, const ShadowView& view) const;
    bool litThere(const Pixel& pixel, const Ray& fromLight) const;

    EmbreeScene scene_;
    Light light_;
    ShadowErrorOptions options_;
    std::vector<Pixel> pixels_;
};

/// How a simulated map stores depth.
struct DepthCode {
    bool hyperbolic = false;  ///< a z-buffer's (1/near − 1/z)/(1/near − 1/far), else linear
    int bits = 24;            ///< codes are k/(2^bits − 1), rounded to nearest; 0: not rounded
};

/// The map that a rasteriser with ideal depth would draw: one ray a texel, its depth rounded in that code. As
/// normalised linear depth for shadowLit. Spot, Cube and Directional.
std::vector<Image> tracedShadowMap(const Mesh& mesh, const ShadowView& view, const DepthCode& code,
                                   unsigned threads = 0);

}  // namespace nacre
