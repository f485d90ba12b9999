// Exhibits: rows of pictures, each with its truth where there is one. What entry.hpp's entries are to one baked BRDF,
// exhibits are to environment maps. Knows no OpenGL.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace nacre {

/// A PNG file's bytes and the name it has beside the page.
struct Picture {
    std::string file;
    std::vector<std::uint8_t> png;
};

/// What a picture is compared with.
struct Comparison {
    Picture reference, difference;  ///< difference: false colours, white = Exhibit::differenceScale
    double psnr = 0;                ///< [dB], of the pictures as shown
    double relativeError = 0;       ///< ImageDifference::relative
};

struct Panel {
    std::string label;
    Picture picture;
    std::optional<Comparison> comparison;  ///< none: a chart or a map shown as it is
    std::optional<double> milliseconds;    ///< of one frame, without background, median
    bool ours = true;                      ///< as PanelRow's
};

struct PanelRow {
    std::string title;  ///< may be empty
    std::vector<Panel> panels;
    /// false: shown for comparison (another method, a part switched off, a setting coarser than the default, a truth
    /// that leaves something out); the page says so and the summary leaves it out
    bool ours = true;
};

/// Text in rows, as many cells each as `head` has; without rows nothing is shown.
struct ExhibitTable {
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
};

struct Exhibit {
    std::string id;  ///< as Entry's
    std::string section, title, caption;
    std::vector<PanelRow> rows;
    double differenceScale = 1;                  ///< one for all panels
    std::optional<double> geometryMilliseconds;  ///< frame time of the first body without any light
    std::string scene;                           ///< bodies, maps, sizes, exposure, in words
    std::vector<std::string> commands;           ///< make the maps, word for word
    ExhibitTable table{};
};

/// The lowest PSNR of its own panels (`ours`, their rows' too); nothing where none has a truth.
std::optional<double> lowestPsnr(const Exhibit& exhibit);

/// The longest frame of its own panels [ms]; nothing where none was timed.
std::optional<double> longestFrame(const Exhibit& exhibit);

/// An <article>, and its facts for programs; checked as galleryPage checks entries: \throws std::invalid_argument for
/// bad ids, no panel, empty pictures, numbers that are not finite, table rows of another length than the head
std::string exhibitHtml(const Exhibit& exhibit);
nlohmann::json exhibitJson(const Exhibit& exhibit);

/// Every picture of it, for writing them beside the page.
std::vector<const Picture*> picturesOf(const Exhibit& exhibit);

}  // namespace nacre
