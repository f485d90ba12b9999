#include "demos/exhibit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "demos/page_parts.hpp"

namespace nacre {
namespace {

template <class Body>
void forEachPanel(const Exhibit& exhibit, Body body) {
    for (const PanelRow& row : exhibit.rows)
        for (const Panel& panel : row.panels) body(panel);
}

template <class Body>
void forEachOwn(const Exhibit& exhibit, Body body) {
    for (const PanelRow& row : exhibit.rows)
        for (const Panel& panel : row.panels)
            if (row.ours && panel.ours) body(panel);
}

std::string rowTitle(const PanelRow& row) {
    if (row.ours) return escapeHtml(row.title);
    const std::string mark = "<span class=\"soft\">for comparison</span>";
    return row.title.empty() ? mark : escapeHtml(row.title) + "; " + mark;
}

std::string panelFacts(const Panel& panel) {
    std::string text = escapeHtml(panel.label);
    if (panel.milliseconds) text += "; " + formatNumber(*panel.milliseconds) + " ms";
    if (!panel.ours) text += text.empty() ? "for comparison" : "; for comparison";
    return text;
}

std::string panelHtml(const Exhibit& e, const Panel& panel) {
    const std::string name = e.title + ": " + panel.label;
    std::string html = pairHtml(panel.comparison ? 3 : 1) + figureHtml(panel.picture, name, panelFacts(panel));
    if (panel.comparison) {
        const Comparison& c = *panel.comparison;
        html += figureHtml(c.reference, name + ", reference", "reference");
        html += figureHtml(c.difference, name + ", difference",
                           fmt::format("difference; {}, {}", psnrText(c.psnr), percentText(c.relativeError)),
                           scaleBarHtml(e.differenceScale));
    }
    return html + "</div>\n";
}

nlohmann::json panelJson(const Exhibit& e, const Panel& panel) {
    checkPicture(e.id, panel.picture);
    nlohmann::json json{{"label", panel.label}, {"picture", panel.picture.file}, {"ours", panel.ours}};
    if (panel.milliseconds) json["milliseconds"] = checkedFinite(e.id, "milliseconds", *panel.milliseconds);
    if (!panel.comparison) return json;
    const Comparison& c = *panel.comparison;
    checkPicture(e.id, c.reference);
    checkPicture(e.id, c.difference);
    json["reference"] = c.reference.file;
    json["difference"] = c.difference.file;
    json["psnr_db"] = checkedFinite(e.id, "psnr", c.psnr);
    json["relative_error"] = checkedFinite(e.id, "relativeError", c.relativeError);
    return json;
}

std::string tableHtml(const ExhibitTable& table) {
    if (table.rows.empty()) return {};
    std::vector<std::string> head;
    for (const std::string& name : table.head) head.push_back(escapeHtml(name));
    std::string html = "<table class=\"cards\">" + headRowHtml(head) + "<tbody>\n";
    for (const std::vector<std::string>& row : table.rows) {
        html += "<tr><td>" + escapeHtml(row[0]) + "</td>";
        for (std::size_t i = 1; i < row.size(); ++i) html += cellHtml(head[i], escapeHtml(row[i]));
        html += "</tr>\n";
    }
    return html + "</tbody></table>\n";
}

}  // namespace

std::optional<double> lowestPsnr(const Exhibit& exhibit) {
    std::optional<double> lowest;
    forEachOwn(exhibit, [&](const Panel& p) {
        if (p.comparison) lowest = std::min(lowest.value_or(p.comparison->psnr), p.comparison->psnr);
    });
    return lowest;
}

std::optional<double> longestFrame(const Exhibit& exhibit) {
    std::optional<double> longest;
    forEachOwn(exhibit, [&](const Panel& p) {
        if (p.milliseconds) longest = std::max(longest.value_or(0), *p.milliseconds);
    });
    return longest;
}

std::vector<const Picture*> picturesOf(const Exhibit& exhibit) {
    std::vector<const Picture*> out;
    forEachPanel(exhibit, [&](const Panel& p) {
        out.push_back(&p.picture);
        if (p.comparison) out.insert(out.end(), {&p.comparison->reference, &p.comparison->difference});
    });
    return out;
}

std::string exhibitHtml(const Exhibit& e) {
    exhibitJson(e);  // checks it
    std::string html =
        fmt::format("<article id=\"{}\"><h3>{}</h3><p>{}</p>\n", e.id, escapeHtml(e.title), escapeHtml(e.caption));
    for (const PanelRow& row : e.rows) {
        if (const std::string title = rowTitle(row); !title.empty()) html += "<h4>" + title + "</h4>\n";
        html += "<div class=\"shots\">\n";
        for (const Panel& panel : row.panels) html += panelHtml(e, panel);
        html += "</div>\n";
    }
    html += tableHtml(e.table);
    if (e.geometryMilliseconds)
        html += fmt::format("<p class=\"soft\">the body without light: {} ms a frame</p>\n",
                            formatNumber(*e.geometryMilliseconds));
    html += "<p class=\"soft\">" + escapeHtml(e.scene) + "</p>\n";
    for (const std::string& command : e.commands) html += "<pre>" + escapeHtml(command) + "</pre>\n";
    return html + "</article>\n";
}

nlohmann::json exhibitJson(const Exhibit& e) {
    checkId(e.id);
    nlohmann::json rows = nlohmann::json::array();
    std::size_t count = 0;
    for (const PanelRow& row : e.rows) {
        nlohmann::json panels = nlohmann::json::array();
        for (const Panel& panel : row.panels) panels.push_back(panelJson(e, panel));
        count += row.panels.size();
        rows.push_back({{"title", row.title}, {"ours", row.ours}, {"panels", panels}});
    }
    require(count > 0, "gallery entry " + e.id + " has no panel");
    nlohmann::json json{{"id", e.id},
                        {"section", e.section},
                        {"title", e.title},
                        {"caption", e.caption},
                        {"scene", e.scene},
                        {"rows", rows},
                        {"commands", e.commands},
                        {"difference_scale", checkedFinite(e.id, "differenceScale", e.differenceScale)}};
    for (const std::vector<std::string>& row : e.table.rows)
        require(!row.empty() && row.size() == e.table.head.size(),
                fmt::format("gallery entry {}: expected {} cells in a table's row, found {}", e.id, e.table.head.size(),
                            row.size()));
    if (!e.table.rows.empty()) json["table"] = {{"head", e.table.head}, {"rows", e.table.rows}};
    if (e.geometryMilliseconds)
        json["geometry_milliseconds"] = checkedFinite(e.id, "geometryMilliseconds", *e.geometryMilliseconds);
    return json;
}

}  // namespace nacre
