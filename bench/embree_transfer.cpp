#include "bench/embree_transfer.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/math.hpp"
#include "core/parallel.hpp"
#include "envmaps/spherical_harmonics.hpp"
#include "reference/transfer_trace.hpp"

namespace nacre::bench {
namespace {

constexpr int kOrder = 4;
constexpr std::size_t kCoefficients = 25, kPacket = 16;

/// Sixteen directions and their harmonics.
struct Packet {
    alignas(64) float x[kPacket], y[kPacket], z[kPacket];
    float harmonics[kPacket][32];
};

/// Cosine-distributed: the disk's golden-angle spiral (Vogel 1979).
std::vector<Packet> packetsOf(std::size_t rays) {
    std::vector<Vec3> directions;
    for (std::size_t k = 0; k < rays; ++k) {
        const double u = (static_cast<double>(k) + 0.5) / static_cast<double>(rays), r = std::sqrt(u);
        const double phi = kPi * (3 - std::sqrt(5.0)) * static_cast<double>(k);
        directions.emplace_back(r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u));
    }
    // Packets of neighbours, sector by sector: a tenth to a quarter faster here than the spiral's order.
    const double sectors = std::floor(std::sqrt(static_cast<double>(rays) / kPacket));
    const auto sector = [&](const Vec3& d) { return std::floor((std::atan2(d.y, d.x) / (2 * kPi) + 0.5) * sectors); };
    std::sort(directions.begin(), directions.end(),
              [&](const Vec3& a, const Vec3& b) { return sector(a) != sector(b) ? sector(a) < sector(b) : a.z < b.z; });
    std::vector<Packet> packets(rays / kPacket);
    for (std::size_t k = 0; k < rays; ++k) {
        Packet& packet = packets[k / kPacket];
        const std::size_t lane = k % kPacket;
        packet.x[lane] = static_cast<float>(directions[k].x);
        packet.y[lane] = static_cast<float>(directions[k].y);
        packet.z[lane] = static_cast<float>(directions[k].z);
        const std::vector<double> y = realHarmonics(kOrder, directions[k]);
        for (std::size_t c = 0; c < 32; ++c)
            packet.harmonics[lane][c] = c < y.size() ? static_cast<float>(y[c] / static_cast<double>(rays)) : 0.0f;
    }
    return packets;
}

/// Turned about the normal by the golden ratio's multiples, so that neighbours err differently.
Receiver receiverAt(const glm::vec3& point, const glm::vec3& normal, std::size_t vertex) {
    const glm::vec3 side = std::abs(normal.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    const glm::vec3 t = glm::normalize(glm::cross(side, normal)), b = glm::cross(normal, t);
    const double turn = 2 * kPi * std::fmod(0.6180339887498949 * static_cast<double>(vertex), 1.0);
    const auto c = static_cast<float>(std::cos(turn)), s = static_cast<float>(std::sin(turn));
    return {point, c * t + s * b, c * b - s * t, normal};
}

}  // namespace

struct EmbreeTransfer::State {
    std::vector<glm::uvec3> triangles;
    CornersOfVertices corners;
    std::vector<Packet> packets;
    std::vector<double> open = openTransfer(kOrder);
    HarmonicRotation rotation{kOrder};
    std::shared_ptr<RTCDeviceTy> device;
    std::shared_ptr<RTCSceneTy> scene;
    std::shared_ptr<RTCGeometryTy> geometry;
    float* vertices = nullptr;  ///< the geometry's

    State(const WeldedMesh& mesh, std::size_t rays);
    void traceHidden(const Receiver& receiver, const glm::vec3& from, float far, float* hidden) const;
};

EmbreeTransfer::State::State(const WeldedMesh& mesh, std::size_t rays)
    : triangles(mesh.triangles),
      corners(cornersOfVertices(mesh.triangles, mesh.vertexCount())),
      packets(packetsOf(rays)),
      device(rtcNewDevice(nullptr), rtcReleaseDevice) {
    if (!device) throw Error(fmt::format("embree: no device (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
    scene = {rtcNewScene(device.get()), rtcReleaseScene};
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_LOW);
    geometry = {rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE), rtcReleaseGeometry};
    rtcSetGeometryBuildQuality(geometry.get(), RTC_BUILD_QUALITY_LOW);
    vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                           sizeof(glm::vec3), mesh.vertexCount()));
    void* indices = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(glm::uvec3), triangles.size());
    if (vertices == nullptr || indices == nullptr) throw Error("embree: no memory for the mesh");
    std::copy(triangles.begin(), triangles.end(), static_cast<glm::uvec3*>(indices));
    rtcAttachGeometry(scene.get(), geometry.get());
}

