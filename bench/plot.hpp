// Scatter plots with logarithmic axes as SVG text.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace nacre::bench {

struct PlotPoint {
    double x = 0, y = 0;
    double low = 0, high = 0;  ///< range of y, drawn as a thin line
    std::string label;         ///< shown by the pointer
    bool marked = false;       ///< ringed
};

/// Points of one colour; those that no other point of the series beats in both x and y are joined.
struct PlotSeries {
    std::string name;
    std::vector<PlotPoint> points;
    std::size_t color = 0;  ///< index into the palette of eight: one name, one colour in every plot
};

struct Plot {
    std::string title, xLabel, yLabel;
    std::vector<PlotSeries> series;
    std::optional<double> reference;  ///< dashed vertical line
    std::string referenceLabel;
    std::string markedLabel;  ///< what the rings mean; not in the legend when no point is marked
};

/// <svg>…</svg> that scales with its container and takes text and line colours from the page (currentColor).
/// Points whose x or y isn't finite and > 0 are left out; the title says how many.
std::string svgPlot(const Plot& plot);

}  // namespace nacre::bench
