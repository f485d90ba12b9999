#include "shading/multipass/light_passes.hpp"

#include <algorithm>
#include <array>

#include "shading/pass_state.hpp"

namespace nacre {

LightPasses::LightPasses(ProgramLoader& loader, SceneShadowVolumes& volumes, const SceneSwitches& on,
                         const std::vector<ShadowedLamp>& lamps, const std::vector<SpecularFace>& faces,
                         const std::vector<ScheduledLight>& lights, const std::vector<glm::dmat4>& nodes)
    : volumes_(volumes), soft_(on.softShadows), lamps_(lamps), lights_(lights), stencil_(loader) {
    std::vector<ShadowSource> sources;
    for (const ScheduledLight& light : lights) {
        firstSource_.push_back(sources.size());
        const ShadowedLamp& lamp = lampOf(light.light);
        const std::size_t stored = soft_ == SoftShadows::Pivot ? 1 : lamp.points.size();
        if (light.image)
            for (std::size_t i = 0; i < light.image->stages.size(); ++i)
                sources.push_back(sourceOf(*light.image, i, faces));
        else
            for (std::size_t k = 0; k < stored; ++k) sources.push_back(sourceOf(lamp, k));
    }
    volumes.update(nodes, sources);
    for (std::size_t l = 0; l < lights.size(); ++l) {
        lightVolumes_.emplace_back();
        if (!lights[l].image) continue;
        const VirtualLight& image = *lights[l].image;
        for (std::size_t i = 0; i < image.bounces.size(); ++i)
            lightVolumes_.back().push_back(volumes.ofFace(faces[static_cast<std::size_t>(image.bounces[i].face)].node,
                                                          sources[firstSource_[l] + i]));
    }
    volumes.forgetUnused();
}

const ShadowedLamp& LightPasses::lampOf(std::size_t light) const {
    return *std::find_if(lamps_.begin(), lamps_.end(), [&](const ShadowedLamp& lamp) { return lamp.light == light; });
}

void LightPasses::add(const LitTarget& to, std::size_t light) {
    const ScheduledLight& l = lights_[light];
    const ShadowedLamp& lamp = lampOf(l.light);
    if (l.image)
        addImage(to, *l.image, light);
    else if (soft_ == SoftShadows::Levels && lamp.points.size() > 1 && to.level == 0)
        addLevels(to, lamp, firstSource_[light]);
    else
        addPoints(to, lamp, firstSource_[light]);
}

void LightPasses::addPoints(const LitTarget& to, const ShadowedLamp& lamp, std::size_t first) {
    for (std::size_t k = 0; k < lamp.points.size(); ++k) {
        const Light& point = lamp.points[k];
        stencil_.begin(to.target, to.level);
        stencil_.lit();
        to.draw(lamp.light, point, nullptr, false);
        stencil_.count(to.target, volumes_.of(first + (soft_ == SoftShadows::Pivot ? 0 : k)), homogeneous(point),
                       to.sight);
        stencil_.lit();
        to.draw(lamp.light, point, nullptr, true);
        stencil_.end(to.target);
    }
}

void LightPasses::addLevels(const LitTarget& to, const ShadowedLamp& lamp, std::size_t first) {
    stencil_.begin(to.target, to.level);
    stencil_.lit();
    to.draw(lamp.light, lamp.middle, nullptr, false);
    for (std::size_t k = 0; k < lamp.points.size(); ++k)
        stencil_.count(to.target, volumes_.of(first + k), homogeneous(lamp.points[k]), to.sight, ShadowCounting::Auto,
                       true);
    const std::size_t count = lamp.points.size();
    for (std::size_t level = 0; level < count; ++level) {
        Light dimmed = lamp.middle;
        dimmed.color *= static_cast<double>(count - level) / static_cast<double>(count);
        stencil_.lit(static_cast<unsigned>(level));
        to.draw(lamp.light, dimmed, nullptr, true);
    }
    stencil_.end(to.target);
}

void LightPasses::addImage(const LitTarget& to, const VirtualLight& image, std::size_t light) {
    const auto& narrowing = lightVolumes_[light];
    if (std::any_of(narrowing.begin(), narrowing.end(), [](const auto& volume) { return !volume; })) return;
    const Vec4 source = image.stages.back().source;
    const Light value = lightOf(image);
    stencil_.begin(to.target, to.level);
    for (const auto& volume : narrowing) stencil_.narrow(to.target, *volume, source, to.sight);
    stencil_.lit();
    to.draw(image.light, value, &image, false);
    for (std::size_t i = 0; i < image.stages.size(); ++i)
        stencil_.count(to.target, volumes_.of(firstSource_[light] + i), source, to.sight);
    stencil_.lit();
    to.draw(image.light, value, &image, true);
    stencil_.end(to.target);
}

bool needsLightPath(const VirtualLight& image) {
    return !image.weighed.empty() || (!image.seen.directional && (isRefracted(image) || image.shear >= 0));
}

ShaderDefines lightPathDefines(const VirtualLight& image) {
    ShaderDefines out;
    if (needsLightPath(image)) out.emplace_back("NACRE_LIGHT_PATH", std::to_string(image.weighed.size()));
    if (!image.images.empty()) out.emplace_back("NACRE_PATH_IMAGES", std::to_string(image.images.size()));
    return out;
}

static void setPathImages(const Program& program, const VirtualLight& image) {
    std::array<glm::mat4, kMostLightBounces> places{};
    std::array<glm::vec4, kMostLightBounces> rects{}, uses{};
    for (std::size_t i = 0; i < image.images.size(); ++i) {
        places[i] = glm::mat4(image.images[i].place);
        rects[i] = image.images[i].rect;
        uses[i] = {image.images[i].filters ? 1 : 0, static_cast<float>(image.images[i].surface), 0, 0};
    }
    program.set("nacre_path_place", places);
    program.set("nacre_path_rect", rects);
    program.set("nacre_path_use", uses);
    program.set("nacre_face_images", kFaceImagesUnit);
}

void setLightPath(const Program& program, const VirtualLight& image) {
    if (!image.images.empty()) setPathImages(program, image);
    if (!needsLightPath(image)) return;
    std::array<glm::mat4, kMostLightBounces> turns{};
    std::array<glm::vec4, kMostLightBounces> faces{};
    for (std::size_t i = 0; i < image.weighed.size(); ++i) {
        turns[i] = glm::mat4(glm::mat3(image.weighed[i].turn));
        faces[i] = glm::vec4(Vec4(image.weighed[i].normal, image.weighed[i].index));
    }
    program.set("nacre_path_to_lamp", glm::mat3(image.toLamp));
    program.set("nacre_path_turn", turns);
    program.set("nacre_path_face", faces);
}

Light lightOf(const VirtualLight& image) {
    Light out = image.seen;
    if (out.cone && !needsLightPath(image)) out.cone->axis = glm::transpose(image.toLamp) * out.cone->axis;
    return out;
}

}  // namespace nacre
