#include "shading/scene_renderer.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "core/error.hpp"
#include "factorize/models/models.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"
#include "shading/environment_pass.hpp"
#include "shading/multipass/light_passes.hpp"
#include "shading/multipass/pass_runner.hpp"
#include "shading/node_light.hpp"
#include "shading/pass_state.hpp"
#include "shading/scene_shadow_maps.hpp"
#include "shading/volume_pass.hpp"

namespace nacre {
namespace {

constexpr int kEnvironmentUnit = kMaxFactoredTextures, kReliefUnit = kEnvironmentUnit + kEnvironmentUnits;

struct DrawnMesh {
    std::optional<GpuMesh> gpu;  ///< none: without triangles
    Bounds box;
    Vec3 centre{0};
    double radius = 0;
};

DrawnMesh upload(const Mesh& mesh) {
    DrawnMesh out;
    if (mesh.triangles.empty()) return out;
    out.gpu.emplace(mesh);
    out.box = boundsOf(mesh);
    out.centre = 0.5 * (out.box.low + out.box.high);
    out.radius = 0.5 * glm::length(out.box.high - out.box.low);
    return out;
}

bool sameMesh(const Mesh& a, const Mesh& b) {
    return a.triangles == b.triangles && a.positions == b.positions && a.normals == b.normals &&
           a.tangents == b.tangents && a.uvs == b.uvs;
}

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

Mat3 turnedByY(double angle) { return Mat3(glm::rotate(glm::dmat4(1), angle, Vec3(0, 1, 0))); }

}  // namespace

struct SceneRenderer::State {
    ProgramLoader& loader;
    SceneDescription scene;
    SceneAssets assets;
    std::vector<AssetTraits> traits;
    std::vector<DrawnMesh> meshes;
    std::map<std::shared_ptr<const Volume>, GpuVolume> volumes;
    std::map<std::shared_ptr<const Image>, Texture> faceTextures;
    std::optional<Texture> faceImages;                 ///< of all specular materials; addressed by texelFetch
    std::vector<std::optional<GpuDirectBrdf>> models;  ///< one a material: what Direct evaluates
    std::map<std::size_t, NodeLight> nodeLights;       ///< of nodes whose relief has indirect light
    SceneShadowMaps shadowMaps;
    std::optional<SceneShadowVolumes> shadowVolumes;  ///< with ShadowMethod::Volumes
    std::map<std::size_t, Buffer> nodeRadiance;       ///< a vertex, of nodes that have it
    PassClock clock;
    bool timing = false;
    PassSchedule schedule;  ///< of the last frame

    State(ProgramLoader& programs, SceneDescription&& description)
        : loader(programs), scene(std::move(description)), assets(scene.assets), traits(assets.traits()) {
        checkScene(scene, traits);
        for (const SceneMesh& mesh : scene.meshes) meshes.push_back(upload(mesh.mesh));
        for (const SceneVolume& volume : scene.volumes) volumes.try_emplace(volume.volume, *volume.volume);
        prepareModels();
    }

    void prepareModels() {
        models.clear();
        for (const SceneMaterial& m : scene.materials) {
            const std::string model = directModelOf(scene, m, traits);
            models.push_back(model.empty() ? std::nullopt : directBrdf(makeModel(model)));
        }
        for (const SceneMaterial& m : scene.materials)
            if (m.specular && m.specular->texture)
                faceTextures.try_emplace(m.specular->texture, *m.specular->texture, Filter::Linear);
        faceImages.reset();
        if (const Image images = nacre::faceImages(scene); !images.empty()) faceImages.emplace(images);
    }

    const GpuAsset& asset(int index) const { return assets[static_cast<std::size_t>(index)]; }

