#include "shading/scene_renderer.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"
#include "shading/environment_pass.hpp"
#include "shading/multipass/light_passes.hpp"
#include "shading/multipass/pass_runner.hpp"
#include "shading/pass_state.hpp"
#include "shading/scene_objects.hpp"
#include "shading/scene_shadow_maps.hpp"

namespace nacre {
namespace {

/// One node of a frame.
struct Draw {
    std::size_t node = 0;
    double nearest = 0;  ///< depth of the nearest point of its bounding sphere
};

/// Of a share that isn't the first: the light of lamps whose shadows are counted, on black.
SceneSwitches sharedAlone(SceneSwitches on) {
    on.lamps = on.lamps && countsShadows(on);
    on.ambient = on.surrounding = on.sky = false;
    return on;
}

}  // namespace

struct SceneRenderer::State {
    ProgramLoader& loader;
    SceneObjects objects;
    SceneShadowMaps shadowMaps;
    std::optional<SceneShadowVolumes> shadowVolumes;  ///< with ShadowMethod::Volumes
    PassClock clock;
    bool timing = false;
    PassSchedule schedule;  ///< of the last frame

    State(ProgramLoader& programs, SceneDescription&& description)
        : loader(programs), objects(programs, std::move(description)) {}

    const SceneDescription& scene() const { return objects.scene(); }

    /// Draws the maps of lights that moved, or whose casters did.
    void updateShadows(const Camera& camera, double aspect, const std::vector<glm::dmat4>& nodes,
                       const std::vector<Light>& lights) {
        ShadowScene drawn;
        drawn.camera = &camera;
        drawn.aspect = aspect;
        drawn.bounds = objects.box(nodes);
        for (std::size_t i = 0; i < scene().nodes.size(); ++i) {
            if (!scene().nodes[i].castsShadow) continue;
            if (const std::optional<VolumeSurface> volume = objects.volumeOf(i, nodes[i]))
                drawn.volumes.push_back(*volume);
            if (const DrawnMesh* mesh = objects.meshOf(i)) drawn.casters.push_back({&*mesh->gpu, nodes[i]});
        }
        shadowMaps.update(loader, scene().lights, lights, drawn);
    }

    /// Those in use, one a light or none; for nodes that receive shadows.
    std::vector<const ShadowMap*> shadowsOf(const SceneSwitches& on) const {
        if (!mapsShadows(on) || on.reflectance == SceneReflectance::FastPhong) return {};
        return shadowMaps.maps();
    }

    /// What a frame's views have in common.
    struct Frame {
        const SceneSwitches& on;
        const Camera& camera;
        std::vector<glm::dmat4> nodes;
        std::vector<Light> lights;
        std::vector<const ShadowMap*> shadows{};
        ShaderDefines shadowDefines{}, viewDefines{};
        /// AddLight: on nodes that take lamps, and receive shadows or not as `receivers` says.
        DrawMode mode = DrawMode::Fill;
        bool receivers = true;
        const VirtualLight* image = nullptr;  ///< what is added is the light of
    };

    Frame frameOf(const SceneSwitches& on, const Camera& camera, const std::vector<glm::dmat4>& nodes,
                  const std::vector<Light>& lights) const {
        Frame out{on, camera, nodes, lights};
        out.shadows = shadowsOf(on);
        out.shadowDefines = shadowDefines(out.shadows, lights);
        if (on.shadows && on.shadowMethod == ShadowMethod::Levels && on.lightLevels != 0)
            out.shadowDefines.emplace_back("NACRE_LIGHT_LEVELS", "1");
        out.viewDefines = nacre::viewDefines(scene());
        return out;
    }

    /// The nodes with meshes that a view may see. Front to back: what is hidden is rejected before it is shaded.
    std::vector<Draw> drawsOf(const Frame& frame, const ScheduledView& view, const RenderTarget& target) const {
        // Rounding may leave the face that the view is seen through in front of itself.
        const std::size_t own =
            view.face < 0 ? scene().nodes.size() : schedule.faces[static_cast<std::size_t>(view.face)].node;
        std::vector<Draw> draws;
        for (std::size_t i = 0; i < scene().nodes.size(); ++i) {
            const DrawnMesh* mesh = objects.meshOf(i);
            if (!mesh || i == own) continue;
            const bool added = takesLamps(scene(), objects.materialOf(i), frame.on) &&
                               scene().nodes[i].receivesShadow == frame.receivers;
            if (frame.mode == DrawMode::AddLight && !added) continue;
            const glm::dmat3 m(frame.nodes[i]);
            const double scale =
                std::sqrt(std::max({glm::dot(m[0], m[0]), glm::dot(m[1], m[1]), glm::dot(m[2], m[2])}));
            const Vec3 centre(frame.nodes[i] * Vec4(mesh->centre, 1));
            if (!maySee(view, target.width(), target.height(), centre, scale * mesh->radius)) continue;
            draws.push_back({i, nearestDepth(view.view, centre, scale * mesh->radius)});
        }
        std::stable_sort(draws.begin(), draws.end(),
                         [](const Draw& a, const Draw& b) { return a.nearest < b.nearest; });
        return draws;
    }

