#include "demos/viewer/panel_parts.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "demos/viewer/light_drag.hpp"
#include "factorize/models/models.hpp"
#include "shading/mesh_attributes.hpp"

namespace nacre {
namespace {

std::string called(const std::string& name, const char* kind, std::size_t index) {
    return name.empty() ? fmt::format("{} {}", kind, index) : name;
}

bool colorEdit(const char* label, Rgb& color) {
    float value[3] = {static_cast<float>(color.r), static_cast<float>(color.g), static_cast<float>(color.b)};
    if (!ImGui::ColorEdit3(label, value, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR)) return false;
    color = {std::max(0.f, value[0]), std::max(0.f, value[1]), std::max(0.f, value[2])};
    return true;
}

/// Whatever has a mesh.
void nodeCombo(const ViewerSession& session, PanelState& state) {
    const std::vector<SceneNode>& nodes = session.scene().nodes;
    const auto valid = [&](int i) {
        return i >= 0 && i < static_cast<int>(nodes.size()) && nodes[static_cast<std::size_t>(i)].mesh >= 0;
    };
    if (!valid(state.node)) {
        const auto first = std::find_if(nodes.begin(), nodes.end(), [](const SceneNode& n) { return n.mesh >= 0; });
        state.node = first == nodes.end() ? -1 : static_cast<int>(first - nodes.begin());
    }
    if (state.node < 0) return;
    const auto chosen = static_cast<std::size_t>(state.node);
    if (!ImGui::BeginCombo("mesh", called(nodes[chosen].name, "node", chosen).c_str())) return;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].mesh < 0) continue;
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::Selectable(called(nodes[i].name, "node", i).c_str(), i == chosen)) state.node = static_cast<int>(i);
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

