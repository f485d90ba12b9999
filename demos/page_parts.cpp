#include "demos/page_parts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"

namespace nacre {
namespace {

std::string dataUri(const Picture& picture) { return "data:image/png;base64," + base64(picture.png); }

}  // namespace

std::string figureHtml(const Picture& picture, const std::string& alt, const std::string& caption,
                       const std::string& below) {
    return fmt::format("<figure><img alt=\"{}\" src=\"{}\">{}<figcaption>{}</figcaption></figure>\n", escapeHtml(alt),
                       dataUri(picture), below, caption);
}

std::string pairHtml(int figures) { return fmt::format("<div class=\"pair\" style=\"--figures: {}\">", figures); }

std::string scaleBarHtml(double scale) {
    std::string ticks;
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
        ticks += fmt::format("<span>{}</span>", formatNumber(share * scale, 2));
    return "<div class=\"scale\"></div><div class=\"ticks\">" + ticks + "</div>" +
           fmt::format("<div class=\"unit\">of shown values, 0 to 1; the brightest colour is {}</div>",
                       scale == 1 ? "all of it" : formatNumber(scale, 2) + " and more");
}

std::string psnrText(double psnr) { return psnr < 200 ? fmt::format("{:.1f} dB", psnr) : "identical"; }

std::string percentText(double share) { return formatNumber(100 * share, 3) + " %"; }

std::string cellHtml(const std::string& name, const std::string& value) {
    return fmt::format("<td data-name=\"{}\"><span>{}</span></td>", name, value);
}

std::string headRowHtml(const std::vector<std::string>& names) {
    std::string row = "<thead><tr>";
    for (const std::string& name : names) row += "<th scope=\"col\">" + name + "</th>";
    return row + "</tr></thead>\n";
}

void checkId(const std::string& id) {
    require(!id.empty() && id.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos,
            "gallery entry '" + id + "': an id is made of a-z, 0-9 and dashes");
}

void checkPicture(const std::string& id, const Picture& picture) {
    require(!picture.png.empty() && !picture.file.empty(),
            "gallery entry " + id + ": a picture has no bytes or no file name");
}

double checkedFinite(const std::string& id, const char* field, double value) {
    require(std::isfinite(value), fmt::format("gallery entry {}: {} is {}", id, field, value));
    return value;
}

}  // namespace nacre