    static ShaderDefines viewDefinesOf(const Frame& frame, const ScheduledView& view) {
        return joined(frame.viewDefines, viewDefines(view.light));
    }

    /// What of all light a node gives is its own: of specular faces not all.
    double ownShare(std::size_t node) const {
        const std::optional<SceneSpecular>& specular = objects.materialOf(node).specular;
        return specular ? specular->surface : 1;
    }

    void drawNodes(const Frame& frame, const ScheduledView& view, const RenderTarget& target) {
        LitView lit{frame.camera, frame.lights};
        const Program* program = nullptr;
        int material = -1;
        for (const Draw& draw : drawsOf(frame, view, target)) {
            const SceneMaterial& m = objects.materialOf(draw.node);
            const GpuMesh& mesh = *objects.meshOf(draw.node)->gpu;
            const double share = ownShare(draw.node);
            if (share == 0) {
                drawFace(loader, view, {&mesh, frame.nodes[draw.node]});
                program = nullptr;
                continue;
            }
            const bool shadowed = scene().nodes[draw.node].receivesShadow;
            SceneProgram wanted = materialProgram(scene(), m, objects.traits(), frame.on,
                                                  shadowed ? frame.shadowDefines : ShaderDefines());
            const Buffer* radiance = objects.radianceOf(draw.node);
            const bool brings = frame.on.ambient && radiance && wanted.fragment == "scene().frag.glsl";
            if (brings) wanted.defines.emplace_back("NACRE_VERTEX_RADIANCE", "1");
            if (frame.image) wanted.defines = joined(std::move(wanted.defines), lightPathDefines(*frame.image));
            const Program& next = loader.load(wanted.vertex, wanted.fragment,
                                              joined(std::move(wanted.defines), viewDefinesOf(frame, view)));
            const bool own = objects.hasNodeLight(draw.node);  // its texture is the node's, not the material's
            if (&next != program || material != scene().nodes[draw.node].material || own) {
                lit.ambient = frame.on.ambient ? m.ambient : Rgb(0);
                lit.shadows =
                    shadowed && takesLamps(scene(), m, frame.on) ? frame.shadows : std::vector<const ShadowMap*>();
                objects.bindMaterial(next, draw.node, frame.on, lit);
                if (shadowed && frame.on.shadowMethod == ShadowMethod::Levels)
                    bindLightLevels(next, frame.on.lightLevels);
                if (frame.image) setLightPath(next, *frame.image);
                setView(next, view.view, view.light, share);
                program = &next;
                material = own ? -1 : scene().nodes[draw.node].material;
            }
            drawPlaced(next, mesh, frame.nodes[draw.node], view.view.mirrored, brings ? radiance : nullptr);
        }
    }

    void drawDepths(const Frame& frame, const ScheduledView& view, const RenderTarget& target) {
        for (const Draw& draw : drawsOf(frame, view, target))
            drawFace(loader, view, {&*objects.meshOf(draw.node)->gpu, frame.nodes[draw.node]});
    }

    /// After the meshes, whose depths hide what is behind them.
    void drawVolumes(const Frame& frame, const ScheduledView& view) {
        const SceneSwitches on = volumeSwitches(frame.on);
        const std::vector<const ShadowMap*> shadows = shadowsOf(on);
        const ShaderDefines defines = shadowDefines(shadows, frame.lights);
        for (std::size_t i = 0; i < scene().nodes.size(); ++i) {
            const std::optional<VolumeSurface> surface = objects.volumeOf(i, frame.nodes[i]);
            if (!surface) continue;
            const SceneMaterial& m = objects.materialOf(i);
            const bool shadowed = scene().nodes[i].receivesShadow && takesLamps(scene(), m, on);
            SceneProgram wanted =
                volumeProgram(scene(), scene().volumes[static_cast<std::size_t>(scene().nodes[i].volume)], m,
                              objects.traits(), on, shadowed ? defines : ShaderDefines());
            const Program& program = loader.load(wanted.vertex, wanted.fragment,
                                                 joined(std::move(wanted.defines), viewDefinesOf(frame, view)));
            LitView lit{frame.camera, frame.lights};
            lit.ambient = on.ambient ? m.ambient : Rgb(0);
            if (shadowed) lit.shadows = shadows;
            objects.bindMaterial(program, i, on, lit);
            drawVolume(program, *surface, view.view, view.light);
        }
    }