void sceneMaterialCombo(ViewerSession& session, std::size_t node) {
    const std::vector<SceneMaterial>& materials = session.scene().materials;
    const int current = session.scene().nodes[node].material;
    int next = current;
    if (ImGui::BeginCombo("material", called(materials[static_cast<std::size_t>(current)].name, "material",
                                             static_cast<std::size_t>(current))
                                          .c_str())) {
        for (std::size_t i = 0; i < materials.size(); ++i) {
            ImGui::PushID(static_cast<int>(i));
            if (ImGui::Selectable(called(materials[i].name, "material", i).c_str(), static_cast<int>(i) == current))
                next = static_cast<int>(i);
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    if (next != current) session.setNodeMaterial(node, next);
}

/// An analytic model, typed; the list gives its name to start from.
void modelInput(ViewerSession& session, PanelState& state, std::size_t node) {
    const bool entered = ImGui::InputTextWithHint("##model", "a model: ggx:alpha=0.2", &state.modelText,
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    if (ImGui::Button("Apply") || entered) session.setNodeMaterial(node, state.modelText);
    if (ImGui::BeginCombo("model", "analytic models...")) {
        for (const ModelInfo& info : listModels()) {
            if (ImGui::Selectable(info.name.c_str())) {
                state.modelText = info.name;
                session.setNodeMaterial(node, state.modelText);
            }
            if (ImGui::IsItemHovered()) {
                std::string text = info.summary;
                for (const ModelParameter& p : info.parameters)
                    text += fmt::format("\n  {}={}   {} {}", p.name, p.defaultValue, p.summary, p.range);
                ImGui::SetTooltip("%s", text.c_str());
            }
        }
        ImGui::EndCombo();
    }
}

/// A list of the baked files of one kind. \return the chosen one, or empty
std::filesystem::path foundCombo(const std::string& label, const char* preview, const std::string& kind,
                                 PanelState& state) {
    std::filesystem::path out;
    if (!ImGui::BeginCombo(label.c_str(), preview)) {
        notePlace(state, label);
        return out;
    }
    if (ImGui::IsWindowAppearing()) state.wantsFind = true;
    bool none = true;
    for (const FoundAsset& asset : state.found) {
        if (asset.kind != kind) continue;
        none = false;
        if (ImGui::Selectable(asset.file.filename().c_str())) out = asset.file;
        notePlace(state, label + "/" + asset.file.filename().string());
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", asset.file.c_str());
    }
    if (none) ImGui::TextDisabled("none beside the scene; --assets DIR adds folders");
    ImGui::EndCombo();
    return out;
}

void reliefCombo(ViewerSession& session, PanelState& state, std::size_t node) {
    const auto material = static_cast<std::size_t>(session.scene().nodes[node].material);
    const std::optional<SceneRelief>& relief = session.scene().materials[material].relief;
    const std::string now =
        relief ? session.scene().assets[static_cast<std::size_t>(relief->asset)].file.filename().string()
               : "baked reliefs...";
    const bool remove = relief && ImGui::Button("Flat");
    if (relief) {
        notePlace(state, "Flat");
        ImGui::SameLine();
    }
    const SceneMesh& mesh = session.scene().meshes[static_cast<std::size_t>(session.scene().nodes[node].mesh)];
    if (!hasUv(mesh.mesh)) return ImGui::TextDisabled("relief: the mesh has no texture coordinates");
    const std::filesystem::path file = foundCombo("relief", now.c_str(), "bump", state);
    if (remove || !file.empty()) session.setRelief(material, remove ? std::filesystem::path() : file);
}

void assetFacts(const GpuAsset& asset) {
    const nlohmann::json& meta = asset.meta;
    if (const auto bytes = meta.find("bytes"); bytes != meta.end() && bytes->is_number())
        ImGui::Text("%.1f KiB%s", bytes->get<double>() / 1024,
                    meta.contains("fetches") ? fmt::format(", {} fetches", meta["fetches"].dump()).c_str() : "");
    if (const auto source = meta.find("source"); source != meta.end() && source->is_string())
        ImGui::TextWrapped("of %s", source->get<std::string>().c_str());
    const auto error = meta.find("error");
    if (error == meta.end() || !error->is_object()) return;
    for (const auto& [name, value] : error->items())
        if (value.is_number()) ImGui::Text("  %-16s %.4g", name.c_str(), value.get<double>());
}

}  // namespace

void notePlace(PanelState& state, const std::string& name) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    state.places[name] = {0.5 * (low.x + high.x), 0.5 * (low.y + high.y)};
}

void materialSection(ViewerSession& session, PanelState& state) {
    nodeCombo(session, state);
    if (state.node < 0) return ImGui::TextDisabled("the scene has no mesh");
    const auto node = static_cast<std::size_t>(state.node);
    sceneMaterialCombo(session, node);
    modelInput(session, state, node);
    if (const auto file = foundCombo("baked", "baked BRDFs...", "brdf", state); !file.empty())
        session.setNodeMaterial(node, file.string());
    const bool entered = ImGui::InputTextWithHint("##file", "or a baked file's path", &state.fileText,
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    if (ImGui::Button("Load") || entered) session.setNodeMaterial(node, state.fileText);
    const auto material = static_cast<std::size_t>(session.scene().nodes[node].material);
    reliefCombo(session, state, node);
    SceneMaterial value = session.scene().materials[material];
    if (colorEdit("ambient", value.ambient)) session.setMaterial(material, value);
}

void lightSection(ViewerSession& session, PanelState& state) {
    const std::vector<SceneLight>& lights = session.scene().lights;
    state.light = std::clamp(state.light, 0, static_cast<int>(lights.size()) - 1);
    const auto chosen = static_cast<std::size_t>(state.light);
    if (ImGui::BeginCombo("light", called(lights[chosen].name, "light", chosen).c_str())) {
        for (std::size_t i = 0; i < lights.size(); ++i) {
            ImGui::PushID(static_cast<int>(i));
            if (ImGui::Selectable(called(lights[i].name, "light", i).c_str(), i == chosen))
                state.light = static_cast<int>(i);
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    SceneLight value = lights[static_cast<std::size_t>(state.light)];
    bool changed = colorEdit(value.light.directional ? "irradiance" : "intensity", value.light.color);
    float place[3] = {static_cast<float>(value.light.position.x), static_cast<float>(value.light.position.y),
                      static_cast<float>(value.light.position.z)};
    if (ImGui::DragFloat3(value.light.directional ? "towards it" : "position", place, 0.01f)) {
        const Vec3 to(place[0], place[1], place[2]);
        if (!value.light.directional) value.light.position = to, changed = true;
        if (value.light.directional && glm::length(to) > 1e-6)
            value.light.position = glm::normalize(to), changed = true;
    }
    if (changed) session.setLight(static_cast<std::size_t>(state.light), value);
}

void assetSection(ViewerSession& session, PanelState& state) {
    for (std::size_t i = 0; i < session.scene().assets.size(); ++i) {
        const SceneAsset asset = session.scene().assets[i];
        const GpuAsset& gpu = session.renderer().assets()[i];
        const std::string kind = gpu.traits.kind;
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::TreeNodeEx(asset.name.c_str(), ImGuiTreeNodeFlags_DefaultOpen, "%s (%s)", asset.name.c_str(),
                              kind.c_str())) {
            assetFacts(gpu);
            const std::filesystem::path other =
                foundCombo("file##" + asset.name, asset.file.filename().c_str(), kind, state);
            if (!other.empty() && other != asset.file) session.replaceAsset(i, other);
            if (kind == "environment" && session.scene().sky.asset != static_cast<int>(i) &&
                ImGui::Button("Use as background")) {
                SceneSky sky = session.scene().sky;
                sky.asset = static_cast<int>(i);
                session.setSky(sky);
            }
            ImGui::TreePop();
        }
        ImGui::PopID();
    }
}

void comparisonStatus(Comparison& comparison) {
    if (!comparison.problem().empty()) return ImGui::TextWrapped("reference: %s", comparison.problem().c_str());
    if (comparison.waits()) return ImGui::TextDisabled("traced once the view stands still");
    ImGui::Text("pass %d of %d%s", comparison.passes(), comparison.passesAsked(), comparison.done() ? "" : "...");
    if (const auto& d = comparison.difference()) {
        ImGui::Text("PSNR %.2f dB as seen, %.2f dB linear", d->psnrSrgb, d->psnrLinear);
        ImGui::Text("relative error %.3g, largest %.3g", d->relative, d->maxAbs);
    }
    if (comparison.shown != Shown::Difference) return;
    auto scale = static_cast<float>(comparison.differenceScale);
    if (ImGui::SliderFloat("white is", &scale, 0.005f, 1, "%.3f sRGB", ImGuiSliderFlags_Logarithmic))
        comparison.differenceScale = scale;
}

}  // namespace nacre
