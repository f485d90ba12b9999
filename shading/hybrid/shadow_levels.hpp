// How much of a light's points a view's pixels don't see, and how such levels are smoothed (HYBRID section 4.1).
#pragma once

#include "core/image.hpp"
#include "shading/hybrid/geometry_buffer.hpp"

namespace nacre {

/// How a soft shadow's levels are smoothed. Box: the paper's 7 × 7 average. EdgeStopping: the same, of those pixels
/// that show the same object near the plane of the middle one's surface, and differ from it by at most one of the
/// light's points: steps between levels go, edges of shadows stay.
enum class ShadowFilter { None, Box, EdgeStopping };

/// A framebuffer of 32-bit floats with one R32F texture, and a depth and stencil renderbuffer if one is given.
/// \throws nacre::Error when the driver refuses
class LevelTarget {
public:
    LevelTarget(int width, int height, GlName depth = 0);
    GlName framebuffer() const { return framebuffer_.name(); }
    GlName texture() const { return texture_.name(); }

private:
    FramebufferName framebuffer_;
    TextureName texture_;
};

/// Sum of the weights of points that don't reach a pixel, which passes add up by blending.
class ShadowLevels {
public:
    ShadowLevels(int width, int height);
    int width() const { return width_; }
    int height() const { return height_; }

    void clear();
    /// Binds the target with its viewport, blending on (one, one), depth test and culling off.
    void beginAdding(double weight);
    void endAdding();  ///< blending off, depth test on, framebuffer 0

    /// The levels as one channel of `framebuffer`, whose size is this one's. \param geometry  of the same pixels
    void filter(ProgramLoader& loader, const GeometryBuffer& geometry, ShadowFilter filter, GlName framebuffer) const;
    Image read(ProgramLoader& loader, const GeometryBuffer& geometry, ShadowFilter filter);  ///< row 0 on top

private:
    int width_, height_;
    double step_ = 0;  ///< the largest weight added
    LevelTarget sum_, filtered_;
};

}  // namespace nacre
