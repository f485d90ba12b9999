#include "shading/hybrid/ray_scene.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <cstring>
#include <limits>

#include "core/error.hpp"
#include "core/shadow_view.hpp"

namespace nacre {
namespace {

RTCScene handle(const std::shared_ptr<void>& scene) { return static_cast<RTCScene>(scene.get()); }

template <class T>
void fill(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const std::vector<T>& values) {
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), values.size());
    if (!buffer) throw Error(fmt::format("embree: no memory for {} elements", values.size()));
    std::memcpy(buffer, values.data(), values.size() * sizeof(T));
}

void attach(RTCDevice device, RTCScene scene, const Mesh& mesh, unsigned id) {
    const std::shared_ptr<RTCGeometryTy> geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE),
                                                  rtcReleaseGeometry);
    fill(geometry.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.positions);
    fill(geometry.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(scene, geometry.get(), id);
}

RTCRay rayOf(const Vec3& from, const Vec3& direction, double near, double far) {
    RTCRay ray{};
    ray.org_x = static_cast<float>(from.x), ray.org_y = static_cast<float>(from.y);
    ray.org_z = static_cast<float>(from.z);
    ray.dir_x = static_cast<float>(direction.x), ray.dir_y = static_cast<float>(direction.y);
    ray.dir_z = static_cast<float>(direction.z);
    ray.tnear = static_cast<float>(near), ray.tfar = static_cast<float>(far);
    ray.mask = ~0u;
    return ray;
}

}  // namespace

RayScene::RayScene(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes) {
    const std::shared_ptr<RTCDeviceTy> device(rtcNewDevice("threads=1"), rtcReleaseDevice);
    if (!device) throw Error("embree: no device");
    for (std::shared_ptr<void>* made : {&all_, &casters_}) {
        *made = {rtcNewScene(device.get()), [device](void* s) { rtcReleaseScene(static_cast<RTCScene>(s)); }};
        rtcSetSceneFlags(handle(*made), RTC_SCENE_FLAG_ROBUST);
    }
    Bounds bounds;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const SceneNode& node = scene.nodes[i];
        if (node.mesh < 0) continue;
        Mesh part = transformed(scene.meshes.at(static_cast<std::size_t>(node.mesh)).mesh, nodes.at(i));
        if (part.triangles.empty()) continue;
        const auto id = static_cast<unsigned>(parts_.size());
        attach(device.get(), handle(all_), part, id);
        if (node.castsShadow) attach(device.get(), handle(casters_), part, id);
        for (const glm::vec3& p : part.positions) bounds.add(Vec3(p));
        parts_.push_back({std::move(part), i});
    }
    rtcCommitScene(handle(all_));
    rtcCommitScene(handle(casters_));
    if (const RTCError error = rtcGetDeviceError(device.get()); error != RTC_ERROR_NONE)
        throw Error(fmt::format("embree: error {} while building", static_cast<int>(error)));
    if (!bounds.empty()) skip_ = 1e-5 * glm::length(bounds.high - bounds.low);
}

std::optional<RaySceneHit> RayScene::firstHit(const Vec3& from, const Vec3& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{rayOf(from, direction, skip_, std::numeric_limits<float>::max()), {}};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(handle(all_), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    const Part& part = parts_[query.hit.geomID];
    const glm::uvec3& t = part.mesh.triangles[query.hit.primID];
    const double u = query.hit.u, v = query.hit.v;
    const auto mixed = [&](const std::vector<glm::vec3>& values) {
        return (1 - u - v) * Vec3(values[t.x]) + u * Vec3(values[t.y]) + v * Vec3(values[t.z]);
    };
    const Vec3 a(part.mesh.positions[t.x]), b(part.mesh.positions[t.y]), c(part.mesh.positions[t.z]);
    return RaySceneHit{mixed(part.mesh.positions), glm::normalize(mixed(part.mesh.normals)),
                       glm::normalize(glm::cross(b - a, c - a)), part.node};
}

bool RayScene::blocked(const Vec3& from, const Vec3& to, bool castersAlone) const {
    const double length = glm::length(to - from);
    if (!(length > 2 * skip_)) return false;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = rayOf(from, (to - from) / length, skip_, length - skip_);
    rtcOccluded1(handle(castersAlone ? casters_ : all_), &context, &ray);
    return ray.tfar < 0;  // Embree's mark
}

}  // namespace nacre