void EmbreeTransfer::State::traceHidden(const Receiver& receiver, const glm::vec3& from, float far,
                                        float* hidden) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;  // coherent is slower here at any order
    alignas(64) int valid[kPacket];
    std::fill_n(valid, kPacket, -1);
    const glm::vec3 &t = receiver.tangent, &b = receiver.bitangent, &n = receiver.normal;
    RTCRay16 rays;
    for (const Packet& packet : packets) {
        for (std::size_t i = 0; i < kPacket; ++i) {
            rays.org_x[i] = from.x, rays.org_y[i] = from.y, rays.org_z[i] = from.z;
            rays.dir_x[i] = packet.x[i] * t.x + packet.y[i] * b.x + packet.z[i] * n.x;
            rays.dir_y[i] = packet.x[i] * t.y + packet.y[i] * b.y + packet.z[i] * n.y;
            rays.dir_z[i] = packet.x[i] * t.z + packet.y[i] * b.z + packet.z[i] * n.z;
            rays.tnear[i] = rays.time[i] = 0;
            rays.tfar[i] = far;
            rays.mask[i] = ~0u;
            rays.id[i] = rays.flags[i] = 0;
        }
        rtcOccluded16(valid, scene.get(), &context, &rays);
        for (std::size_t i = 0; i < kPacket; ++i)
            if (rays.tfar[i] < 0)  // Embree's mark of an occluded ray
                for (std::size_t c = 0; c < 32; ++c) hidden[c] += packet.harmonics[i][c];
    }
}

EmbreeTransfer::EmbreeTransfer(const WeldedMesh& mesh, std::size_t rays) {
    require(rays > 0 && rays % kPacket == 0, "transfer by rays: expected a multiple of 16 rays");
    state_ = std::make_unique<State>(mesh, rays);
}
EmbreeTransfer::~EmbreeTransfer() = default;
EmbreeTransfer::EmbreeTransfer(EmbreeTransfer&&) noexcept = default;

TransferFrame EmbreeTransfer::compute(std::span<const glm::vec3> positions) const {
    const State& s = *state_;
    TransferFrame frame;
    frame.coefficients.assign(positions.size() * kCoefficients, 0);
    frame.normals = vertexNormals(s.triangles, s.corners, positions);
    std::copy_n(&positions[0].x, 3 * positions.size(), s.vertices);
    rtcUpdateGeometryBuffer(s.geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(s.geometry.get());
    rtcCommitScene(s.scene.get());
    if (const RTCError error = rtcGetDeviceError(s.device.get()); error != RTC_ERROR_NONE)
        throw Error(fmt::format("embree: error {} while building", static_cast<int>(error)));
    const float extent = extentOf(positions);
    parallelFor((positions.size() + kPacket - 1) / kPacket, 0, [&](std::size_t task) {
        const std::size_t first = task * kPacket, used = std::min(kPacket, positions.size() - first);
        Receiver receivers[kPacket];
        float local[kPacket * kCoefficients] = {}, world[kPacket * kCoefficients];
        for (std::size_t i = 0; i < used; ++i) {
            const std::size_t v = first + i;
            const glm::vec3 n = frame.normals[v] != glm::vec3(0) ? frame.normals[v] : glm::vec3(0, 0, 1);
            receivers[i] = receiverAt(positions[v], n, v);
            float hidden[32] = {};
            s.traceHidden(receivers[i], positions[v] + static_cast<float>(kTransferLift) * extent * n, 1e3f * extent,
                          hidden);
            for (std::size_t c = 0; c < kCoefficients; ++c) local[c * kPacket + i] = -hidden[c];
            for (std::size_t l = 0; l <= kOrder; ++l) local[(l * l + l) * kPacket + i] += static_cast<float>(s.open[l]);
        }
        s.rotation.turn(receivers, used, local, world);
        std::copy_n(world, used * kCoefficients, &frame.coefficients[kCoefficients * first]);
    });
    frame.computed = positions.size();
    return frame;
}

}  // namespace nacre::bench
