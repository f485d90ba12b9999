// Draws an exhibit's panels, compares them with the truth, times them, and brings all to one exposure.
#pragma once

#include <functional>

#include "core/progress.hpp"
#include "demos/exhibit.hpp"
#include "reference/environment_shading.hpp"
#include "shading/environment_pass.hpp"

namespace nacre {

/// A mesh before a camera, on the GPU and as the ray tracer sees it: the same 2 × 2 samples a pixel.
struct Body {
    Mesh mesh;
    GpuMesh gpu;
    Camera camera;
    int size = 0;  ///< edge of its picture [pixels]
    TracedSurface traced;

    Body(Mesh bodyMesh, const Camera& bodyCamera, int pictureSize);
};

/// A sphere seen level from +z, from near with much of the surrounding behind it, and a torus seen from above +z.
Body sphereBody(int size);
Body nearSphereBody(int size);
Body torusBody(int size);

inline constexpr int kSupersample = 2;  ///< n × n samples a pixel, of pictures and truths

struct BuilderOptions {
    int timingRepeats = 5;
    Progress progress{};
};

class ExhibitBuilder {
public:
    ExhibitBuilder(ProgramLoader& loader, std::string id, BuilderOptions options);

    void row(const std::string& title, bool ours = true);
    /// A surface in its surrounding before `sky`, and its truth: one radiance for each sample of the body's.
    /// What pointers lead to must live until finish().
    void panel(const std::string& label, const Body& body, const EnvironmentSurface& surface,
               const EnvironmentLookup& sky, const std::vector<Rgb>& truth);
    /// Any other way of drawing the body; before black without a sky.
    void panel(const std::string& label, const Body& body, std::function<void(const RenderTarget&)> draw,
               const EnvironmentLookup& sky, const std::vector<Rgb>& truth);
    /// Whatever draws, and the truth's picture of the same points (RaytraceOptions::supersample = kSupersample). Timed
    /// with the others.
    void panel(const std::string& label, std::function<void(const RenderTarget&)> draw, const RaytracedPicture& truth);
    /// A picture that was drawn before, and its truth: both of one size. \param milliseconds  that its frame took
    void compared(const std::string& label, Image radiance, Image truth, std::optional<double> milliseconds = {});
    /// A picture as it is.
    void picture(const std::string& label, Image radiance);
    /// The last panel is shown for comparison (Panel::ours).
    void forComparison();
    /// Compares inside the outline, encodes, times. \param white  radiance shown as white; 0 = the largest pictureWhite
    /// of the truths
    void finish(Exhibit& exhibit, double white = 0);

private:
    struct Raw {
        std::string label;
        Image drawn, truth, mask;                         ///< truth empty: a picture as it is
        const Body* body = nullptr;                       ///< none: another truth, or a picture as it is
        std::function<void(const RenderTarget&)> draw{};  ///< empty: a picture as it is
        std::optional<double> milliseconds{};
        bool ours = true;
    };
    struct RawRow {
        std::string title;
        bool ours = true;
        std::vector<Raw> panels;
    };
    double whiteOfTruths() const;
    double scaleOfDifferences(double white) const;
    Panel encode(const Raw& raw, const std::string& stem, double white, double scale) const;
    void time(Exhibit& exhibit) const;

    ProgramLoader& loader_;
    std::string id_;
    BuilderOptions options_;
    std::vector<RawRow> rows_;
};

}  // namespace nacre
