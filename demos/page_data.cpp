// The page's checks, gallery.json, and the small formats of text.
#include <fmt/format.h>

#include <cmath>
#include <set>

#include "core/error.hpp"
#include "demos/page_parts.hpp"

namespace nacre {
namespace {

nlohmann::json shotJson(const Entry& e, const Shot& shot) {
    checkPicture(e.id, shot.picture);
    checkPicture(e.id, shot.difference);
    return {{"label", shot.label},
            {"picture", shot.picture.file},
            {"difference", shot.difference.file},
            {"psnr_db", checkedFinite(e.id, "psnr", shot.psnr)},
            {"relative_error", checkedFinite(e.id, "relativeError", shot.relativeError)},
            {"milliseconds", checkedFinite(e.id, "milliseconds", shot.milliseconds)}};
}

nlohmann::json errorJson(const Entry& e) {
    const nlohmann::json error = toJson(e.asset.error);
    for (const auto& [key, value] : error.items())
        if (key != "energy_seen")
            checkedFinite(e.id, key.c_str(), value.get<double>());  // that one has no value for formulas
    return error;
}

nlohmann::json assetJson(const Entry& e) {
    const AssetFacts& a = e.asset;
    return {{"source", a.source},
            {"method", a.method},
            {"form", a.form},
            {"textures", a.textures},
            {"bytes", a.bytes},
            {"fetches", a.fetches},
            {"bake_seconds", checkedFinite(e.id, "bakeSeconds", a.bakeSeconds)},
            {"error", errorJson(e)}};
}

nlohmann::json entryJson(const Entry& e) {
    checkId(e.id);
    require(!e.shots.empty(), "gallery entry " + e.id + " has no shot");
    checkPicture(e.id, e.reference);
    nlohmann::json shots = nlohmann::json::array();
    for (const Shot& shot : e.shots) shots.push_back(shotJson(e, shot));
    return {{"id", e.id},
            {"section", e.section},
            {"title", e.title},
            {"caption", e.caption},
            {"scene", e.scene},
            {"reference", e.reference.file},
            {"shots", shots},
            {"difference_scale", checkedFinite(e.id, "differenceScale", e.differenceScale)},
            {"geometry_milliseconds", checkedFinite(e.id, "geometryMilliseconds", e.geometryMilliseconds)},
            {"direct_milliseconds",
             e.directMilliseconds ? nlohmann::json(checkedFinite(e.id, "directMilliseconds", *e.directMilliseconds))
                                  : nlohmann::json()},
            {"direct", e.directLabel},
            {"asset", assetJson(e)},
            {"command", e.command}};
}

}  // namespace

nlohmann::json galleryJson(const Gallery& gallery) {
    nlohmann::json entries = nlohmann::json::array();
    std::set<std::string> ids;
    for (const Entry& entry : gallery.entries) {
        entries.push_back(entryJson(entry));
        require(ids.insert(entry.id).second, "gallery entry " + entry.id + " appears twice");
    }
    nlohmann::json exhibits = nlohmann::json::array();
    for (const Exhibit& exhibit : gallery.exhibits) {
        exhibits.push_back(exhibitJson(exhibit));
        require(ids.insert(exhibit.id).second, "gallery entry " + exhibit.id + " appears twice");
    }
    return {{"version", gallery.version}, {"renderer", gallery.renderer}, {"machine", gallery.machine},
            {"quick", gallery.quick},     {"notes", gallery.notes},       {"seconds", gallery.seconds},
            {"entries", entries},         {"exhibits", exhibits}};
}

std::string base64(const std::vector<std::uint8_t>& bytes) {  // RFC 4648, section 4
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < left ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k) out += k <= left ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

std::string escapeHtml(const std::string& text) {
    std::string out;
    for (const char c : text) switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    return out;
}

std::string formatNumber(double value, int digits) {
    require(std::isfinite(value) && digits >= 1, "formatNumber: value must be finite, digits >= 1");
    if (value == 0) return "0";
    const double size = std::abs(value);
    if (size < 1e-4 || size >= 1e6) return fmt::format("{:.{}e}", value, digits - 1);
    const int before = static_cast<int>(std::floor(std::log10(size))) + 1;  // digits before the point, may be ≤ 0
    return fmt::format("{:.{}f}", value, std::max(0, digits - before));
}

std::string formatBytes(std::size_t bytes) {
    const double size = static_cast<double>(bytes);
    if (bytes < 1024) return fmt::format("{} B", bytes);
    if (bytes < 1024 * 1024) return formatNumber(size / 1024) + " KiB";
    return formatNumber(size / 1024 / 1024) + " MiB";
}

std::string costRatio(double factoredMs, double directMs, double geometryMs) {
    const double factored = factoredMs - geometryMs, direct = directMs - geometryMs;
    const double least = 0.02 * geometryMs;  // differences of medians below that are noise
    return factored <= least || direct <= least ? "–" : formatNumber(direct / factored, 2) + "×";
}

}  // namespace nacre
