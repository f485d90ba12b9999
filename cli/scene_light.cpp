#include "cli/scene_light.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/output_file.hpp"
#include "cli/verb.hpp"
#include "reference/albedo.hpp"
#include "reference/scene_rays.hpp"
#include "reference/scene_truths.hpp"
#include "shading/multipass/quality.hpp"
#include "shading/multipass/radiosity.hpp"
#include "shading/multipass/specular_face.hpp"

namespace nacre::cli {

ShadowMethod shadowMethodOf(const std::string& text) {
    if (text == "maps") return ShadowMethod::Maps;
    if (text == "volumes") return ShadowMethod::Volumes;
    throw UsageError(fmt::format("expected maps, volumes, sampled-maps, sampled-volumes or sampled, found '{}'", text));
}

std::optional<SampledShadowMethod> sampledShadowsOf(const std::string& text) {
    if (text == "sampled-maps") return SampledShadowMethod::Maps;
    if (text == "sampled-volumes") return SampledShadowMethod::Volumes;
    if (text == "sampled") return SampledShadowMethod::Fastest;
    return std::nullopt;
}

SoftShadows softShadowsOf(const std::string& text) {
    if (text == "regenerated") return SoftShadows::Regenerated;
    if (text == "pivot") return SoftShadows::Pivot;
    if (text == "levels") return SoftShadows::Levels;
    throw UsageError(fmt::format("expected regenerated, pivot or levels, found '{}'", text));
}

int qualityOf(const std::string& text) {
    try {
        return qualityFromString(text);
    } catch (const std::invalid_argument& error) {
        throw UsageError(error.what());
    }
}

std::vector<std::string> lightNotes(const SceneDescription& scene, bool traced, bool maps) {
    const auto any = [&](bool area) {
        return std::any_of(scene.lights.begin(), scene.lights.end(),
                           [&](const SceneLight& light) { return light.shadow && (light.area || !area); });
    };
    std::vector<std::string> out;
    if (traced && any(false) && hasSpecular(scene))
        out.emplace_back("light by way of mirrors and panes is left out, of the reference too (--light-paths)");
    if (maps && any(true))
        out.emplace_back("shadow maps take lamps with an area as their middle, a reference has them soft (--shadows)");
    return out;
}

std::string notesText(const nlohmann::json& notes) {
    std::string out;
    for (const nlohmann::json& note : notes) out += fmt::format("note: {}\n", note.get<std::string>());
    return out;
}

std::string repeatedText(const nlohmann::json& data) {
    if (!data.contains("repeated")) return "";
    return fmt::format("drawn again: {:.2f} frames/s\n", data["repeated"]["frames_per_second"].get<double>());
}

nlohmann::json volumesJson(const ShadowVolumeCounts& c) {
    return {{"made", c.made},
            {"bytes", c.bytes},
            {"point_bytes", c.pointBytes},
            {"bytes_of_a_volume_a_polygon", c.bytesAPolygon}};
}

std::vector<Rgb> albedosOf(const SceneDescription& scene) {
    std::vector<Rgb> out;
    for (const MaterialTruth& m : openTruths(scene).materials)
        out.push_back(m.brdf ? glm::min(directionalAlbedo(m.brdf, {std::sqrt(0.5), 0, std::sqrt(0.5)}), Rgb(0.99))
                             : Rgb(0));
    return out;
}

nlohmann::json addRadiosity(SceneRenderer& renderer, double time, const Progress& progress) {
    const Stopwatch watch;
    const SceneDescription& scene = renderer.scene();
    const std::vector<Rgb> albedos = albedosOf(scene);
    const SceneRays rays(scene, nodeTransforms(scene, time));
    const Visible visible = [&](const Vec3& a, const Vec3& b) {
        const double length = glm::length(b - a);
        return !rays.shadowed(a, (b - a) / length, length);
    };
    const IndirectLight light = sceneIndirectLight(scene, time, albedos, visible, {.progress = progress});
    renderer.setIndirectLight(light.radiance);
    return {{"shots", light.shots}, {"left", light.left}, {"seconds", watch.seconds()}};
}

}  // namespace nacre::cli
