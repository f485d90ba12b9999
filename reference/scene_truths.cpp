#include "reference/scene_truths.hpp"

#include <fmt/format.h>

#include <map>

#include "bump/bump_asset.hpp"
#include "bump/read_height.hpp"
#include "core/error.hpp"
#include "envmaps/env_asset.hpp"
#include "envmaps/fresnel_table.hpp"
#include "envmaps/scale_bias.hpp"
#include "envmaps/source.hpp"
#include "factorize/factored_brdf.hpp"
#include "reference/factored_metrics.hpp"
#include "reference/lobe_table.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using Radiance = std::shared_ptr<const EnvMap>;

constexpr int kBlockedSize = 64;  // rows of what is subtracted where the surrounding is blocked

RadianceByDirection lookup(Radiance map, const Rgb& color) {
    return [map = std::move(map), color](const Vec3& d) { return color * sampleEnv(*map, d); };
}

struct OpenEnvironment {
    Radiance source, blocked;
    std::shared_ptr<const BrightTexels> bright;
    std::vector<Lobe> lobes;  ///< one a level
    std::optional<LevelMapping> mapping;
    std::map<double, Radiance> tables;        ///< by lod
    std::shared_ptr<const EnvChain> standIn;  ///< the baked one, without a source
};

class Opener {
public:
    Opener(const SceneDescription& scene, unsigned threads, const Progress& progress)
        : scene_(scene), threads_(threads), progress_(progress) {}

    SceneTruths open() {
        for (const SceneMaterial& m : scene_.materials) {
            MaterialTruth truth;
            if (!m.model.empty()) truth.brdf = truthOf(openReflectance(m.model));
            if (m.brdf >= 0) openBrdf(m.brdf, truth);
            if (m.relief) truth.relief = openRelief(m.relief->asset);
            if (m.surrounding) openSurrounding(*m.surrounding, truth);
            out_.materials.push_back(std::move(truth));
        }
        if (scene_.sky.asset >= 0) out_.sky = radianceOf({scene_.sky.asset, scene_.sky.lod, Rgb(1)});
        return std::move(out_);
    }

private:
    const SceneAsset& entry(int index) const { return scene_.assets.at(static_cast<std::size_t>(index)); }
    const Asset& asset(int index) {
        const auto known = assets_.find(index);
        if (known != assets_.end()) return known->second;
        return assets_.emplace(index, readAsset(entry(index).file)).first->second;
    }
    std::string sourceOf(int index) {
        if (!entry(index).source.empty()) return entry(index).source;
        const json& meta = asset(index).meta;
        const auto source = meta.find("source");
        return source != meta.end() && source->is_string() ? source->get<std::string>() : std::string();
    }
    void note(int index, const std::string& text) {
        const std::string line = fmt::format("asset '{}': {}", entry(index).name, text);
        if (std::find(out_.notes.begin(), out_.notes.end(), line) == out_.notes.end()) out_.notes.push_back(line);
    }

    void openBrdf(int index, MaterialTruth& truth) {
        report(progress_, "opening " + entry(index).name, 0);
        const auto baked = std::make_shared<const FactoredBrdf>(factoredFromAsset(asset(index), entry(index).file));
        truth.bakedBrdf = [baked](const Vec3& wi, const Vec3& wo) { return evaluate(*baked, wi, wo); };
        const std::string source = sourceOf(index);
        if (source.empty()) {
            note(index, "has no source: the baked BRDF stands in for the truth");
            truth.brdf = truth.bakedBrdf;
            return;
        }
        truth.brdf = truthOf(openReflectance(source));
    }

