#include "tests/fuzz/targets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <string_view>

#include "bump/bump_lookup.hpp"
#include "cli/direction_lines.hpp"
#include "cli/eval_bump.hpp"
#include "cli/eval_environment.hpp"
#include "core/asset.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/image_file.hpp"
#include "core/png_scan.hpp"
#include "core/tiff_scan.hpp"
#include "envmaps/env_asset.hpp"
#include "envmaps/source.hpp"
#include "factorize/factored_brdf.hpp"
#include "factorize/measured/merl.hpp"
#include "factorize/measured/rgl.hpp"
#include "factorize/measured/samples.hpp"
#include "factorize/models/models.hpp"
#include "shading/gltf_scene.hpp"
#include "shading/iqm_file.hpp"
#include "shading/md2_frames.hpp"
#include "shading/scene_file.hpp"
#include "shading/volume_file.hpp"
#include "transfer/exitant_radiance.hpp"
#include "transfer/transfer_file.hpp"
#include "transfer/visible_sets.hpp"

namespace nacre::tests {

static const Vec3 kIn = sphericalDirection(0.6, 0.3), kOut = sphericalDirection(1.2, 2.0);

static void requireDefined(const Rgb& value, const char* what) {
    if (!isFinite(value)) throw std::logic_error(std::string(what) + ": f is not finite");
}

/// What the shaders' lookups make of maps that were read.
static void askBump(const BumpMaps& maps) {
    const double u = 0.3, v = -7.1;
    if (maps.ellipses || maps.horizons) litMargin(maps, u, v, kIn);
    if (maps.normals) requireDefined(normalAt(maps, u, v), "bump");
    if (maps.scatter && !std::isfinite(seenFrom(maps, u, v, kIn).uv.x)) throw std::logic_error("a point seen nowhere");
}

static void readAssetBytes(std::span<const std::uint8_t> bytes) {
    const Asset asset = parseAsset(bytes, "input");
    if (asset.kind == "environment") {
        const EnvChain chain = envFromAsset(asset, "input");
        requireDefined(sampleChain(chain, kOut, chain.mapping ? lodOf(*chain.mapping, 0.3) : 0), "environment");
        return;
    }
    if (asset.kind == "bump") return askBump(bumpFromAsset(asset, "input"));
    const FactoredBrdf brdf = factoredFromAsset(asset, "input");
    evaluate(brdf, kIn, kOut);
}

static void readMerlBytes(std::span<const std::uint8_t> bytes) {
    requireDefined(evaluate(parseMerl(bytes, "input"), kIn, kOut), "merl");
}

static void readRglBytes(std::span<const std::uint8_t> bytes) {
    requireDefined(evaluateRaw(parseRgl(bytes, "input"), kIn, kOut), "rgl");
}

static void readSamplesText(std::span<const std::uint8_t> bytes) {
    for (const BrdfSample& s :
         parseSamples({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "input").samples)
        requireDefined(s.f, "samples");
}

static void readModelText(std::span<const std::uint8_t> bytes) {
    const Reflectance model = makeModel(std::string(bytes.begin(), bytes.end()));
    requireDefined(model.f(kIn, kOut), model.source.c_str());
}

/// As a surrounding when it has the proportions of one; what comes out of the reader's rules is finite.
static void readAsMap(const ImageFile& file) {
    const Environment environment = environmentFromImage(file, "input");
    for (const float v : environment.map.image.data())
        if (!std::isfinite(v) || v < 0) throw std::logic_error("a texel that is no radiance");
}
static void readExrBytes(std::span<const std::uint8_t> bytes) { readAsMap(parseExrImage(bytes, "input")); }
static void readRadianceBytes(std::span<const std::uint8_t> bytes) { readAsMap(parseRadianceImage(bytes, "input")); }

static void readTiffBytes(std::span<const std::uint8_t> bytes) { scanTiff(bytes, "input"); }
static void readPngBytes(std::span<const std::uint8_t> bytes) { scanPng(bytes, "input"); }
static void readVolumeBytes(std::span<const std::uint8_t> bytes) {
    for (const float v : parseVolume(bytes, "input").values)
        if (!std::isfinite(v)) throw std::logic_error("a volume's value that isn't finite");
}

static void readTransferBytes(std::span<const std::uint8_t> bytes) {
    const TransferRecording r = parseTransfer(bytes, "input");
    const LightCoefficients light(r.coefficientCount(), Rgb(1));
    for (const TransferRecording::Frame& frame : r.frames) {
        const TransferRecording::Block& block = r.blocks.at(static_cast<std::size_t>(frame.block));
        if (exitantRadiance(block.coefficients, light).size() != block.positions.size())
            throw std::logic_error("a vertex without a colour");
    }
    for (const std::uint32_t v : r.weldOf) r.blocks.at(0).positions.at(v);
}

static void readVisibleBytes(std::span<const std::uint8_t> bytes) {
    const VisibleSets sets = parseVisibleSets(bytes, "input");
    for (const VisibleSets::Window& w : sets.windows)
        if (sets.at(w.first).size() != w.bits.size()) throw std::logic_error("a window without its set");
}

/// Scene files whose meshes are made by formula: the files that they name are not there.
static void readSceneText(std::span<const std::uint8_t> bytes) {
    SceneOptions options;
    options.needAssets = false;
    const SceneDescription scene = parseScene({reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                                              "/nowhere/to/be/found/scene.json", options);
    for (const double time : {0.0, 0.7})
        for (const Light& light : lightsInWorld(scene, nodeTransforms(scene, time)))
            if (std::isnan(light.position.x)) throw std::logic_error("a light nowhere");
    if (!isFinite(scene.camera.eye) || !(scene.camera.far > scene.camera.near))
        throw std::logic_error("a camera that sees nothing");
}

/// Our half of glTF: container, hierarchy, lights, cameras. Geometry is assimp's, and assimp is not tested here.
static void readGltfBytes(std::span<const std::uint8_t> bytes) {
    const GltfFile file = parseGltf(bytes, "input.glb");
    const GltfScene scene = gltfScene(file, {});
    nodeTransforms(scene.scene, 0);
    if (geometryOf(file).empty()) throw std::logic_error("no container");
}

/// One frame of each clip: the times themselves are checked whole.
static void readIqmBytes(std::span<const std::uint8_t> bytes) {
    Rig rig = parseIqm(bytes, "input");
    for (RigClip& clip : rig.clips) {
        clip.seconds = 0;
        animateRig(rig, &clip, 0, "input", {});
    }
}
static void readMd2Bytes(std::span<const std::uint8_t> bytes) {
    std::size_t next = 0;
    for (const Md2Clip& clip : md2Clips(bytes, "input")) {
        if (clip.first != next || clip.count == 0) throw std::logic_error("clips that leave frames out");
        next += clip.count;
    }
}

/// Feeds a reader of lines.
template <typename Reader, typename Item>
static void readLines(std::span<const std::uint8_t> bytes) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    Reader reader;
    std::vector<Item> items;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        reader.take(text.substr(0, end), items);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
}

const std::vector<FuzzTarget>& fuzzTargets() {
    static const std::vector<FuzzTarget> targets = {{"asset", readAssetBytes},
                                                    {"merl", readMerlBytes},
                                                    {"rgl", readRglBytes},
                                                    {"samples", readSamplesText},
                                                    {"model", readModelText},
                                                    {"directions", readLines<cli::DirectionReader, DirectionPair>},
                                                    {"exr", readExrBytes},
                                                    {"radiance", readRadianceBytes},
                                                    {"tiff", readTiffBytes},
                                                    {"png", readPngBytes},
                                                    {"volume", readVolumeBytes},
                                                    {"transfer", readTransferBytes},
                                                    {"visible", readVisibleBytes},
                                                    {"scene", readSceneText},
                                                    {"gltf", readGltfBytes},
                                                    {"iqm", readIqmBytes},
                                                    {"md2", readMd2Bytes},
                                                    {"env_queries", readLines<cli::EnvQueryReader, cli::EnvQuery>},
                                                    {"bump_queries", readLines<cli::BumpQueryReader, cli::BumpQuery>}};
    return targets;
}

void feed(const FuzzTarget& target, std::span<const std::uint8_t> bytes) {
    try {
        target.read(bytes);
    } catch (const Error&) {
    } catch (const std::invalid_argument&) {
    }
}

namespace {

/// The kinds of change. Positions and values come from the generator.
class Mutator {
public:
    Mutator(std::vector<std::uint8_t> bytes, std::uint64_t seed) : bytes_(std::move(bytes)), random_(seed) {}

    void change(const std::vector<std::uint8_t>& other) {
        switch (below(bytes_.empty() ? 1 : 8)) {
            case 0:
                insert({static_cast<std::uint8_t>(below(256))});
                break;
            case 1:
                bytes_[below(bytes_.size())] ^= static_cast<std::uint8_t>(1u << below(8));
                break;
            case 2:
                bytes_[below(bytes_.size())] = static_cast<std::uint8_t>(below(256));
                break;
            case 3:
                number();
                break;
            case 4:
                remove();
                break;
            case 5:
                insert(block(bytes_));
                break;
            case 6:
                insert(block(other));
                break;
            case 7:
                bytes_[below(bytes_.size())] = kText[below(kText.size())];
                break;
        }
    }
    std::vector<std::uint8_t> take() { return std::move(bytes_); }
    std::size_t below(std::size_t count) { return count ? random_() % count : 0; }

private:
    static constexpr std::string_view kText = "0123456789.,:=-+/e#\n\r nanif\"{}[]";
    static constexpr std::array<std::uint32_t, 8> kNumbers = {0,          1,          0xffffffff, 0x7fffffff,
                                                              0x80000000, 0x10000000, 0x7fc00000, 0x4000};
    static constexpr std::size_t kMaxBlock = 64;

    std::vector<std::uint8_t> block(const std::vector<std::uint8_t>& from) {
        if (from.empty()) return {};
        const std::size_t begin = below(from.size()), size = std::min(1 + below(kMaxBlock), from.size() - begin);
        const auto first = from.begin() + static_cast<std::ptrdiff_t>(begin);
        return {first, first + static_cast<std::ptrdiff_t>(size)};
    }
    void insert(const std::vector<std::uint8_t>& what) {
        const auto at = bytes_.begin() + static_cast<std::ptrdiff_t>(below(bytes_.size() + 1));
        bytes_.insert(at, what.begin(), what.end());
    }
    void remove() {
        const std::size_t begin = below(bytes_.size());
        // Now and then everything behind: a truncated file.
        const std::size_t size =
            below(16) ? std::min(1 + below(kMaxBlock), bytes_.size() - begin) : bytes_.size() - begin;
        const auto first = bytes_.begin() + static_cast<std::ptrdiff_t>(begin);
        bytes_.erase(first, first + static_cast<std::ptrdiff_t>(size));
    }
    void number() {
        const std::uint32_t value = kNumbers[below(kNumbers.size())];
        const std::size_t at = below(bytes_.size());
        for (std::size_t i = 0; i < 4 && at + i < bytes_.size(); ++i)
            bytes_[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
    }

    std::vector<std::uint8_t> bytes_;
    std::mt19937_64 random_;
};

}  // namespace

std::vector<std::uint8_t> mutated(const std::vector<std::uint8_t>& bytes, const std::vector<std::uint8_t>& other,
                                  std::uint64_t seed) {
    Mutator mutator(bytes, seed);
    for (std::size_t changes = 1 + mutator.below(4); changes > 0; --changes) mutator.change(other);
    return mutator.take();
}

std::vector<std::vector<std::uint8_t>> corpusOf(const std::string& folder, const std::string& name) {
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(folder) / name))
        paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<std::vector<std::uint8_t>> files;
    for (const auto& path : paths) files.push_back(readFile(path, 1 << 20));
    return files;
}

}  // namespace nacre::tests
