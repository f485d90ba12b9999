#include "demos/viewer/orbit.hpp"
#include "demos/viewer/panel.hpp"

namespace nacre {

std::vector<LightMark> lightMarks(const ViewerSession& session) {
    const Vec2 size(session.width(), session.height());
    if (size.x < 1 || size.y < 1) return {};
    const std::vector<Light> lights = lightsInWorld(session.scene(), nodeTransforms(session.scene(), session.time));
    std::vector<LightMark> out;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        LightMark mark{static_cast<int>(i), 0.5 * size};
        if (lights[i].directional) {
            const Vec3 inView = Mat3(session.camera.view()) * lights[i].position;
            mark.at += 0.4 * std::min(size.x, size.y) * Vec2(inView.x, -inView.y);
        } else {
            const Vec3 at = inPicture(session.camera, lights[i].position, size);
            if (at.z <= 0 && !session.camera.orthographic) continue;
            mark.at = Vec2(at);
        }
        const bool inside = mark.at.x >= 0 && mark.at.y >= 0 && mark.at.x < size.x && mark.at.y < size.y;
        if (inside) out.push_back(mark);
    }
    return out;
}

}  // namespace nacre
