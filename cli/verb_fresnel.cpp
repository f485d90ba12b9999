// nacre fresnel: a one-dimensional table of the reflectance of an interface, or the scale-bias table of rough ones.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cli/numbers.hpp"
#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "cli/verb.hpp"
#include "core/asset.hpp"
#include "core/error.hpp"
#include "core/temporary_files.hpp"
#include "envmaps/fresnel_table.hpp"
#include "envmaps/scale_bias.hpp"
#include "reference/fresnel_error.hpp"

namespace nacre::cli {

using nlohmann::json;

namespace {

struct Settings {
    std::string output, eta, k, format = "half";
    int size = 0;  ///< 0 = 256, or what the budget asks for
    std::optional<double> maxError;
    std::optional<std::size_t> maxBytes;
    bool scaleBias = false, asJson = false;
};

/// One number or R/G/B.
Rgb parseColour(const std::string& flag, const std::string& given) {
    std::string text = given;
    std::replace(text.begin(), text.end(), '/', ',');
    std::array<double, 3> v{};
    if (parseNumbers(text, v)) return {v[0], v[1], v[2]};
    if (parseNumbers(text, {v.data(), 1})) return Rgb(v[0]);
    throw UsageError(fmt::format("{}: expected a number or R/G/B, found '{}'", flag, given));
}

struct Baked {
    AssetTexture texture;
    TableError error;
};

Baked bakeSize(const Settings& s, const FresnelIndex& index, int size) {
    const TexelFormat format = texelFormatFromString(s.format);
    Baked out{s.scaleBias ? bakeScaleBias(size, format) : bakeFresnelTable(index, size, format), {}};
    out.error = s.scaleBias ? measureScaleBias(out.texture) : measureFresnel(out.texture, index);
    return out;
}

/// The smallest power of two within the budget of error, or the largest within the one of bytes.
Baked bakeWithin(const Settings& s, const FresnelIndex& index) {
    if (!s.maxError && !s.maxBytes) return bakeSize(s, index, s.size ? s.size : s.scaleBias ? 32 : 256);
    const int largest = s.size ? s.size : s.scaleBias ? 256 : 4096;
    std::optional<Baked> last;
    for (int size = s.size && !s.maxError ? s.size : 4; size <= largest; size *= 2) {
        Baked baked = bakeSize(s, index, size);
        if (s.maxBytes && baked.texture.bytes() > *s.maxBytes) break;
        if (s.maxError && baked.error.maxAbs <= *s.maxError) return baked;
        last = std::move(baked);
    }
    if (!last)
        throw Error(fmt::format("{}: expected at most {} bytes, found more for the smallest table", s.output,
                                s.maxBytes.value_or(0)));
    if (s.maxError)
        throw Error(fmt::format("{}: expected an error <= {}, found {:.3g} with {} bytes", s.output, *s.maxError,
                                last->error.maxAbs, last->texture.bytes()));
    return std::move(*last);
}

void runFresnel(const Context& context, const Settings& s) {
    const std::filesystem::path provisional = provisionalName(s.output);
    const TemporaryFile removeLater(provisional);
    requireWritable({}, s.output, provisional);
    if (s.scaleBias && !(s.eta + s.k).empty()) throw UsageError("--eta, --k: --scale-bias doesn't take them");
    const FresnelIndex index{s.eta.empty() ? Rgb(1.5) : parseColour("--eta", s.eta),
                             s.k.empty() ? Rgb(0) : parseColour("--k", s.k)};
    const Stopwatch baking;
    const Baked baked = bakeWithin(s, index);
    Asset asset;
    asset.kind = s.scaleBias ? "scale_bias" : "fresnel";
    asset.textures.push_back(baked.texture);
    if (!s.scaleBias) {
        asset.meta["eta"] = {index.eta.x, index.eta.y, index.eta.z};
        asset.meta["k"] = {index.k.x, index.k.y, index.k.z};
    }
    asset.meta["format"] = s.format;
    asset.meta["fetches"] = 1;
    asset.meta["size"] = baked.texture.image.width();
    asset.meta["command_line"] = context.commandLine;
    asset.meta["seconds"] = baking.seconds();
    asset.meta["error"] = {{"max_abs", baked.error.maxAbs}, {"rms", baked.error.rms}, {"samples", baked.error.samples}};
    writeAsset(asset, s.output);
    const json meta = readAsset(s.output).meta;
    putData(s.asJson ? meta.dump(2) + "\n"
                     : fmt::format("{}: {} of {} texels, {}, 1 fetch\nmax_abs {:.2g}  rms {:.2g}\n", s.output,
                                   asset.kind, baked.texture.image.texelCount(), humanBytes(baked.texture.bytes()),
                                   baked.error.maxAbs, baked.error.rms));
}

}  // namespace

Verb fresnelVerb(Context& context) {
    const auto s = std::make_shared<Settings>();
    Verb verb{"fresnel", "Bake a Fresnel table F(cos), or scale and bias of rough surfaces", {}, {}, {}};
    verb.details =
        "The table is looked up at sqrt(cos): u = (sqrt(cos) (N - 1) + 0.5) / N. eta and k may be R/G/B, for instance "
        "gold\n"
        "--eta 0.18/0.42/1.37 --k 3.42/2.35/1.77. With --scale-bias the reflectance of GGX under white light is\n"
        "f0 scale + bias, over (sqrt(n.v), sqrt(alpha)). The error is against another formula, at 2000 angles.";
    verb.options = {
        {"-o,--output", "OUT.exr", "The asset to write", into(s->output), true},
        {"--eta", "N", "Index of refraction, > 0 (default 1.5)", into(s->eta)},
        {"--k", "K", "Absorption of a conductor, >= 0 (default 0: a dielectric)", into(s->k)},
        {"--scale-bias", "", "The table of rough surfaces instead", into(s->scaleBias)},
        {"--size", "N", "Texels (default 256; scale-bias: an edge, default 32)",
         integerInto([s](long long v) { s->size = static_cast<int>(v); }, 2, 4096)},
        {"--format", "NAME", "Storage (default half)", into(s->format), false, {"half", "float", "unorm8"}},
        {"--max-error", "E", "Budget: largest absolute error", positiveInto([s](double v) { s->maxError = v; })},
        {"--max-bytes", "B", "Budget: bytes",
         integerInto([s](long long v) { s->maxBytes = static_cast<std::size_t>(v); }, 1, 1ll << 40)},
        {"--json", "", "One JSON object on standard output", into(s->asJson)}};
    verb.run = [s, &context] { runFresnel(context, *s); };
    return verb;
}

}  // namespace nacre::cli