    std::shared_ptr<const ReliefTruth> openRelief(int index) {
        std::shared_ptr<const ReliefTruth>& kept = reliefs_[index];
        if (kept) return kept;
        const std::string file = entry(index).file.string();
        const BumpMaps maps = bumpFromAsset(asset(index), file);
        if (maps.heights) return kept = std::make_shared<const ReliefTruth>(HeightMap{*maps.heights, maps.wrap});
        const std::string source = sourceOf(index);
        if (source.empty()) throw Error(fmt::format("{}: expected heights or a source, found neither", file));
        HeightOptions options;
        try {
            options = heightOptionsFrom(asset(index).meta.at("input"), maps.wrap);
        } catch (const json::exception& error) {
            throw Error(
                fmt::format("{}: expected 'input' to say how {} is read, found {}", file, source, error.what()));
        }
        return kept = std::make_shared<const ReliefTruth>(readHeight(source, options).map);
    }

    /// How a level was filtered; none said: a mirror.
    static Lobe lobeFrom(const json& level, const std::string& file) {
        try {
            Lobe lobe;
            lobe.kind = lobeKindFromString(level.at("lobe").get<std::string>());
            lobe.exponent = level.value("exponent", 0.0);
            lobe.alpha = level.value("alpha", 0.0);
            lobe.ior = level.value("ior", 1.0);
            lobe.alphaY = level.value("alpha_y", 0.0);
            if (const auto axis = level.find("axis"); axis != level.end())
                lobe.axis = {axis->at(0).get<double>(), axis->at(1).get<double>(), axis->at(2).get<double>()};
            validateLobe(lobe);
            return lobe;
        } catch (const std::exception& error) {
            throw Error(fmt::format("{}: expected lobes with their kind and parameters, found {}", file, error.what()));
        }
    }

    OpenEnvironment& environment(int index) {
        const auto known = environments_.find(index);
        if (known != environments_.end()) return known->second;
        report(progress_, "opening " + entry(index).name, 0);
        const std::string file = entry(index).file.string();
        const json& meta = asset(index).meta;
        EnvChain chain = envFromAsset(asset(index), file);
        OpenEnvironment out;
        out.mapping = chain.mapping;
        const std::string source = sourceOf(index);
        const auto lobes = meta.find("lobes");
        if (source.empty()) {
            note(index, "has no source: the baked map stands in for the truth");
            out.lobes.assign(chain.levels.size(), Lobe{});
            out.source = std::make_shared<const EnvMap>(chain.levels.front());
            out.standIn = std::make_shared<const EnvChain>(std::move(chain));
        } else {
            SourceOptions options;
            try {
                options = sourceOptionsFrom(meta.at("input"));
            } catch (const json::exception& error) {
                throw Error(
                    fmt::format("{}: expected 'input' to say how {} is read, found {}", file, source, error.what()));
            }
            options.threads = threads_;
            out.source = std::make_shared<const EnvMap>(readEnvironment(source, options).map);
            if (lobes != meta.end() && lobes->is_array())
                for (const json& level : *lobes) out.lobes.push_back(lobeFrom(level, file));
            if (out.lobes.empty()) out.lobes.assign(chain.levels.size(), Lobe{});
        }
        out.blocked = std::make_shared<const EnvMap>(areaAveraged(*out.source, kBlockedSize, threads_));
        out.bright = std::make_shared<const BrightTexels>(*out.blocked);
        return environments_.emplace(index, std::move(out)).first->second;
    }

    /// The lobe of a lod: between two levels that of the parameter between.
    static Lobe lobeAt(const OpenEnvironment& env, double lod) {
        const double last = static_cast<double>(env.lobes.size() - 1), at = std::clamp(lod, 0.0, last);
        const Lobe low = env.lobes[static_cast<std::size_t>(at)];
        if (at == std::floor(at) || !env.mapping) return low;
        Lobe lobe = env.lobes[static_cast<std::size_t>(at) + 1];  // never the mirror, which comes first
        (lobe.kind == LobeKind::Phong ? lobe.exponent : lobe.alpha) = valueOf(*env.mapping, at);
        return lobe;
    }