    void drawBackground(const Frame& frame, const ScheduledView& view) {
        if (scene().sky.asset >= 0)
            return drawSky(loader, view.view,
                           {&objects.asset(scene().sky.asset).environment.value(), scene().sky.lod, Rgb(1)},
                           objects.worldToSky(), view.light, viewDefinesOf(frame, view));
        const Program& program = loader.load("sky.vert.glsl", "background.frag.glsl", viewDefinesOf(frame, view));
        setView(program, view.view, view.light);
        program.set("nacre_clip_to_world", glm::mat4(glm::inverse(view.view.toClip)));
        program.set("nacre_background", glm::vec3(scene().sky.color));
        program.use();
        drawFullscreen(VertexArray());
    }

    /// One of the schedule's lights, where the stencil lets it.
    void addLight(const Frame& of, const ScheduledView& view, const RenderTarget& target, LightPasses& passes,
                  std::size_t added) {
        SceneSwitches on = of.on;
        on.ambient = on.surrounding = false;
        on.indirect = on.indirect && !schedule.lights[added].image;  // reliefs' bounced light is of the lamp itself
        ScheduledView seen = view;
        seen.light.fog = Rgb(0);  // drawn already
        const LampDrawer draw = [&](std::size_t light, const Light& value, const VirtualLight* image, bool receivers) {
            std::vector<Light> alone = of.lights;
            for (Light& other : alone) other.color = Rgb(0);
            alone[light] = value;
            Frame frame = frameOf(on, of.camera, of.nodes, alone);
            frame.shadows.clear();
            frame.shadowDefines.clear();
            frame.mode = DrawMode::AddLight;
            frame.receivers = receivers;
            frame.image = image;
            setAddLight(view.weighted);
            if (!schedule.faces.empty()) glEnable(GL_CLIP_DISTANCE0);
            drawNodes(frame, seen, target);
            setDrawState(target);
        };
        const double aspect = static_cast<double>(target.width()) / target.height();
        const ShadowSight sight = view.level == 0 ? ShadowSight::of(of.camera, aspect) : ShadowSight::of(view.view);
        passes.add({target, sight, view.level, draw}, added);
    }

    void drawPart(const Frame& frame, const ScheduledView& view, SurfacePart part, const RenderTarget& target) {
        if (part == SurfacePart::Background) {
            // Else: what the target, or the face, was cleared to.
            const bool there = scene().sky.asset >= 0 || scene().sky.color != Rgb(0) || view.light.fogDistance > 0;
            if (frame.on.sky && there && (view.level > 0 || scene().sky.asset >= 0))
                clock("sky", [&] { drawBackground(frame, view); });
            return;
        }
        clock("surfaces",
              [&] { part == SurfacePart::Depth ? drawDepths(frame, view, target) : drawNodes(frame, view, target); });
        if (objects.hasVolumes()) clock("volumes", [&] { drawVolumes(frame, view); });
    }