    EnvironmentLookup lookup(const SceneLookup& l) const {
        if (l.asset < 0) return {};
        return {&asset(l.asset).environment.value(), l.lod, l.color};
    }
    EnvironmentSurface surfaceOf(const SceneSurrounding& s) const {
        EnvironmentSurface out;
        out.reflection = lookup(s.reflection);
        out.transmission = lookup(s.transmission);
        out.diffuse = lookup(s.diffuse);
        out.ior = s.ior;
        if (s.table >= 0) out.table = &asset(s.table).table.value();
        out.f0 = s.f0;
        out.perceptualRoughness = s.perceptualRoughness;
        out.multipleScattering = s.multipleScattering;
        out.combine = s.blend ? EnvironmentCombine::Blend : EnvironmentCombine::Add;
        out.fromWorld = turnedByY(-scene.sky.rotationY);
        return out;
    }

    const SceneMaterial& materialOf(std::size_t node) const {
        return scene.materials[static_cast<std::size_t>(scene.nodes[node].material)];
    }
    const DrawnMesh* meshOf(std::size_t node) const {
        const int mesh = scene.nodes[node].mesh;
        if (mesh < 0 || !meshes[static_cast<std::size_t>(mesh)].gpu) return nullptr;
        return &meshes[static_cast<std::size_t>(mesh)];
    }

    std::optional<VolumeSurface> volumeOf(std::size_t node, const glm::dmat4& toWorld) const {
        if (scene.nodes[node].volume < 0) return {};
        const SceneVolume& volume = scene.volumes[static_cast<std::size_t>(scene.nodes[node].volume)];
        return VolumeSurface{&volumes.at(volume.volume), volume.iso, toWorld, volume.method, volume.step};
    }

    void updateNodeLights(const SceneSwitches& on, const std::vector<glm::dmat4>& nodes,
                          const std::vector<Light>& lights) {
        for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
            if (!meshOf(i) || !takesLamps(scene, materialOf(i), on)) continue;
            const std::optional<SceneRelief> relief = reliefOf(materialOf(i), traits, on);
            if (!relief || relief->indirectLight < 0) continue;
            nodeLights[i].update(loader, {*relief, assets, scene.assets[static_cast<std::size_t>(relief->asset)].file,
                                          scene.meshes[static_cast<std::size_t>(scene.nodes[i].mesh)].mesh, nodes[i],
                                          lights[static_cast<std::size_t>(relief->indirectLight)]});
        }
    }

    BumpSurface bumpOf(std::size_t node, const SceneRelief& relief, bool lamps) const {
        BumpSurface out{&asset(relief.asset).bump.value(), relief.shadow, relief.tiles, relief.roughness};
        if (!lamps || relief.indirectLight < 0) return out;
        out.indirect = nodeLights.at(node).scattered();
        out.indirectLight = relief.indirectLight;
        return out;
    }