    RadianceByDirection radianceOf(const SceneLookup& l) {
        OpenEnvironment& env = environment(l.asset);
        if (env.standIn)
            return [chain = env.standIn, lod = l.lod, color = l.color](const Vec3& d) {
                return color * sampleChain(*chain, d, lod);
            };
        const Lobe lobe = lobeAt(env, l.lod);
        if (isMirror(lobe)) return lookup(env.source, l.color);
        Radiance& table = env.tables[l.lod];
        if (!table) {
            LobeTableOptions options;
            options.threads = threads_;
            options.progress = progress_;
            if (const double n = lobeTableResolution(lobe, options); n < 3)
                note(l.asset, fmt::format("its lobe spans {:.1f} texels of the reference's table: too few", n));
            table = std::make_shared<const EnvMap>(tabulateLobe(*env.source, lobe, options));
        }
        return lookup(table, l.color);
    }

    std::function<Rgb(double)> weightOf(const SceneSurrounding& s) {
        if (s.table < 0) return {};
        const Asset& table = asset(s.table);
        if (table.kind == "fresnel") {
            const auto three = [&](const char* key) {
                const json& v = table.meta.at(key);
                return Rgb(v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>());
            };
            if (!table.meta.contains("eta")) {
                note(s.table, "doesn't say its index: the table stands in for the truth");
                return [texture = table.texture("fresnel")](double c) { return lookupFresnel(texture, c); };
            }
            return [index = FresnelIndex{three("eta"), three("k")}](double c) { return fresnelExact(index, c); };
        }
        static constexpr int kAngles = 1024;
        const double alpha = std::clamp(sqr(s.perceptualRoughness), 1e-4, 1.0);
        const auto sums = std::make_shared<std::vector<ScaleBias>>();
        for (int i = 0; i < kAngles; ++i)  // even in √cos, as the tables are
            sums->push_back(integrateScaleBias(std::max(1e-4, sqr(i / (kAngles - 1.0))), alpha));
        return [sums, f0 = s.f0, multiple = s.multipleScattering](double c) {
            const double at = std::sqrt(clamp01(c)) * (kAngles - 1), fraction = at - std::floor(at);
            const auto low = static_cast<std::size_t>(at), high = std::min<std::size_t>(low + 1, kAngles - 1);
            const ScaleBias a = (*sums)[low], b = (*sums)[high];
            const ScaleBias mixed{a.scale + fraction * (b.scale - a.scale), a.bias + fraction * (b.bias - a.bias)};
            return multiple ? multipleScattering(f0, mixed) : f0 * mixed.scale + Rgb(mixed.bias);
        };
    }

    void openSurrounding(const SceneSurrounding& s, MaterialTruth& truth) {
        SurroundedSurface& out = truth.surrounding;
        out.ior = s.ior;
        out.blend = s.blend;
        out.weight = weightOf(s);
        if (s.reflection.asset >= 0) {
            out.reflection = radianceOf(s.reflection);
            const OpenEnvironment& env = environment(s.reflection.asset);
            truth.reflectionLobe = lobeAt(env, s.reflection.lod);
            truth.reflectionSource =
                lookup(isMirror(truth.reflectionLobe) ? env.source : env.blocked, s.reflection.color);
        }
        if (s.transmission.asset >= 0) out.transmission = radianceOf(s.transmission);
        if (s.diffuse.asset >= 0) {
            out.diffuse = radianceOf(s.diffuse);
            truth.diffuseSource = environment(s.diffuse.asset).bright;
            truth.diffuseColor = s.diffuse.color;
        }
    }

    const SceneDescription& scene_;
    unsigned threads_;
    const Progress& progress_;
    SceneTruths out_;
    std::map<int, Asset> assets_;
    std::map<int, std::shared_ptr<const ReliefTruth>> reliefs_;
    std::map<int, OpenEnvironment> environments_;
};

}  // namespace

SceneTruths openTruths(const SceneDescription& scene, unsigned threads, const Progress& progress) {
    return Opener(scene, threads, progress).open();
}

}  // namespace nacre
