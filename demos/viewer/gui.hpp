// Dear ImGui's global context, as long as a window.
#pragma once

struct GLFWwindow;

namespace nacre {

class Gui {
public:
    /// Chains to the window's callbacks, which must be there already.
    explicit Gui(GLFWwindow* window);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    void begin() const;  ///< of a frame's widgets
    void draw() const;   ///< them into the framebuffer that is bound
};

}  // namespace nacre
