#include "demos/viewer/scene_edits.hpp"

#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "factorize/models/models.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

int indexOf(const std::vector<SceneMaterial>& materials, const std::string& model, int brdf) {
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const SceneMaterial& m = materials[i];
        if (m.model == model && m.brdf == brdf && !m.relief && !m.surrounding) return static_cast<int>(i);
    }
    return -1;
}

std::string kindOf(const fs::path& file) {
    try {
        Imf::MultiPartInputFile input(file.c_str(), 1);
        const auto* text = input.header(0).findTypedAttribute<Imf::StringAttribute>("nacre");
        return text == nullptr ? "" : nlohmann::json::parse(text->value()).value("kind", "");
    } catch (const std::exception&) {  // no asset
        return {};
    }
}

/// Distance along the ray [its direction's length], or < 0 where it misses. Möller & Trumbore 1997, both faces.
double hitTriangle(const Vec3& origin, const Vec3& direction, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, p = glm::cross(direction, ac);
    const double det = glm::dot(ab, p);
    if (det == 0) return -1;
    const Vec3 t = origin - a, q = glm::cross(t, ab);
    const double u = glm::dot(t, p) / det, v = glm::dot(direction, q) / det;
    return u < 0 || v < 0 || u + v > 1 ? -1 : glm::dot(ac, q) / det;
}

}  // namespace

int assetFor(SceneDescription& scene, const fs::path& file) {
    const auto same = [&](const SceneAsset& asset) {
        return fs::absolute(asset.file).lexically_normal() == fs::absolute(file).lexically_normal();
    };
    const auto known = std::find_if(scene.assets.begin(), scene.assets.end(), same);
    if (known != scene.assets.end()) return static_cast<int>(known - scene.assets.begin());
    SceneAsset added;
    added.name = file.stem().string();
    added.file = file;
    scene.assets.push_back(std::move(added));
    return static_cast<int>(scene.assets.size()) - 1;
}

int materialFor(SceneDescription& scene, const std::string& text, int like) {
    std::error_code ignored;
    const bool file = fs::is_regular_file(text, ignored);
    SceneMaterial added;
    if (file) {
        added.brdf = assetFor(scene, text);
        added.name = scene.assets[static_cast<std::size_t>(added.brdf)].name;
    } else {
        require(fs::path(text).extension() != ".exr", fmt::format("{}: expected a file, found none", text));
        makeModel(text);  // says what is wrong with it
        added.name = added.model = text;
    }
    if (const int known = indexOf(scene.materials, added.model, added.brdf); known >= 0) return known;
    if (like >= 0) added.ambient = scene.materials.at(static_cast<std::size_t>(like)).ambient;
    scene.materials.push_back(std::move(added));
    return static_cast<int>(scene.materials.size()) - 1;
}

std::vector<FoundAsset> findAssets(const std::vector<fs::path>& folders) {
    std::vector<FoundAsset> out;
    for (const fs::path& folder : folders) {
        std::error_code failure;
        for (fs::directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure)) {
            if (at->path().extension() != ".exr") continue;
            if (std::string kind = kindOf(at->path()); !kind.empty()) out.push_back({at->path(), std::move(kind)});
        }
    }
    const auto before = [](const FoundAsset& a, const FoundAsset& b) { return a.file < b.file; };
    std::sort(out.begin(), out.end(), before);
    const auto same = [](const FoundAsset& a, const FoundAsset& b) { return a.file == b.file; };
    out.erase(std::unique(out.begin(), out.end(), same), out.end());
    return out;
}

int nodeAt(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes, const Camera& camera, Vec2 pixel,
           Vec2 size) {
    const glm::dmat4 toWorld = glm::inverse(camera.projection(size.x / size.y) * camera.view());
    const auto unprojected = [&](double z) {
        const Vec4 p = toWorld * Vec4(2 * pixel.x / size.x - 1, 1 - 2 * pixel.y / size.y, z, 1);
        return Vec3(p) / p.w;
    };
    const Vec3 near = unprojected(-1), ray = unprojected(1) - near;
    int out = -1;
    double nearest = 1;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].mesh < 0) continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.nodes[i].mesh)].mesh;
        const glm::dmat4 toNode = glm::inverse(nodes.at(i));  // distances along the ray stay what they are
        const Vec3 origin(toNode * Vec4(near, 1)), direction = Mat3(toNode) * ray;
        for (const glm::uvec3& t : mesh.triangles) {
            const double hit =
                hitTriangle(origin, direction, mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]);
            if (hit < 0 || hit >= nearest) continue;
            nearest = hit;
            out = static_cast<int>(i);
        }
    }
    return out;
}

}  // namespace nacre
