#include "bench/report.hpp"

#include <cmath>

#include "bench/environment_report.hpp"

namespace nacre::bench {

using nlohmann::json;

namespace {

json number(double v) {
    if (std::isfinite(v)) return v;
    return std::isnan(v) ? "nan" : v > 0 ? "inf" : "-inf";
}

json errorJson(const Measurement& m) {
    json out = toJson(m.error);
    out["reciprocity_residual"] = m.reciprocityResidual;
    for (json& value : out)
        if (value.is_number_float()) value = number(value.get<double>());
    return out;
}

json settingJson(const Setting& s) {
    json out = {{"method", s.method}, {"size", s.size}, {"terms", s.terms}, {"format", toString(s.format)}};
    if (!s.parametrization.empty()) out["parametrization"] = s.parametrization;
    if (s.maxBytes) out["max_bytes"] = *s.maxBytes;
    if (s.maxFetches) out["max_fetches"] = *s.maxFetches;
    return out;
}

json measurementJson(const Measurement& m) {
    json out = {{"material", m.material.name},
                {"group", title(m.material.group)},
                {"source", m.material.source},
                {"setting", settingJson(m.setting)},
                {"paper", isPapersSetting(m.setting)},
                {"form", m.form},
                {"method", m.method},
                {"textures", m.textures},
                {"fetches", m.fetches},
                {"bytes", m.bytes},
                {"seconds", m.seconds},
                {"error", errorJson(m)}};
    if (m.cost)
        out["cost"] = {{"factored_ms", m.cost->factoredMs},
                       {"direct_ms", m.cost->directMs},
                       {"ratio", m.cost->ratio()},
                       {"direct", m.cost->direct}};
    return out;
}

json barJson(const Bar& b) {
    return {{"what", b.what},           {"figure", b.figure}, {"limit", b.limit},       {"at_least", b.atLeast},
            {"value", number(b.value)}, {"decides", b.worst}, {"measured", b.measured}, {"pass", b.pass()}};
}

}  // namespace

json reportJson(const Report& report) {
    json out = {{"version", report.version},     {"machine", report.machine},  {"renderer", report.renderer},
                {"frame", GpuLab::frameText()},  {"quick", report.quick},      {"seconds", report.seconds},
                {"notes", report.notes},         {"bars", json::array()},      {"measurements", json::array()},
                {"environments", json::array()}, {"bumps", json::array()},     {"shadows", json::array()},
                {"transfers", json::array()},    {"speculars", json::array()}, {"hybrid", hybridJson(report.hybrid)}};
    for (const Bar& bar : report.bars) out["bars"].push_back(barJson(bar));
    for (const Measurement& m : report.measurements) out["measurements"].push_back(measurementJson(m));
    for (const EnvironmentMeasurement& m : report.environments) out["environments"].push_back(environmentJson(m));
    for (const BumpMeasurement& m : report.bumps) out["bumps"].push_back(bumpJson(m));
    for (const ShadowMeasurement& m : report.shadows) out["shadows"].push_back(shadowJson(m));
    for (const TransferMeasurement& m : report.transfers) out["transfers"].push_back(transferJson(m));
    for (const SpecularMeasurement& m : report.speculars) out["speculars"].push_back(specularJson(m));
    return out;
}

static SettingSummary summaryOf(const std::vector<const Measurement*>& list) {
    const auto medianOf = [&](auto value) {
        std::vector<double> values;
        for (const Measurement* m : list) values.push_back(value(*m));
        return median(values);
    };
    SettingSummary s;
    s.setting = list.front()->setting;
    s.form = list.front()->form;
    s.fetches = list.front()->fetches;
    s.materials = list.size();
    s.bytes = medianOf([](const Measurement& m) { return static_cast<double>(m.bytes); });
    s.seconds = medianOf([](const Measurement& m) { return m.seconds; });
    s.costRatio = medianOf([](const Measurement& m) { return m.cost ? m.cost->ratio() : 0; });
    s.l2 = medianOf([](const Measurement& m) { return m.error.l2Rel; });
    s.logRms = medianOf([](const Measurement& m) { return m.error.logRms; });
    s.grazing = medianOf([](const Measurement& m) { return m.error.grazingL2Rel; });
    s.psnr = medianOf([](const Measurement& m) { return m.error.spherePsnr; });
    s.l2Low = s.l2High = list.front()->error.l2Rel;
    s.psnrLow = list.front()->error.spherePsnr;
    for (const Measurement* m : list) {
        s.l2Low = std::min(s.l2Low, m->error.l2Rel), s.l2High = std::max(s.l2High, m->error.l2Rel);
        s.psnrLow = std::min(s.psnrLow, m->error.spherePsnr);
    }
    return s;
}

std::vector<SettingSummary> summarise(const std::vector<Measurement>& measurements, Group group) {
    std::vector<std::string> order;
    std::vector<std::vector<const Measurement*>> lists;
    for (const Measurement& m : measurements) {
        if (m.material.group != group) continue;
        const std::string key = text(m.setting);
        const auto place = static_cast<std::size_t>(std::find(order.begin(), order.end(), key) - order.begin());
        if (place == order.size()) order.push_back(key), lists.emplace_back();
        lists[place].push_back(&m);
    }
    std::vector<SettingSummary> out;
    for (const auto& list : lists) {
        const SettingSummary s = summaryOf(list);
        const bool seen = std::any_of(out.begin(), out.end(), [&](const SettingSummary& o) {
            return o.setting.method == s.setting.method && o.bytes == s.bytes && o.fetches == s.fetches &&
                   o.l2 == s.l2 && o.l2High == s.l2High && o.materials == s.materials;
        });
        if (!seen) out.push_back(s);
    }
    return out;
}

}  // namespace nacre::bench
