// The gallery's page: what was rendered and measured goes in, one self-contained HTML text comes out. Knows no OpenGL.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "demos/exhibit.hpp"
#include "reference/brdf_metrics.hpp"

namespace nacre {

/// One way of drawing an entry, against the entry's reference.
struct Shot {
    std::string label;            ///< for instance `per pixel`
    Picture picture, difference;  ///< difference: false colours, black = 0, white = Entry::differenceScale
    double psnr = 0;              ///< [dB], of the pictures as shown
    double relativeError = 0;     ///< ImageDifference::relative
    double milliseconds = 0;      ///< of one frame, median
};

/// What is known of the baked asset.
struct AssetFacts {
    std::string source, method, form;
    std::string textures;  ///< sizes and storage, for instance `2 × 64² half`
    std::size_t bytes = 0;
    int fetches = 0;
    double bakeSeconds = 0;
    BrdfError error;
};

struct Entry {
    std::string id;       ///< letters, digits, dashes: anchor, and first part of the file names
    std::string section;  ///< heading under which it stands; entries of one section follow each other
    std::string title, caption;
    Picture reference;
    std::vector<Shot> shots;                   ///< ≥ 1; the first one stands for the entry in the summary
    double differenceScale = 1;                ///< largest difference shown, in units of white
    std::string scene;                         ///< mesh, lights, picture size, exposure, in words
    double geometryMilliseconds = 0;           ///< frame time of the same mesh without any light: what is no shading
    std::optional<double> directMilliseconds;  ///< frame time of the unfactored model evaluated in the shader
    std::string directLabel;                   ///< what was evaluated for that time, or why nothing was
    AssetFacts asset;
    std::string command;  ///< bakes the asset, word for word
};

struct Gallery {
    std::string version, renderer, machine;  ///< renderer: OpenGL's own words; machine: processor and cores
    bool quick = false;                      ///< fewer samples and smaller pictures: said on the page
    std::vector<std::string> notes;          ///< inputs that were missing and what stands in for them
    double seconds = 0;                      ///< the whole run took
    std::vector<Entry> entries;
    std::vector<Exhibit> exhibits;  ///< after the entries
};

/// A complete HTML document, UTF-8: pictures as data URIs, no script, nothing fetched. One column on narrow screens,
/// light or dark as the reader's system asks.
/// \throws std::invalid_argument when ids are empty, repeated or hold other characters than said above, an entry has no
///         shot, a picture is empty, or a number is not finite
std::string galleryPage(const Gallery& gallery);

/// The same facts for programs: gallery.json. Pictures by file name.
nlohmann::json galleryJson(const Gallery& gallery);

/// Pieces the page is made of, for its tests.
std::string base64(const std::vector<std::uint8_t>& bytes);
std::string escapeHtml(const std::string& text);
/// `1.7×`: time of direct shading over that of the lookups, both less the geometry's; `–` where either is lost in it.
std::string costRatio(double factoredMs, double directMs, double geometryMs);
/// `value` with `digits` significant digits, without exponent for 1e-4 ≤ |value| < 1e6.
std::string formatNumber(double value, int digits = 3);
std::string formatBytes(std::size_t bytes);  ///< `512 B`, `16.0 KiB`, `1.50 MiB`

}  // namespace nacre