    /// About all that is drawn.
    Bounds sceneBox(const std::vector<glm::dmat4>& nodes) const {
        Bounds box;
        const auto corner = [](int i) { return Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1); };
        for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
            const std::optional<VolumeSurface> volume = volumeOf(i, nodes[i]);
            const DrawnMesh* mesh = meshOf(i);
            for (int k = 0; k < 8; ++k) {
                if (volume) box.add(Vec3(volumeBox(*volume) * Vec4(corner(k), 1)));
                if (mesh) box.add(Vec3(nodes[i] * Vec4(glm::mix(mesh->box.low, mesh->box.high, corner(k)), 1)));
            }
        }
        return box;
    }

    /// Draws the maps of lights that moved, or whose casters did.
    void updateShadows(const Camera& camera, double aspect, const std::vector<glm::dmat4>& nodes,
                       const std::vector<Light>& lights) {
        ShadowScene drawn;
        drawn.camera = &camera;
        drawn.aspect = aspect;
        drawn.bounds = sceneBox(nodes);
        for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
            if (!scene.nodes[i].castsShadow) continue;
            if (const std::optional<VolumeSurface> volume = volumeOf(i, nodes[i])) drawn.volumes.push_back(*volume);
            if (const DrawnMesh* mesh = meshOf(i)) drawn.casters.push_back({&*mesh->gpu, nodes[i]});
        }
        shadowMaps.update(loader, scene.lights, lights, drawn);
    }

    /// Those in use, one a light or none; for nodes that receive shadows.
    std::vector<const ShadowMap*> shadowsOf(const SceneSwitches& on) const {
        if (!mapsShadows(on) || on.reflectance == SceneReflectance::FastPhong) return {};
        return shadowMaps.maps();
    }

    /// Everything but the node's place.
    void bindMaterial(const Program& program, std::size_t node, const SceneSwitches& on, const LitView& view) const {
        const SceneMaterial& m = materialOf(node);
        const bool lamps = takesLamps(scene, m, on);
        const bool vertex = lamps && on.reflectance == SceneReflectance::FastPhong;
        if (lamps) {
            const auto& model = models[static_cast<std::size_t>(scene.nodes[node].material)];
            if (m.brdf < 0 || (on.reflectance == SceneReflectance::Direct && model))
                model->bind(program);
            else
                asset(m.brdf).brdf->bind(program);
        }
        if (m.surrounding && on.surrounding && !vertex)
            bindEnvironment(program, surfaceOf(*m.surrounding), kEnvironmentUnit);
        const std::optional<SceneRelief> relief = reliefOf(m, traits, on);
        if (relief && !vertex) bindBump(program, bumpOf(node, *relief, lamps), kReliefUnit);
        setLights(program, view);
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
        out.viewDefines = nacre::viewDefines(scene);
        return out;
    }

    /// The nodes with meshes that a view may see. Front to back: what is hidden is rejected before it is shaded.
    std::vector<Draw> drawsOf(const Frame& frame, const ScheduledView& view, const RenderTarget& target) const {
        // Rounding may leave the face that the view is seen through in front of itself.
        const std::size_t own =
            view.face < 0 ? scene.nodes.size() : schedule.faces[static_cast<std::size_t>(view.face)].node;
        std::vector<Draw> draws;
        for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
            const DrawnMesh* mesh = meshOf(i);
            if (!mesh || i == own) continue;
            const bool added =
                takesLamps(scene, materialOf(i), frame.on) && scene.nodes[i].receivesShadow == frame.receivers;
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
        const std::optional<SceneSpecular>& specular = materialOf(node).specular;
        return specular ? specular->surface : 1;
    }

    void drawNodes(const Frame& frame, const ScheduledView& view, const RenderTarget& target) {
        LitView lit{frame.camera, frame.lights};
        const Program* program = nullptr;
        int material = -1;
        for (const Draw& draw : drawsOf(frame, view, target)) {
            const SceneMaterial& m = materialOf(draw.node);
            const GpuMesh& mesh = *meshOf(draw.node)->gpu;
            const double share = ownShare(draw.node);
            if (share == 0) {
                drawFace(loader, view, {&mesh, frame.nodes[draw.node]});
                program = nullptr;
                continue;
            }
            const bool shadowed = scene.nodes[draw.node].receivesShadow;
            SceneProgram wanted =
                materialProgram(scene, m, traits, frame.on, shadowed ? frame.shadowDefines : ShaderDefines());
            const auto radiance = nodeRadiance.find(draw.node);
            const bool brings =
                frame.on.ambient && radiance != nodeRadiance.end() && wanted.fragment == "scene.frag.glsl";
            if (brings) wanted.defines.emplace_back("NACRE_VERTEX_RADIANCE", "1");
            if (frame.image) wanted.defines = joined(std::move(wanted.defines), lightPathDefines(*frame.image));
            const Program& next = loader.load(wanted.vertex, wanted.fragment,
                                              joined(std::move(wanted.defines), viewDefinesOf(frame, view)));
            const bool own = nodeLights.count(draw.node) != 0;  // its texture is the node's, not the material's
            if (&next != program || material != scene.nodes[draw.node].material || own) {
                lit.ambient = frame.on.ambient ? m.ambient : Rgb(0);
                lit.shadows =
                    shadowed && takesLamps(scene, m, frame.on) ? frame.shadows : std::vector<const ShadowMap*>();
                bindMaterial(next, draw.node, frame.on, lit);
                if (shadowed && frame.on.shadowMethod == ShadowMethod::Levels)
                    bindLightLevels(next, frame.on.lightLevels);
                if (frame.image) setLightPath(next, *frame.image);
                setView(next, view.view, view.light, share);
                if (m.specular && m.specular->texture) {
                    faceTextures.at(m.specular->texture).bind(kReliefUnit);  // checkSpecular: there is no relief
                    next.set("nacre_face_texture", kReliefUnit);
                }
                program = &next;
                material = own ? -1 : scene.nodes[draw.node].material;
            }
            drawPlaced(next, mesh, frame.nodes[draw.node], view.view.mirrored, brings ? &radiance->second : nullptr);
        }
    }

    void drawDepths(const Frame& frame, const ScheduledView& view, const RenderTarget& target) {
        for (const Draw& draw : drawsOf(frame, view, target))
            drawFace(loader, view, {&*meshOf(draw.node)->gpu, frame.nodes[draw.node]});
    }

    /// After the meshes, whose depths hide what is behind them.
    void drawVolumes(const Frame& frame, const ScheduledView& view) {
        const SceneSwitches on = volumeSwitches(frame.on);
        const std::vector<const ShadowMap*> shadows = shadowsOf(on);
        const ShaderDefines defines = shadowDefines(shadows, frame.lights);
        for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
            const std::optional<VolumeSurface> surface = volumeOf(i, frame.nodes[i]);
            if (!surface) continue;
            const SceneMaterial& m = materialOf(i);
            const bool shadowed = scene.nodes[i].receivesShadow && takesLamps(scene, m, on);
            SceneProgram wanted = volumeProgram(scene, scene.volumes[static_cast<std::size_t>(scene.nodes[i].volume)],
                                                m, traits, on, shadowed ? defines : ShaderDefines());
            const Program& program = loader.load(wanted.vertex, wanted.fragment,
                                                 joined(std::move(wanted.defines), viewDefinesOf(frame, view)));
            LitView lit{frame.camera, frame.lights};
            lit.ambient = on.ambient ? m.ambient : Rgb(0);
            if (shadowed) lit.shadows = shadows;
            bindMaterial(program, i, on, lit);
            drawVolume(program, *surface, view.view, view.light);
        }
    }

    void drawBackground(const Frame& frame, const ScheduledView& view) {
        if (scene.sky.asset >= 0)
            return drawSky(loader, view.view, {&asset(scene.sky.asset).environment.value(), scene.sky.lod, Rgb(1)},
                           turnedByY(-scene.sky.rotationY), view.light, viewDefinesOf(frame, view));
        const Program& program = loader.load("sky.vert.glsl", "background.frag.glsl", viewDefinesOf(frame, view));
        setView(program, view.view, view.light);
        program.set("nacre_clip_to_world", glm::mat4(glm::inverse(view.view.toClip)));
        program.set("nacre_background", glm::vec3(scene.sky.color));
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
            const bool there = scene.sky.asset >= 0 || scene.sky.color != Rgb(0) || view.light.fogDistance > 0;
            if (frame.on.sky && there && (view.level > 0 || scene.sky.asset >= 0))
                clock("sky", [&] { drawBackground(frame, view); });
            return;
        }
        clock("surfaces",
              [&] { part == SurfacePart::Depth ? drawDepths(frame, view, target) : drawNodes(frame, view, target); });
        if (!volumes.empty()) clock("volumes", [&] { drawVolumes(frame, view); });
    }

    void render(const RenderTarget& target, const Camera& camera, double time, const SceneSwitches& given) {
        const SceneSwitches on = given.share.first() ? given : sharedAlone(given);
        const std::vector<glm::dmat4> nodes = nodeTransforms(scene, time);
        const std::vector<Light> lights = lightsInWorld(scene, nodes);
        checkLights(lights, kMaxLights);
        clock.start(timing);
        clock("relief light", [&] { updateNodeLights(on, nodes, lights); });
        const double aspect = static_cast<double>(target.width()) / target.height();
        if (mapsShadows(on) && on.lamps) clock("shadow maps", [&] { updateShadows(camera, aspect, nodes, lights); });
        const Frame frame = frameOf(on, camera, nodes, lights);
        const Bounds box = sceneBox(frame.nodes);
        std::vector<ShadowedLamp> lamps = shadowedLamps(scene, on, nodes, lights);
        // Without the light of lamps that passes add.
        std::vector<Light> unshadowed = lights;
        SceneSwitches rest = on;
        if (countsShadows(on)) {
            for (const ShadowedLamp& lamp : lamps) unshadowed[lamp.light].color = Rgb(0);
            rest.lamps = on.share.first() && lamps.size() < lights.size();
            keepShare(lamps, on);
        }
        std::vector<SpecularFace> specular = specularFaces(scene, nodes);
        ScheduleInput input{camera, target.width(), target.height(), box.low, box.high, {}};
        input.lights = scheduledLights(scene, on, lamps, specular);
        schedule = makeSchedule(std::move(specular), input, on.specular);
        std::optional<LightPasses> passes;
        if (countsShadows(on) || !schedule.lights.empty())
            clock("shadow volumes", [&] {
                if (!shadowVolumes) shadowVolumes.emplace(scene);
                passes.emplace(loader, *shadowVolumes, on, lamps, schedule.faces, schedule.lights, nodes);
            });
        const Frame surfaces = frameOf(rest, camera, nodes, unshadowed);
        std::vector<FaceMesh> faces;
        for (const SpecularFace& face : schedule.faces)
            faces.push_back({&*meshOf(face.node)->gpu, frame.nodes[face.node],
                             face.specular.texture ? &faceTextures.at(face.specular.texture) : nullptr});
        if (faceImages) {
            faceImages->bind(kFaceImagesUnit);
            glActiveTexture(GL_TEXTURE0);
        }
        target.clear(glm::vec4(glm::vec3(on.sky ? scene.sky.color : Rgb(0)), 1));
        runPasses(
            loader, schedule, target, faces,
            [&](const ScheduledView& view, SurfacePart part) { drawPart(surfaces, view, part, target); },
            [&](const ScheduledView& view, int light) {
                clock("light", [&] { addLight(frame, view, target, *passes, static_cast<std::size_t>(light)); });
            });
    }

    /// Takes the value, unless the scene is unsound with it.
    template <class T>
    void edit(T& member, T value) {
        std::swap(member, value);
        try {
            checkScene(scene, traits);
        } catch (...) {
            std::swap(member, value);
            throw;
        }
        prepareModels();
    }

    void setIndirectLight(const std::vector<std::vector<glm::vec3>>& radiance) {
        require(radiance.size() == scene.nodes.size(), "scene: expected a list of radiance for each node");
        for (std::size_t i = 0; i < radiance.size(); ++i) {
            const int mesh = scene.nodes[i].mesh;
            const std::size_t vertices =
                mesh < 0 ? 0 : scene.meshes[static_cast<std::size_t>(mesh)].mesh.positions.size();
            require(radiance[i].empty() || radiance[i].size() == vertices,
                    fmt::format("scene: expected {} vertices' radiance at node {}, found {}", vertices, i,
                                radiance[i].size()));
        }
        nodeRadiance.clear();
        for (std::size_t i = 0; i < radiance.size(); ++i) {
            if (radiance[i].empty()) continue;
            glBindBuffer(GL_ARRAY_BUFFER, nodeRadiance[i].name());
            glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(radiance[i].size() * sizeof(glm::vec3)),
                         radiance[i].data(), GL_STATIC_DRAW);
        }
        glBindBuffer(GL_ARRAY_BUFFER, 0);
    }

    void setScene(SceneDescription&& next) {
        SceneAssets nextAssets = assets;
        nextAssets.open(next.assets);
        std::vector<AssetTraits> nextTraits = nextAssets.traits();
        checkScene(next, nextTraits);
        std::vector<DrawnMesh> nextMeshes(next.meshes.size());
        std::vector<std::pair<std::size_t, std::size_t>> moves;
        std::vector<bool> taken(meshes.size(), false);
        for (std::size_t i = 0; i < next.meshes.size(); ++i) {
            std::size_t old = 0;
            while (old < meshes.size() && (taken[old] || !sameMesh(scene.meshes[old].mesh, next.meshes[i].mesh))) ++old;
            if (old == meshes.size()) {
                nextMeshes[i] = upload(next.meshes[i].mesh);
                continue;
            }
            taken[old] = true;
            moves.emplace_back(old, i);
        }
        std::map<std::shared_ptr<const Volume>, GpuVolume> nextVolumes;
        for (const SceneVolume& volume : next.volumes)
            if (volumes.count(volume.volume) == 0) nextVolumes.try_emplace(volume.volume, *volume.volume);
        for (const SceneVolume& volume : next.volumes)
            if (auto node = volumes.extract(volume.volume)) nextVolumes.insert(std::move(node));
        for (const auto& [from, to] : moves) nextMeshes[to] = std::move(meshes[from]);
        scene = std::move(next);
        assets = std::move(nextAssets);
        traits = std::move(nextTraits);
        meshes = std::move(nextMeshes);
        volumes = std::move(nextVolumes);
        nodeLights.clear();
        shadowMaps.clear();
        faceTextures.clear();
        shadowVolumes.reset();
        nodeRadiance.clear();
        prepareModels();
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
    switches.specular.lightDepth = usualLightDepth(state_->scene);
}
SceneRenderer::~SceneRenderer() = default;
SceneRenderer::SceneRenderer(SceneRenderer&&) noexcept = default;
SceneRenderer& SceneRenderer::operator=(SceneRenderer&&) noexcept = default;

