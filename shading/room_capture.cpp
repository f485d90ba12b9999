#include "shading/room_capture.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <map>

#include "factorize/models/models.hpp"
#include "shading/assimp_mesh.hpp"

namespace nacre {
namespace {

constexpr double kNear = 0.06;               // m; scans are about as rough
constexpr double kFacing = 0.7;              // least |cosine| between a triangle and its rectangle
constexpr std::size_t kMostBytes = 1 << 28;  // of an array

static_assert(std::endian::native == std::endian::little, "captures hold little-endian numbers");

/// RFC 4648's alphabet, with or without padding.
std::vector<std::uint8_t> base64(const JsonField& field) {
    const std::string text = field.text();
    std::vector<std::uint8_t> out;
    out.reserve(text.size() / 4 * 3);
    std::uint32_t bits = 0;
    int held = 0;
    const std::size_t end = text.find_last_not_of('=') + 1;
    if (text.size() - end > 2) field.fail("expected base64, found more than two signs of padding");
    for (std::size_t i = 0; i < end; ++i) {
        const char c = text[i];
        const int value = c >= 'A' && c <= 'Z'   ? c - 'A'
                          : c >= 'a' && c <= 'z' ? c - 'a' + 26
                          : c >= '0' && c <= '9' ? c - '0' + 52
                          : c == '+'             ? 62
                          : c == '/'             ? 63
                                                 : -1;
        if (value < 0) field.fail(fmt::format("expected base64, found another sign at {}", i));
        bits = bits << 6 | static_cast<std::uint32_t>(value);
        held += 6;
        if (held < 8) continue;
        held -= 8;
        out.push_back(static_cast<std::uint8_t>(bits >> held));
    }
    return out;
}

template <typename T>
std::vector<T> numbers(const JsonField& field) {
    const std::vector<std::uint8_t> bytes = base64(field);
    if (bytes.size() % sizeof(T) != 0 || bytes.size() > kMostBytes)
        field.fail(fmt::format("expected numbers of {} bytes each, {} bytes at most, found {} bytes", sizeof(T),
                               kMostBytes, bytes.size()));
    std::vector<T> out(bytes.size() / sizeof(T));
    if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
}

struct Frame {
    glm::dquat rotation;
    Vec3 position;

    Vec3 toWorld(const Vec3& local) const { return rotation * local + position; }
    Vec3 toLocal(const Vec3& world) const { return glm::conjugate(rotation) * (world - position); }
};

Vec3 vectorOf(const JsonField& field) {
    return {field.at("x").number(), field.at("y").number(), field.at("z").number()};
}

Frame frameOf(const JsonField& entity) {
    const JsonField place = entity.at("locatable_META"), turn = place.at("orientation");
    const glm::dquat q(turn.at("w").number(), vectorOf(turn));
    if (!(std::abs(glm::length(q) - 1) < 1e-3))
        turn.fail(fmt::format("expected a quaternion of length 1, found length {:g}", glm::length(q)));
    return {glm::normalize(q), vectorOf(place.at("position"))};
}

/// What a label stands for: a box, or a rectangle in its frame's plane y = 0.
struct Labelled {
    std::string label;
    Frame frame;
    Vec3 low, high;
    bool flat = false;
    double size = 0;  ///< m³, rectangles taken 2 kNear thick