    void render(const RenderTarget& target, const Camera& camera, double time, const SceneSwitches& given) {
        const SceneSwitches on = given.share.first() ? given : sharedAlone(given);
        const std::vector<glm::dmat4> nodes = nodeTransforms(scene(), time);
        const std::vector<Light> lights = lightsInWorld(scene(), nodes);
        checkLights(lights, kMaxLights);
        clock.start(timing);
        clock("relief light", [&] { objects.updateNodeLights(on, nodes, lights); });
        const double aspect = static_cast<double>(target.width()) / target.height();
        if (mapsShadows(on) && on.lamps) clock("shadow maps", [&] { updateShadows(camera, aspect, nodes, lights); });
        const Frame frame = frameOf(on, camera, nodes, lights);
        const Bounds box = objects.box(frame.nodes);
        std::vector<ShadowedLamp> lamps = shadowedLamps(scene(), on, nodes, lights);
        // Without the light of lamps that passes add.
        std::vector<Light> unshadowed = lights;
        SceneSwitches rest = on;
        if (countsShadows(on)) {
            for (const ShadowedLamp& lamp : lamps) unshadowed[lamp.light].color = Rgb(0);
            rest.lamps = on.share.first() && lamps.size() < lights.size();
            keepShare(lamps, on);
        }
        std::vector<SpecularFace> specular = specularFaces(scene(), nodes);
        ScheduleInput input{camera, target.width(), target.height(), box.low, box.high, {}};
        input.lights = scheduledLights(scene(), on, lamps, specular);
        schedule = makeSchedule(std::move(specular), input, on.specular);
        std::optional<LightPasses> passes;
        if (countsShadows(on) || !schedule.lights.empty())
            clock("shadow volumes", [&] {
                if (!shadowVolumes) shadowVolumes.emplace(scene());
                passes.emplace(loader, *shadowVolumes, on, lamps, schedule.faces, schedule.lights, nodes);
            });
        const Frame surfaces = frameOf(rest, camera, nodes, unshadowed);
        std::vector<FaceMesh> faces;
        for (const SpecularFace& face : schedule.faces)
            faces.push_back(
                {&*objects.meshOf(face.node)->gpu, frame.nodes[face.node], objects.faceTextureOf(face.specular)});
        if (objects.faceImages()) {
            objects.faceImages()->bind(kFaceImagesUnit);
            glActiveTexture(GL_TEXTURE0);
        }
        target.clear(glm::vec4(glm::vec3(on.sky ? scene().sky.color : Rgb(0)), 1));
        runPasses(
            loader, schedule, target, faces,
            [&](const ScheduledView& view, SurfacePart part) { drawPart(surfaces, view, part, target); },
            [&](const ScheduledView& view, int light) {
                clock("light", [&] { addLight(frame, view, target, *passes, static_cast<std::size_t>(light)); });
            });
    }
};

/// What the shaders need, checked once: the driver's own messages would say less.
static void requireVersion() {
    const auto* text = reinterpret_cast<const char*>(glGetString(GL_VERSION));
    const bool desktop = epoxy_is_desktop_gl();
    const int version = epoxy_gl_version();
    if (text == nullptr || version < (desktop ? 33 : 30))
        throw Error(fmt::format("scene: expected OpenGL 3.3 or OpenGL ES 3.0, found {}", text ? text : "no context"));
}

SceneRenderer::SceneRenderer(ProgramLoader& loader, SceneDescription scene) {
    requireVersion();
    state_ = std::make_unique<State>(loader, std::move(scene));
    switches.specular.lightDepth = usualLightDepth(state_->scene());
}
SceneRenderer::~SceneRenderer() = default;
SceneRenderer::SceneRenderer(SceneRenderer&&) noexcept = default;
SceneRenderer& SceneRenderer::operator=(SceneRenderer&&) noexcept = default;

const SceneDescription& SceneRenderer::scene() const { return state_->scene(); }
const SceneAssets& SceneRenderer::assets() const { return state_->objects.assets(); }

void SceneRenderer::render(const RenderTarget& target, const Camera& camera, double time) {
    state_->render(target, camera, time, switches);
}

ShadowVolumeCounts SceneRenderer::shadowVolumes() const {
    return state_->shadowVolumes ? state_->shadowVolumes->counts() : ShadowVolumeCounts();
}

void SceneRenderer::setTiming(bool on) { state_->timing = on; }
const std::vector<PassTime>& SceneRenderer::passes() const { return state_->clock.times; }
const PassSchedule& SceneRenderer::schedule() const { return state_->schedule; }

void SceneRenderer::setLight(std::size_t light, const SceneLight& value) { state_->objects.setLight(light, value); }
void SceneRenderer::setMaterial(std::size_t material, const SceneMaterial& value) {
    state_->objects.setMaterial(material, value);
}
void SceneRenderer::setNodeMaterial(std::size_t node, int material) { state_->objects.setNodeMaterial(node, material); }
void SceneRenderer::setNodeTranslation(std::size_t node, const Vec3& value) {
    state_->objects.setNodeTranslation(node, value);
}
void SceneRenderer::setSky(const SceneSky& value) { state_->objects.setSky(value); }
void SceneRenderer::setScene(SceneDescription scene) {
    state_->objects.setScene(std::move(scene));
    state_->shadowMaps.clear();
    state_->shadowVolumes.reset();
}
void SceneRenderer::setIndirectLight(const std::vector<std::vector<glm::vec3>>& radiance) {
    state_->objects.setIndirectLight(radiance);
}
std::vector<AssetChange> SceneRenderer::reloadAssets() { return state_->objects.reloadAssets(); }

std::vector<ListedProgram> SceneRenderer::programs() const {
    return scenePrograms(state_->scene(), state_->objects.traits(), switches);
}

}  // namespace nacre
