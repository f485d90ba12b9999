// Linear pictures onto the window, tone-mapped as writePng does.
#pragma once

#include "core/image.hpp"
#include "shading/program.hpp"
#include "shading/render_target.hpp"

namespace nacre {

/// A rectangle of the default framebuffer [pixels], y from its lower edge.
struct WindowArea {
    int x = 0, y = 0, width = 0, height = 0;
};

class Presenter {
public:
    /// Copies what was rendered. Leaves the default framebuffer bound.
    void take(const RenderTarget& target);
    /// RGB, linear.
    void take(const Image& image);
    /// Fills `area` of the default framebuffer, stretching what was taken last. Leaves depth test and blending off, and
    /// the area as viewport. \param white  what becomes 255, as ToneMap
    void show(ProgramLoader& loader, const WindowArea& area, double white) const;

private:
    void allocate(int width, int height);
    TextureName texture_;
    int width_ = 0, height_ = 0;
    bool topDown_ = false;  ///< an Image's first row is its top
    VertexArray empty_;
};

}  // namespace nacre
