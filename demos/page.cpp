#include "demos/page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "core/error.hpp"
#include "demos/page_parts.hpp"
#include "demos/page_style.hpp"
#include "reference/image_compare.hpp"
#include "reference/tone.hpp"

namespace nacre {
namespace {

const std::string kSpeedUp = "speed-up: direct ÷ factored";

/// differenceColor from 0 to 1 as CSS.
std::string differenceGradient() {
    constexpr int kStops = 11;
    std::string css = "linear-gradient(to right";
    for (int i = 0; i < kStops; ++i) {
        const Rgb c = differenceColor(static_cast<double>(i) / (kStops - 1));
        css += fmt::format(", rgb({:.0f} {:.0f} {:.0f})", 255 * srgbEncode(c.r), 255 * srgbEncode(c.g),
                           255 * srgbEncode(c.b));
    }
    return css + ")";
}

std::string ratio(const Entry& e, const Shot& shot) {
    return e.directMilliseconds ? costRatio(shot.milliseconds, *e.directMilliseconds, e.geometryMilliseconds) : "–";
}

std::string duration(double seconds) {
    if (seconds < 1) return formatNumber(std::max(1.0, std::round(1000 * seconds))) + " ms";
    return formatNumber(seconds) + " s";
}

std::string summaryTable(const Gallery& gallery) {
    std::string html = "<table class=\"cards\">" +
                       headRowHtml({"entry", "E<sub>L2</sub>", "picture", "bytes", "fetches", "frame", kSpeedUp}) +
                       "<tbody>\n";
    for (const Entry& e : gallery.entries) {
        const Shot& shot = e.shots.front();
        html += fmt::format("<tr><td><a href=\"#{}\">{}</a></td>", e.id, escapeHtml(e.title)) +
                cellHtml("E_L2", percentText(e.asset.error.l2Rel)) + cellHtml("picture", psnrText(shot.psnr)) +
                cellHtml("bytes", formatBytes(e.asset.bytes)) + cellHtml("fetches", std::to_string(e.asset.fetches)) +
                cellHtml("frame", formatNumber(shot.milliseconds) + " ms") + cellHtml(kSpeedUp, ratio(e, shot)) +
                "</tr>\n";
    }
    return html + "</tbody></table>\n";
}

std::string exhibitTable(const Gallery& gallery) {
    if (gallery.exhibits.empty()) return {};
    std::string html = "<table class=\"cards\">" +
                       headRowHtml({"exhibits", "lowest PSNR of ours", "longest frame of ours"}) + "<tbody>\n";
    for (const Exhibit& e : gallery.exhibits) {
        const std::optional<double> psnr = lowestPsnr(e), frame = longestFrame(e);
        html += fmt::format("<tr><td><a href=\"#{}\">{}</a></td>", e.id, escapeHtml(e.title)) +
                cellHtml("lowest PSNR of ours", psnr ? psnrText(*psnr) : "–") +
                cellHtml("longest frame of ours", frame ? formatNumber(*frame) + " ms" : "–") + "</tr>\n";
    }
    return html + "</tbody></table>\n";
}

std::string timeRow(const std::string& name, double milliseconds) {
    return fmt::format("<tr><td>{}</td>", escapeHtml(name)) + cellHtml("PSNR", "–") + cellHtml("rel. error", "–") +
           cellHtml("frame", formatNumber(milliseconds) + " ms") + cellHtml(kSpeedUp, "–") + "</tr>\n";
}

std::string shotTable(const Entry& e) {
    std::string html =
        "<table class=\"cards\">" + headRowHtml({"drawn", "PSNR", "relative error", "frame", kSpeedUp}) + "<tbody>\n";
    for (const Shot& shot : e.shots)
        html += fmt::format("<tr><td>{}</td>", escapeHtml(shot.label)) + cellHtml("PSNR", psnrText(shot.psnr)) +
                cellHtml("rel. error", percentText(shot.relativeError)) +
                cellHtml("frame", formatNumber(shot.milliseconds) + " ms") + cellHtml(kSpeedUp, ratio(e, shot)) +
                "</tr>\n";
    if (e.directMilliseconds) html += timeRow("evaluated directly: " + e.directLabel, *e.directMilliseconds);
    html += timeRow("the mesh without light", e.geometryMilliseconds);
    return html + "</tbody></table>\n";
}

std::string fact(const std::string& name, const std::string& value) {
    return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, value);
}

std::string assetFacts(const AssetFacts& a) {
    return "<dl>" + fact("method, form", escapeHtml(a.method + ", " + a.form)) +
           fact("textures", escapeHtml(a.textures)) + fact("bytes", formatBytes(a.bytes)) +
           fact("fetches", std::to_string(a.fetches)) + fact("E<sub>L2</sub> to 80°", percentText(a.error.l2Rel)) +
           fact("E<sub>L2</sub> 80–89°", percentText(a.error.grazingL2Rel)) +
           fact("E<sub>log</sub>", formatNumber(a.error.logRms)) +
           fact("largest relative", percentText(a.error.maxRel)) + fact("lit sphere", psnrText(a.error.spherePsnr)) +
           fact("baked in", duration(a.bakeSeconds)) + "</dl>\n";
}

std::string referenceFigure(const Entry& e) {
    return figureHtml(e.reference, e.title + ": reference", "reference: ray traced, unfactored");
}

std::string differenceFigure(const Entry& e, const Shot& shot) {
    return figureHtml(shot.difference, e.title + ", " + shot.label + ": difference",
                      fmt::format("difference; {}, {}", psnrText(shot.psnr), percentText(shot.relativeError)),
                      scaleBarHtml(e.differenceScale));
}

std::string triple(const Entry& e, const Shot& shot) {
    return figureHtml(shot.picture, e.title, escapeHtml(shot.label)) + referenceFigure(e) + differenceFigure(e, shot);
}

/// Several shots of one reference: each picture stands above its difference.
std::string pairs(const Entry& e) {
    std::string html = referenceFigure(e);
    for (const Shot& shot : e.shots)
        html += pairHtml(2) + figureHtml(shot.picture, e.title + ", " + shot.label, escapeHtml(shot.label)) +
                differenceFigure(e, shot) + "</div>\n";
    return html;
}

std::string article(const Entry& e) {
    std::string html = fmt::format("<article id=\"{}\"><h3>{}</h3><p>{}</p>\n<div class=\"shots\">\n", e.id,
                                   escapeHtml(e.title), escapeHtml(e.caption));
    html += e.shots.size() > 1 ? pairs(e) : triple(e, e.shots.front());
    html += "</div>\n" + shotTable(e);
    if (!e.directMilliseconds && !e.directLabel.empty())
        html += "<p class=\"note\">" + escapeHtml(e.directLabel) + "</p>\n";
    html += assetFacts(e.asset);
    html += "<p class=\"soft\">" + escapeHtml(e.scene) + "</p>\n<pre>" + escapeHtml(e.command) + "</pre>\n";
    return html + "</article>\n";
}

/// What short names stand for: README.md's bibliography has the rest.
std::string paperList() {
    return "<p>The papers that sections follow, and other short names:</p>\n<ul>\n"
           "<li>HSE: W. Heidrich, “Hardware Shading Effects”, chapter 3 of the SIGGRAPH course “Real-time "
           "Shading”.</li>\n"
           "<li>MPR: P. Diefenbach, N. Badler, “Multi-Pass Pipeline Rendering: Realism for Dynamic Environments”, I3D "
           "1997.</li>\n"
           "<li>PR94: P. Diefenbach, N. Badler, “Pipeline rendering: interactive refractions, reflections and "
           "shadows”, Displays 15(3), 1994.</li>\n"
           "<li>HEMI: J. Kautz, J. Lehtinen, T. Aila, “Hemispherical Rasterization for Self-Shadowing of Dynamic "
           "Objects”, EGSR 2004.</li>\n"
           "<li>HYBRID: T. Udeshi, C. Hansen, “Towards Interactive Photorealistic Rendering of Indoor Scenes: A Hybrid "
           "Approach”, EGRW 1999.</li>\n"
           "<li>BRDF: bidirectional reflectance distribution function. GGX: Trowbridge and Reitz's distribution of "
           "microfacets (Walter 2007). MERL: a database of measured BRDFs (Matusik 2003). CC0: in the public "
           "domain.</li>\n</ul>\n";
}

std::string introduction(const Gallery& gallery) {
    std::string html =
        "<h1>nacre: gallery</h1>\n<p>Each picture here is what nacre draws in real time, beside its truth: a reference "
        "of the same scene, lights and camera, traced by rays or summed without the shortcut that is shown; the "
        "difference of the two; and what it costs. The first sections have materials whose reflectance was turned into "
        "one to three small textures (<em>factored</em>), which a shader looks up for each pixel and light. The others "
        "have surroundings as light, bumps, shadow maps, volumes, mirrors and glass, light between surfaces, scenes "
        "that the pipeline and the processor draw together (<em>hybrid</em>), and moving meshes that shadow themselves "
        "(<em>transfer</em>).</p>\n<p>The reference of a factored material is ray traced with the unfactored "
        "reflectance, and the cost of the lookup stands against that of evaluating the model in the same shader, "
        "measured in the same "
        "run.</p>\n<p>All pictures of an entry have the reference's exposure. A difference is that of the values "
        "shown (sRGB, 0 to 1), the largest of the three channels, as a colour; the PSNR is of the same values; the "
        "relative error is √Σ(picture − reference)² ÷ √Σ reference² of linear radiance. Pixels at the outline are left "
        "out. The speed-up is the time of evaluating the model directly ÷ that of the lookups, both less the time "
        "of the same frame without light: above 1 the lookups are faster. E<sub>L2</sub> is the relative error of the "
        "reflectance itself over all "
        "directions up to 80°, read back "
        "from the file through the stored format and the texture filter. <code>reference/brdf_metrics.hpp</code> and "
        "<code>reference/image_compare.hpp</code> define these numbers.</p>\n"
        "<ul>\n<li>PSNR: peak signal-to-noise ratio, −10 log₁₀ of the mean squared difference of shown values, in dB; "
        "more is nearer, and from 40 dB on hardly anybody sees a difference.</li>\n<li>E<sub>log</sub>: root mean "
        "square "
        "of ln((factored + 0.001) ÷ (true + 0.001)) over directions up to 80°: the dark parts count as much as the "
        "bright.</li>\n<li>Lit sphere: PSNR of a sphere lit by each of six lamps in turn, factored against true.</li>\n"
        "</ul>\n" +
        paperList();
    if (!gallery.exhibits.empty())
        html +=
            "<p>Under the environment maps the light is a whole surrounding, filtered beforehand by the surface's lobe "
            "and looked up once a pixel. There the reference sums the lobe over every texel of the surrounding for "
            "each pixel, with exact Fresnel factors. Of bump maps it follows rays over the relief's own "
            "surface.</p>\n<p>The summary's PSNR and frames of exhibits are nacre's own, at its defaults or better. "
            "What is marked “for comparison” doesn't count: other methods, parts switched off, coarser settings, "
            "truths "
            "that leave something out. A – stands where there is no truth, or where no "
            "whole frame is timed: charts, and shadow counts alone.</p>\n";
    html += fmt::format("<p class=\"soft\">nacre {}; {}; {}; made in {} s{}</p>\n", escapeHtml(gallery.version),
                        escapeHtml(gallery.renderer), escapeHtml(gallery.machine), formatNumber(gallery.seconds),
                        gallery.quick ? "; <strong>quick run: small pictures, few samples</strong>" : "");
    for (const std::string& note : gallery.notes) html += "<p class=\"note\">" + escapeHtml(note) + "</p>\n";
    return html;
}

}  // namespace

std::string galleryPage(const Gallery& gallery) {
    galleryJson(gallery);  // checks every entry
    std::string html =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>nacre: gallery</title>\n"
        "<link rel=\"icon\" href=\"data:,\">\n<style>";
    html += std::string(kPageStyle) + ".scale { background: " + differenceGradient() + "; }\n</style>\n</head>\n";
    html += "<body>\n<main>\n" + introduction(gallery) + "<h2>Summary</h2>\n" + summaryTable(gallery) +
            exhibitTable(gallery);
    std::string section;
    for (const Entry& entry : gallery.entries) {
        if (entry.section != section) html += "<h2>" + escapeHtml(entry.section) + "</h2>\n";
        section = entry.section;
        html += article(entry);
    }
    for (const Exhibit& exhibit : gallery.exhibits) {
        if (exhibit.section != section) html += "<h2>" + escapeHtml(exhibit.section) + "</h2>\n";
        section = exhibit.section;
        html += exhibitHtml(exhibit);
    }
    return html + "</main>\n</body>\n</html>\n";
}

}  // namespace nacre
