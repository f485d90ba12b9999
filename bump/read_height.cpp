#include "bump/read_height.hpp"

#include <fmt/format.h>

#include <limits>

#include "core/error.hpp"

namespace nacre {

namespace {

void requireValid(const HeightOptions& o) {
    require(std::isfinite(o.scale) && o.scale != 0, "heights: scale must be finite and not 0");
    require(std::isfinite(o.texelSize) && o.texelSize > 0, "heights: texel size must be finite, > 0");
    require(!o.nodata || !std::isinf(*o.nodata), "heights: nodata must be finite or NaN");
    for (const char* known : {"auto", "r", "g", "b", "a", "y"})
        if (o.channel == known) return;
    throw std::invalid_argument(fmt::format("unknown channel '{}'; known: auto, r, g, b, a, y", o.channel));
}

bool same(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

std::string place(const Image& image, std::size_t i) {
    const auto width = static_cast<std::size_t>(image.width());
    return fmt::format("({}, {})", i % width, i / width);
}

/// \throws nacre::Error at the first texel whose colours differ
void requireGrey(const Image& image, const std::string& name) {
    const auto channels = static_cast<std::size_t>(image.channels());
    for (std::size_t i = 0; i < image.texelCount(); ++i) {
        const float* t = image.data().data() + i * channels;
        if (!same(t[0], t[1]) || !same(t[0], t[2]))
            throw Error(
                fmt::format("{}: expected one channel of heights, or R = G = B, found ({}, {}, {}) at texel {}: "
                            "--channel r, g, b, a or y (luminance) chooses",
                            name, t[0], t[1], t[2], place(image, i)));
    }
}

/// Index of the channel that holds the heights; −1: luminance.
int channelIndex(const Image& image, const std::string& name, std::string& channel) {
    static constexpr const char* kNames[] = {"Y", "Y and A", "R, G, B", "R, G, B, A"};
    const int channels = image.channels();
    if (channel == "auto") {
        if (channels >= 3) requireGrey(image, name);
        channel = channels >= 3 ? "r=g=b" : "y";
        return 0;
    }
    if (channel == "y") return channels >= 3 ? -1 : 0;
    if (channel == "a" && channels % 2 == 0) return channels - 1;
    if (channel != "a" && channels >= 3) return channel == "r" ? 0 : channel == "g" ? 1 : 2;
    throw Error(fmt::format("{}: expected channel {} (--channel), found {}", name, channel, kNames[channels - 1]));
}

Image chosenChannel(const ImageFile& file, const std::string& name, std::string& channel) {
    const int index = channelIndex(file.image, name, channel);
    Image out(file.image.width(), file.image.height(), 1);
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
            out.at(x, y, 0) =
                index < 0 ? static_cast<float>(luminance(file.image.rgb(x, y))) : file.image.at(x, y, index);
    return out;
}

/// Texels of either number become NaN.
void makeHoles(Image& values, HeightReport& report) {
    const auto isHole = [&](float v) {
        for (const auto& nodata : {report.nodata, report.fileNodata})
            if (nodata && same(v, static_cast<float>(*nodata))) return true;
        return false;
    };
    for (float& v : values.data()) {
        if (!isHole(v)) continue;
        v = std::numeric_limits<float>::quiet_NaN();
        ++report.holes;
    }
}

/// Before holes are made: what no nodata explains.
void requireHeights(const Image& values, const HeightReport& report) {
    const auto isNan = [](const std::optional<double>& v) { return v && std::isnan(*v); };
    const bool nanIsHole = isNan(report.nodata) || isNan(report.fileNodata);
    std::size_t count = 0, first = 0;
    for (std::size_t i = 0; i < values.data().size(); ++i) {
        const float v = values.data()[i];
        if (std::isinf(v) && !(report.fileNodata && v == static_cast<float>(*report.fileNodata)))
            throw Error(
                fmt::format("{}: expected finite heights, found infinity at texel {}", report.path, place(values, i)));
        if (std::isnan(v) && count++ == 0) first = i;
    }
    if (count > 0 && !nanIsHole)
        throw Error(
            fmt::format("{}: expected finite heights, found {} NaN, the first at texel {} (--nodata nan makes "
                        "holes of them)",
                        report.path, count, place(values, first)));
}

double unitOf(const std::string& sampleType) {
    return sampleType == "uint8" ? 1 / 255.0 : sampleType == "uint16" ? 1 / 65535.0 : 1;
}

}  // namespace

HeightField heightFromImage(const ImageFile& file, const std::string& name, const HeightOptions& options) {
    requireValid(options);
    HeightField out;
    HeightReport& r = out.report;
    r = {name, file.hash, file.format, file.sampleType, options.channel, file.image.width(), file.image.height()};
    r.unit = unitOf(file.sampleType);
    r.scale = options.scale;
    r.texelSize = options.texelSize;
    r.nodata = options.nodata;
    r.fileNodata = file.nodata;
    out.map = {chosenChannel(file, name, r.channel), options.wrap};
    requireHeights(out.map.heights, r);
    makeHoles(out.map.heights, r);
    if (r.holes == out.map.heights.texelCount())
        throw Error(fmt::format("{}: expected heights, found {} holes and nothing else", name, r.holes));
    r.file = heightRange(out.map);
    for (float& v : out.map.heights.data()) v = static_cast<float>(v * r.unit * r.scale / r.texelSize);
    for (std::size_t i = 0; i < out.map.heights.data().size(); ++i)
        if (std::isinf(out.map.heights.data()[i]))
            throw Error(
                fmt::format("{}: expected heights that times scale over texel size fit a float, found more at "
                            "texel {}",
                            name, place(out.map.heights, i)));
    return out;
}

HeightField readHeight(const std::filesystem::path& path, const HeightOptions& options) {
    requireValid(options);
    const ImageFile file = readImageFile(path, Samples::Codes);
    if (file.asset) throw Error(fmt::format("{}: expected a picture of heights, found a nacre asset", path.string()));
    return heightFromImage(file, path.string(), options);
}

nlohmann::json toJson(const HeightReport& r) {
    const auto number = [](const std::optional<double>& v) -> nlohmann::json {
        if (!v) return nullptr;
        if (std::isnan(*v)) return "nan";
        return *v;
    };
    return {{"path", r.path},
            {"hash", r.hash},
            {"format", r.format},
            {"sample_type", r.sampleType},
            {"channel", r.channel},
            {"width", r.width},
            {"height", r.height},
            {"file_range", {r.file.low, r.file.high}},
            {"unit", r.unit},
            {"scale", r.scale},
            {"texel_size", r.texelSize},
            {"holes", r.holes},
            {"nodata", number(r.nodata)},
            {"file_nodata", number(r.fileNodata)}};
}

HeightOptions heightOptionsFrom(const nlohmann::json& report, Wrap wrap) {
    HeightOptions options;
    options.scale = report.at("scale").get<double>();
    options.texelSize = report.at("texel_size").get<double>();
    options.wrap = wrap;
    if (const nlohmann::json& nodata = report.at("nodata"); !nodata.is_null())
        options.nodata = nodata.is_string() ? NAN : nodata.get<double>();
    options.channel = report.at("channel").get<std::string>();
    if (options.channel == "r=g=b") options.channel = "auto";
    return options;
}

}  // namespace nacre