    bool holds(const Vec3& middle, const Vec3& normal) const {
        const Vec3 local = frame.toLocal(middle);
        for (int c = 0; c < 3; ++c)
            if (local[c] < low[c] - kNear || local[c] > high[c] + kNear) return false;
        return !flat || std::abs(glm::dot(normal, frame.rotation * Vec3(0, 1, 0))) > kFacing;
    }
};

std::optional<Labelled> labelledOf(const JsonField& entity, const std::string& label) {
    const auto flat = entity.find("bounded2D_META"), box = entity.find("bounded3D_META");
    if (!flat && !box) return std::nullopt;
    const JsonField offset = (box ? *box : *flat).at("offset"), extent = (box ? *box : *flat).at("extent");
    const Vec3 low = box ? vectorOf(offset) : Vec3(offset.at("x").number(), 0, offset.at("y").number());
    const double width = extent.at("width").number(0), height = extent.at("height").number(0);
    const Vec3 size = box ? Vec3(width, height, extent.at("depth").number(0)) : Vec3(width, 0, height);
    return Labelled{label, frameOf(entity), low, low + size, !box, size.x * std::max(size.y, 2 * kNear) * size.z};
}

void appendMesh(Mesh& out, const JsonField& entity, const JsonField& mesh) {
    const Frame frame = frameOf(entity);
    const JsonField at = mesh.at("vertices"), of = mesh.at("indices");
    const std::vector<float> places = numbers<float>(at);
    const std::vector<std::uint32_t> indices = numbers<std::uint32_t>(of);
    if (places.size() % 3 != 0) at.fail(fmt::format("expected three numbers a vertex, found {}", places.size()));
    if (indices.size() % 3 != 0) of.fail(fmt::format("expected three indices a triangle, found {}", indices.size()));
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    for (std::size_t i = 0; i < places.size(); i += 3) {
        out.positions.emplace_back(frame.toWorld({places[i], places[i + 1], places[i + 2]}));
        if (!isFinite(Vec3(out.positions.back())))
            at.fail(fmt::format("expected finite numbers, found others in vertex {}", i / 3));
    }
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        for (std::size_t k = i; k < i + 3; ++k)
            if (indices[k] >= places.size() / 3)
                of.fail(fmt::format("expected indices below {}, found {}", places.size() / 3, indices[k]));
        out.triangles.emplace_back(first + indices[i], first + indices[i + 1], first + indices[i + 2]);
    }
}

const std::string& labelOf(const std::vector<Labelled>& bySize, const Mesh& mesh, const glm::uvec3& t) {
    static const std::string kOther = "OTHER";
    const Vec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    const Vec3 cross = glm::cross(b - a, c - a), middle = (a + b + c) / 3.0;
    const double area = glm::length(cross);
    const Vec3 normal = area > 0 ? cross / area : Vec3(0);
    for (const Labelled& thing : bySize)
        if (thing.holds(middle, normal)) return thing.label;
    return kOther;
}

SceneMaterial materialOf(const std::string& label) {
    static const std::map<std::string, const char*> kAlbedos = {
        {"CEILING", "0.8"},           {"WALL_FACE", "0.7/0.68/0.62"}, {"FLOOR", "0.4/0.3/0.2"},
        {"TABLE", "0.5/0.36/0.22"},   {"COUCH", "0.2/0.3/0.45"},      {"SCREEN", "0.05"},
        {"PLANT", "0.12/0.3/0.08"},   {"STORAGE", "0.6/0.55/0.5"},    {"LAMP", "0.8/0.75/0.6"},
        {"WALL_ART", "0.5/0.2/0.15"}, {"DOOR_FRAME", "0.5/0.4/0.3"},  {"WINDOW_FRAME", "0.55/0.65/0.75"}};
    const auto known = kAlbedos.find(label);
    SceneMaterial out;
    out.name = label;
    out.model = makeModel(fmt::format("lambert:kd={}", known == kAlbedos.end() ? "0.5" : known->second)).source;
    return out;
}

/// The triangles with one label, with vertices of their own.
Mesh partOf(const Mesh& whole, const std::vector<glm::uvec3>& triangles) {
    constexpr std::uint32_t kNone = ~0u;
    Mesh out;
    std::vector<std::uint32_t> places(whole.positions.size(), kNone);
    for (glm::uvec3 t : triangles) {
        for (int k = 0; k < 3; ++k) {
            std::uint32_t& place = places[t[k]];
            if (place == kNone) {
                place = static_cast<std::uint32_t>(out.positions.size());
                out.positions.push_back(whole.positions[t[k]]);
            }
            t[k] = place;
        }
        out.triangles.push_back(t);
    }
    out.normals.assign(out.positions.size(), glm::vec3(0));
    out.uvs.assign(out.positions.size(), glm::vec2(0));
    return out;
}

/// Whether a point is in the air of a closed room, whose triangles face it from all sides: by their solid angles (Van
/// Oosterom, Strackee 1983).
bool isInside(const Mesh& room, const Vec3& point) {
    double sum = 0;
    for (const glm::uvec3& t : room.triangles) {
        const Vec3 a = Vec3(room.positions[t.x]) - point, b = Vec3(room.positions[t.y]) - point,
                   c = Vec3(room.positions[t.z]) - point;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        sum += 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                              la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return std::abs(sum) > 2 * kPi;
}

/// At 62 % of the room's height, in that corner of its box, or middle of a side, from where there is most to see;
/// towards the middle, a little down.
Camera cameraIn(const Mesh& room, const Vec3& low, const Vec3& high) {
    const Vec3 middle = 0.5 * (low + high), half = 0.5 * (high - low);
    Camera out;
    out.eye = middle;
    out.target = middle - Vec3(0.1 * half.x, 0.3 * half.y, half.z);
    double most = 0;
    for (int x = -1; x <= 1; ++x)
        for (int z = -1; z <= 1; ++z) {
            const Vec3 eye = middle + Vec3(0.75 * x * half.x, 0.24 * half.y, 0.75 * z * half.z);
            const double far = glm::length(eye - middle);
            if (far <= most || !isInside(room, eye)) continue;
            most = far;
            out.eye = eye;
            out.target = middle - Vec3(0.5 * (eye.x - middle.x), 0.3 * half.y, 0.5 * (eye.z - middle.z));
        }
    out.fovY = 1.2;
    out.near = 0.01 * glm::length(half);
    out.far = 4 * glm::length(half);
    return out;
}

/// 40 cm below the ceiling's middle, or a fifth of a low room's height; bright enough for the floor.
SceneLight lampIn(const Vec3& low, const Vec3& high) {
    const double height = high.y - low.y, below = std::min(0.4, 0.2 * height);
    SceneLight out;
    out.name = "lamp";
    out.light.directional = false;
    out.light.position = {0.5 * (low.x + high.x), high.y - below, 0.5 * (low.z + high.z)};
    out.light.color = Rgb(1, 0.95, 0.85) * sqr(height - below) * 2.5;
    out.area = LightArea{{0.1 * height, 0, 0}, {0, 0, 0.1 * height}};
    out.shadow = SceneShadow{};
    return out;
}

}  // namespace

bool isRoomCapture(const nlohmann::json& document) {
    return document.is_object() && document.contains("spatialEntities");
}

ImportedScene roomCapture(const JsonField& root, const std::filesystem::path& path,
                          const std::function<void(const std::string&)>& note) {
    std::vector<Labelled> things;
    Mesh whole;
    for (const JsonField& entity : root.at("spatialEntities").items()) {
        const std::string label = entity.at("semanticLabel_META").text();
        if (const auto mesh = entity.find("triangleMesh_META")) appendMesh(whole, entity, *mesh);
        if (auto thing = labelledOf(entity, label)) things.push_back(std::move(*thing));
    }
    std::stable_sort(things.begin(), things.end(), [](const auto& a, const auto& b) { return a.size < b.size; });
    std::map<std::string, std::vector<glm::uvec3>> parts;
    for (const glm::uvec3& t : whole.triangles) parts[labelOf(things, whole, t)].push_back(t);

    ImportedScene out;
    out.scene.file = path;
    std::size_t degenerate = 0;
    for (const auto& [label, triangles] : parts) {
        Mesh mesh = partOf(whole, triangles);
        degenerate += completeMesh(mesh, false).degenerateTriangles;
        if (mesh.triangles.empty()) continue;
        const int index = static_cast<int>(out.scene.meshes.size());
        out.scene.meshes.push_back({label, std::move(mesh)});
        out.scene.materials.push_back(materialOf(label));
        SceneNode node;
        node.name = label;
        node.mesh = node.material = index;
        out.scene.nodes.push_back(std::move(node));
    }
    if (out.scene.meshes.empty()) root.fail("expected triangles, found none with area");
    Vec3 low(whole.positions.front()), high = low;
    for (const glm::vec3& p : whole.positions) low = glm::min(low, Vec3(p)), high = glm::max(high, Vec3(p));
    out.scene.camera = cameraIn(whole, low, high);
    out.hasCamera = true;
    out.lamp = lampIn(low, high);
    if (degenerate > 0 && note) note(fmt::format("{}: left out: {} triangles without area", path.string(), degenerate));
    return out;
}

}  // namespace nacre
