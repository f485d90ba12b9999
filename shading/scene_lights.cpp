#include <fmt/format.h>

#include <array>

#include "shading/scene_sections.hpp"

namespace nacre {
namespace {

SceneShadow shadow(const JsonField& field, const SceneLight& light) {
    field.requireKeys({"size", "bits", "filter", "faces", "bias", "near", "far", "cascades", "projection"});
    SceneShadow out;
    ifThere(field, "size", [&](const JsonField& f) { out.size = f.integer(16, 16384); });
    ifThere(field, "bits", [&](const JsonField& f) {
        out.bits = f.integer(16, 32);
        if (out.bits != 16 && out.bits != 32) f.fail(fmt::format("expected 16 or 32, found {}", out.bits));
    });
    ifThere(field, "filter", [&](const JsonField& f) { out.filter = f.integer(1, 15); });
    ifThere(field, "faces", [&](const JsonField& f) {
        static constexpr std::array kFaces = {SceneShadow::Faces::Both, SceneShadow::Faces::Front,
                                              SceneShadow::Faces::Back};
        out.faces = kFaces[static_cast<std::size_t>(f.choice({"both", "front", "back"}))];
    });
    ifThere(field, "bias", [&](const JsonField& f) { out.bias = f.number(0); });
    ifThere(field, "near", [&](const JsonField& f) { out.near = f.positive(); });
    ifThere(field, "far", [&](const JsonField& f) {
        out.far = f.positive();
        if (!(out.far > out.near)) f.fail(fmt::format("expected more than near, {:g}, found {:g}", out.near, out.far));
    });
    ifThere(field, "cascades", [&](const JsonField& f) {
        out.cascades = f.integer(1, 4);
        if (out.cascades > 1 && !light.light.directional) f.fail("expected 1: only directional lights have cascades");
    });
    ifThere(field, "projection", [&](const JsonField& f) {
        out.dualParaboloid = f.choice({"cube", "dual_paraboloid"}) == 1;
        if (light.light.directional || light.light.cone) f.fail("expected none: only point lights have a choice");
    });
    return out;
}

/// Where a spot shines and how wide. \param position  of the light
SpotCone cone(const JsonField& field, const Vec3& position) {
    SpotCone out;
    const auto direction = field.find("direction"), target = field.find("target");
    if (direction && target) target->fail("expected \"direction\" or \"target\", found both");
    if (direction) out.axis = direction->direction();
    if (target) {
        const Vec3 to = target->vector() - position;
        if (!(glm::length(to) > 0)) target->fail("expected a point other than the light's own");
        out.axis = glm::normalize(to);
    }
    ifThere(field, "outerDeg", [&](const JsonField& f) {
        const double outer = f.number(0, 90);
        if (!(outer > 0)) f.fail("expected a half angle above 0, up to 90");
        out.outer = radians(outer);
    });
    ifThere(field, "innerDeg", [&](const JsonField& f) {
        out.inner = radians(f.number(0, 90));
        if (!(out.inner < out.outer))
            f.fail(fmt::format("expected less than outerDeg, {:g}, found {:g}", out.outer * 180 / kPi,
                               out.inner * 180 / kPi));
    });
    return out;
}

}  // namespace

SceneLight sceneLight(const std::string& name, const JsonField& field, const SceneNames& names) {
    const int type = field.at("type").choice({"directional", "point", "spot"});
    if (type == 0)
        field.requireKeys({"type", "color", "intensity", "node", "shadow", "direction"});
    else if (type == 1)
        field.requireKeys({"type", "color", "intensity", "node", "shadow", "position", "area"});
    else
        field.requireKeys({"type", "color", "intensity", "node", "shadow", "position", "area", "direction", "target",
                           "innerDeg", "outerDeg"});
    SceneLight out;
    out.name = name;
    Light& light = out.light;
    ifThere(field, "color", [&](const JsonField& f) { light.color = f.color(); });
    ifThere(field, "intensity", [&](const JsonField& f) { light.color *= f.number(0, kBrightest); });
    ifThere(field, "node", [&](const JsonField& f) { out.node = f.nameIn(names.nodes, "node"); });
    light.directional = type == 0;
    if (light.directional) {
        // The file says where light goes, as for spots; the value where it comes from.
        ifThere(field, "direction", [&](const JsonField& f) { light.position = -f.direction(); });
    } else {
        light.position = Vec3(0);
        ifThere(field, "position", [&](const JsonField& f) { light.position = f.vector(); });
        ifThere(field, "area", [&](const JsonField& f) {
            f.requireKeys({"u", "v"});
            out.area = LightArea{f.at("u").vector(), f.at("v").vector()};
            if (glm::length(glm::cross(out.area->u, out.area->v)) == 0)
                f.fail("expected u and v that span an area, found parallel ones");
        });
        if (type == 2) light.cone = cone(field, light.position);
    }
    ifThere(field, "shadow", [&](const JsonField& f) {
        if (!f.value().is_boolean())
            out.shadow = shadow(f, out);
        else if (f.flag())
            out.shadow = SceneShadow{};
    });
    return out;
}

}  // namespace nacre
