#include "reference/embree_scene.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <cstring>
#include <limits>

#include "core/error.hpp"

namespace nacre {

namespace {

std::shared_ptr<RTCDeviceTy> makeDevice() {
    RTCDevice device = rtcNewDevice("threads=1");  // meshes here build in milliseconds; loops outside use the cores
    if (!device) throw Error(fmt::format("embree: no device (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
    return {device, rtcReleaseDevice};
}

template <typename T>
void fillBuffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const std::vector<T>& values) {
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), values.size());
    if (!buffer) throw Error(fmt::format("embree: no memory for {} elements", values.size()));
    std::memcpy(buffer, values.data(), values.size() * sizeof(T));
}

RTCRay toEmbree(const Ray& r) {
    RTCRay ray{};
    ray.org_x = static_cast<float>(r.origin.x), ray.org_y = static_cast<float>(r.origin.y);
    ray.org_z = static_cast<float>(r.origin.z);
    ray.dir_x = static_cast<float>(r.direction.x), ray.dir_y = static_cast<float>(r.direction.y);
    ray.dir_z = static_cast<float>(r.direction.z);
    ray.tnear = static_cast<float>(r.near), ray.tfar = static_cast<float>(r.far);
    ray.mask = ~0u;
    return ray;
}

RTCScene handle(const std::shared_ptr<void>& scene) { return static_cast<RTCScene>(scene.get()); }

}  // namespace

EmbreeScene::EmbreeScene(const Mesh& mesh) {
    const std::shared_ptr<RTCDeviceTy> device = makeDevice();
    scene_ = {rtcNewScene(device.get()), [device](void* s) { rtcReleaseScene(static_cast<RTCScene>(s)); }};
    const RTCScene scene = handle(scene_);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    if (!mesh.triangles.empty()) {
        const std::shared_ptr<RTCGeometryTy> geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE),
                                                      rtcReleaseGeometry);
        fillBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.positions);
        fillBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometry(scene, geometry.get());
    }
    rtcCommitScene(scene);
    if (const RTCError error = rtcGetDeviceError(device.get()); error != RTC_ERROR_NONE)
        throw Error(fmt::format("embree: error {} while building", static_cast<int>(error)));
    glm::dvec3 low(0), high(0);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3 p(mesh.positions[i]);
        low = i == 0 ? p : glm::min(low, p), high = i == 0 ? p : glm::max(high, p);
    }
    size_ = glm::length(high - low);
}

RayHit EmbreeScene::firstHit(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{toEmbree(ray), {}};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(handle(scene_), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {true, query.hit.primID, query.ray.tfar, query.hit.u, query.hit.v};
}

bool EmbreeScene::occluded(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay query = toEmbree(ray);
    rtcOccluded1(handle(scene_), &context, &query);
    return query.tfar < 0;  // Embree's mark of an occluded ray
}

}  // namespace nacre
