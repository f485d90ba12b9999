#include "shading/hybrid/indirect_pass.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"

namespace nacre {

/// Of a pass: the arrays in shaders/nacre/bind/virtual_lights.glsl.
static constexpr std::size_t kLightsAPass = 48;

void addVirtualLights(ProgramLoader& loader, const RenderTarget& target, const GeometryBuffer& geometry,
                      std::span<const VirtualPointLight> lights, const VirtualShadows* shadows, NearLight near) {
    require(target.width() == geometry.width() && target.height() == geometry.height(),
            "virtual lights: expected a target of the geometry buffer's size");
    static constexpr const char* kNear[] = {"NACRE_VIRTUAL_POINT", "NACRE_VIRTUAL_DISK", "NACRE_VIRTUAL_RECTANGLE"};
    ShaderDefines defines{{"NACRE_VIRTUAL_NEAR", kNear[static_cast<int>(near)]}};
    if (shadows != nullptr) defines.emplace_back("NACRE_VIRTUAL_SHADOWS", "1");
    const Program& program = loader.load("fullscreen.vert.glsl", "indirect.frag.glsl", defines);
    geometry.bind(program);
    if (shadows != nullptr) shadows->bind(program, 3);
    target.bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    const VertexArray empty;
    for (std::size_t first = 0; first < lights.size(); first += kLightsAPass) {
        const std::span<const VirtualPointLight> here =
            lights.subspan(first, std::min(kLightsAPass, lights.size() - first));
        std::array<glm::vec4, kLightsAPass> places{}, normals{}, powers{}, us{}, vs{};
        for (std::size_t i = 0; i < here.size(); ++i) {
            const Vec3 eye = here[i].position + (shadows != nullptr ? shadows->lift() : 0) * here[i].normal;
            places[i] = glm::vec4(Vec4(here[i].place, here[i].area() / kPi));
            normals[i] = glm::vec4(Vec4(here[i].normal, eye.z));
            powers[i] = glm::vec4(Vec4(here[i].power / kPi, 0));
            us[i] = glm::vec4(Vec4(here[i].u, eye.x));
            vs[i] = glm::vec4(Vec4(here[i].v, eye.y));
        }
        program.set("nacre_virtual_count", static_cast<int>(here.size()));
        program.set("nacre_virtual_layer", static_cast<int>(first));
        program.set("nacre_virtual_place", std::span<const glm::vec4>(places));
        program.set("nacre_virtual_normal", std::span<const glm::vec4>(normals));
        program.set("nacre_virtual_power", std::span<const glm::vec4>(powers));
        program.set("nacre_virtual_u", std::span<const glm::vec4>(us));
        program.set("nacre_virtual_v", std::span<const glm::vec4>(vs));
        drawFullscreen(empty);
    }
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    checkGl("adding virtual lights");
}

}  // namespace nacre