const SceneDescription& SceneRenderer::scene() const { return state_->scene; }
const SceneAssets& SceneRenderer::assets() const { return state_->assets; }

void SceneRenderer::render(const RenderTarget& target, const Camera& camera, double time) {
    state_->render(target, camera, time, switches);
}

ShadowVolumeCounts SceneRenderer::shadowVolumes() const {
    return state_->shadowVolumes ? state_->shadowVolumes->counts() : ShadowVolumeCounts();
}

void SceneRenderer::setTiming(bool on) { state_->timing = on; }
const std::vector<PassTime>& SceneRenderer::passes() const { return state_->clock.times; }
const PassSchedule& SceneRenderer::schedule() const { return state_->schedule; }

void SceneRenderer::setLight(std::size_t light, const SceneLight& value) {
    state_->edit(state_->scene.lights.at(light), value);
}
void SceneRenderer::setMaterial(std::size_t material, const SceneMaterial& value) {
    state_->edit(state_->scene.materials.at(material), value);
}
void SceneRenderer::setNodeMaterial(std::size_t node, int material) {
    state_->edit(state_->scene.nodes.at(node).material, material);
}
void SceneRenderer::setSky(const SceneSky& value) { state_->edit(state_->scene.sky, value); }
void SceneRenderer::setScene(SceneDescription scene) { state_->setScene(std::move(scene)); }

void SceneRenderer::setIndirectLight(const std::vector<std::vector<glm::vec3>>& radiance) {
    state_->setIndirectLight(radiance);
}

std::vector<AssetChange> SceneRenderer::reloadAssets() {
    std::vector<AssetChange> changes =
        state_->assets.reload([this](const std::vector<AssetTraits>& traits) { checkScene(state_->scene, traits); });
    if (!changes.empty()) {
        state_->traits = state_->assets.traits();
        state_->prepareModels();
    }
    return changes;
}

std::vector<ListedProgram> SceneRenderer::programs() const {
    return scenePrograms(state_->scene, state_->traits, switches);
}

}  // namespace nacre
