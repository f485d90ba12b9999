#include "shading/multipass/pass_schedule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "shading/multipass/rough_face.hpp"

namespace nacre {
namespace {

/// A window smaller than this, on a picture of edge 2, has no sample of a picture of 16384².
constexpr double kLeastArea = 1e-10;

/// Passes for each view that options allow: each adds all lights.
constexpr std::size_t kPassesAView = 25;

/// What may leave a face on the way back from the eye.
struct Branch {
    Bounce bounce;
    Rgb factor;
    bool weighted = false;  ///< by Fresnel
    SpecularView view;      ///< without depths
    int shear = -1;
};

int stepOf(int face, Bounce bounce) { return 2 * face + (bounce == Bounce::Refracted ? 1 : 0); }

class Scheduler {
public:
    Scheduler(PassSchedule& out, const ScheduleInput& input, const SpecularOptions& options)
        : out_(out), input_(input), options_(options) {}

    void start() {
        ScheduledView first;
        first.view = viewOf(input_.camera, double(input_.width) / input_.height);
        first.window = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        first.near = input_.camera.near;
        if (input_.camera.orthographic) first.near += depthOf(first.view, input_.camera.eye);
        first.scissor = {0, 0, input_.width, input_.height};
        out_.views.push_back(std::move(first));
        draw(0);
    }

private:
    ScheduledView& at(int view) { return out_.views[static_cast<std::size_t>(view)]; }
    const SpecularFace& faceAt(int face) const { return out_.faces[static_cast<std::size_t>(face)]; }

    void add(PassKind kind, int view, int face, int stencil, const PixelRect& scissor) {
        out_.passes.push_back({kind, view, face, stencil, scissor, -1});
    }

    /// A view and all that is seen in it.
    void draw(int view) {
        const int level = at(view).level;
        out_.deepest = std::max(out_.deepest, level);
        add(PassKind::Surfaces, view, -1, level, at(view).scissor);
        if (out_.passes.size() + out_.lights.size() > kPassesAView * options_.most)
            throw Error(
                fmt::format("specular views: expected at most {} passes, found more at depth {} with {} lights "
                            "in each view",
                            kPassesAView * options_.most, options_.depth, out_.lights.size()));
        for (std::size_t i = 0; i < out_.lights.size(); ++i) {
            if (!mayLight(view, out_.lights[i])) continue;
            add(PassKind::Light, view, -1, level, at(view).scissor);
            out_.passes.back().light = static_cast<int>(i);
        }
        if (level == options_.depth) return;
        for (std::size_t f = 0; f < out_.faces.size(); ++f) drawFace(view, static_cast<int>(f));
    }

    /// False where all that is seen behind the view's face is behind the plane from which an image's light goes on.
    bool mayLight(int view, const ScheduledLight& light) {
        const ScheduledView& seen = at(view);
        if (!light.image || seen.parent < 0) return true;
        const Plane& ahead = light.image->stages.back().within.front();
        const Vec4 eye = seen.view.eye;
        for (const Vec2& place : seen.window) {
            const auto p = planePointAt(at(seen.parent).view, faceAt(seen.face).plane, place);
            if (!p) return true;
            const Vec3 along = glm::normalize(*p * eye.w - Vec3(eye));
            const double rounding = 1e-9 * (1 + glm::length(*p));
            if (glm::dot(ahead, Vec4(*p, 1)) > rounding || glm::dot(Vec3(ahead), along) > 1e-9) return true;
        }
        return false;
    }

    void drawFace(int view, int face) {
        // Nothing that leaves a plane meets it again.
        if (face == at(view).face || sideOf(at(view).view, faceAt(face).plane) == 0) return;
        const std::vector<Vec2> window = windowOf(view, face);
        if (window.empty()) {
            ++out_.unseen;
            return;
        }
        std::vector<Branch> branches = branchesOf(view, face, window);
        dropHidden(pathOf(out_, view), face, branches);
        if (branches.empty()) return;
        const PixelRect scissor = boxOf(window);
        const int level = at(view).level;
        add(PassKind::Mask, view, face, level, scissor);
        const SceneSpecular& specular = faceAt(face).specular;
        bool adds = at(view).adds || specular.surface > 0 || at(view).light.fogDistance > 0;
        for (const Branch& branch : branches) {
            ScheduledView next;
            next.view = branch.view;
            next.level = level + 1;
            next.parent = view;
            next.face = face;
            next.bounce = branch.bounce;
            next.light = {at(view).light.factor * branch.factor, specular.fog, specular.fogDistance, {}};
            next.weighted = at(view).weighted || at(view).light.fogDistance > 0 || branch.weighted ||
                            (specular.texture && specular.surface > 0);
            next.shear = branch.shear;
            next.adds = adds;
            next.window = window;
            next.scissor = scissor;
            fitDepths(view, next);
            if (out_.views.size() == options_.most)
                throw Error(fmt::format("specular views: expected at most {}, found more at depth {}", options_.most,
                                        options_.depth));
            next.light.filters = filtersOf(next);
            const int index = static_cast<int>(out_.views.size());
            out_.views.push_back(std::move(next));
            add(PassKind::Clear, view, face, level + 1, scissor);
            if (at(index).weighted) add(PassKind::Weight, index, -1, level + 1, scissor);
            out_.hasWeights = out_.hasWeights || at(index).weighted;
            draw(index);
            adds = true;
        }
        add(PassKind::Unmask, view, face, level + 1, scissor);
    }

    /// Each face's point is the one that the next view, or what is seen, is projected onto it.
    std::vector<PlacedImage> filtersOf(const ScheduledView& seen) {
        std::vector<PlacedImage> out;
        glm::dmat4 onto(1);
        for (const ScheduledView* v = &seen; v->parent >= 0; v = &at(v->parent)) {
            const SpecularFace& face = faceAt(v->face);
            onto = projectionFrom(v->view.eye, face.plane) * onto;
            if (face.specular.filter && filtersLight(face.specular, v->bounce))
                out.push_back(placedImage(face.image, onto));
        }
        if (out.size() > static_cast<std::size_t>(kMostFilters))
            throw Error(fmt::format("specular views: expected at most {} faces with a filter on a path, found {}",
                                    kMostFilters, out.size()));
        return out;
    }

    void dropHidden(std::vector<int> path, int face, std::vector<Branch>& branches) const {
        if (options_.hidden.empty()) return;
        path.push_back(0);
        branches.erase(std::remove_if(branches.begin(), branches.end(),
                                      [&](const Branch& branch) {
                                          path.back() = stepOf(face, branch.bounce);
                                          return std::find(options_.hidden.begin(), options_.hidden.end(), path) !=
                                                 options_.hidden.end();
                                      }),
                       branches.end());
    }

    /// Where the face is seen, hidden parts included.
    std::vector<Vec2> windowOf(int view, int face) {
        const ScheduledView& in = at(view);
        std::vector<Vec3> outline = faceAt(face).outline;
        if (in.view.clip)
            outline = clipped(outline, [&](const Vec3& p) { return glm::dot(*in.view.clip, Vec4(p, 1)); });
        outline = clipped(outline, [&](const Vec3& p) { return depthOf(in.view, p) - in.near; });
        std::vector<Vec2> window;
        for (const Vec3& p : outline) {
            const Vec4 clip = in.view.toClip * Vec4(p, 1);
            if (!(clip.w > 0)) return {};
            window.emplace_back(clip.x / clip.w, clip.y / clip.w);
        }
        if (twiceArea(window) < 0) std::reverse(window.begin(), window.end());
        for (std::size_t i = 0; i < in.window.size() && !window.empty(); ++i) {
            const Vec2 a = in.window[i], along = in.window[(i + 1) % in.window.size()] - a;
            window = clipped(window, [&](const Vec2& p) { return along.x * (p.y - a.y) - along.y * (p.x - a.x); });
        }
        return twiceArea(window) < kLeastArea ? std::vector<Vec2>() : window;
    }

    PixelRect boxOf(const std::vector<Vec2>& window) const {
        Vec2 low(1), high(-1);
        for (const Vec2& p : window) low = glm::min(low, p), high = glm::max(high, p);
        const Vec2 size(input_.width, input_.height);
        const Vec2 from = glm::max(glm::floor((0.5 * low + 0.5) * size) - 1.0, Vec2(0));
        const Vec2 to = glm::min(glm::ceil((0.5 * high + 0.5) * size) + 1.0, size);
        return {int(from.x), int(from.y), int(to.x - from.x), int(to.y - from.y)};
    }

    static Vec2 middleOf(const std::vector<Vec2>& window) {
        Vec2 sum(0);
        double weight = 0;
        for (std::size_t i = 1; i + 1 < window.size(); ++i) {
            const Vec2 a = window[i] - window[0], b = window[i + 1] - window[0];
            const double area = a.x * b.y - a.y * b.x;
            sum += area * (window[0] + window[i] + window[i + 1]) / 3.0;
            weight += area;
        }
        return sum / weight;
    }

    /// Where the ray of the incident angle meets the face's plane.
    Vec3 incidentPoint(int view, int face, const std::vector<Vec2>& window) {
        const bool axis = options_.angle == RefractionAngle::ViewAxis;
        const auto point = planePointAt(at(view).view, faceAt(face).plane, axis ? Vec2(0) : middleOf(window));
        return point.value_or(faceAt(face).centre());
    }

    /// Refraction first: where both are drawn, it is most of the light.
    std::vector<Branch> branchesOf(int view, int face, const std::vector<Vec2>& window) {
        const SpecularFace& f = faceAt(face);
        const SceneSpecular& s = f.specular;
        const SpecularView& from = at(view).view;
        const double rest = s.texture ? 1 : 1 - s.surface;  // a texture's is in alpha
        const Rgb reflection = rest * s.reflection, transmission = rest * s.transmission;
        std::vector<Branch> out;
        const auto reflects = [&](bool weighted) {
            if (reflection != Rgb(0))
                out.push_back({Bounce::Reflected, reflection, weighted, reflected(from, f.plane), at(view).shear});
        };
        if (!s.ior) {
            reflects(false);
            return sheared(view, face, window, std::move(out));
        }
        const double eta = sideOf(from, f.plane) > 0 ? *s.ior : 1 / *s.ior;
        const bool total = !refractedEye(from, f.plane, f.centre(), eta, options_.eye);
        std::optional<Vec4> eye = refractedEye(from, f.plane, incidentPoint(view, face, window), eta, options_.eye);
        // PR94: the face's centre decides; the view vector's angle may be past the critical one where that isn't.
        if (!s.partial && !eye && !total) eye = refractedEye(from, f.plane, f.centre(), eta, options_.eye);
        const bool refracts = s.partial ? eye.has_value() : !total;
        if (refracts && transmission != Rgb(0))
            out.push_back({Bounce::Refracted, transmission, s.partial && eta != 1, refracted(from, f.plane, *eye),
                           at(view).shear});
        if (s.partial ? eta != 1 && (options_.partial || total) : total) reflects(s.partial);
        return sheared(view, face, window, std::move(out));
    }

    /// Frosted and glossy faces: many views for one; but one for one where the path has been split already.
    std::vector<Branch> sheared(int view, int number, const std::vector<Vec2>& window, std::vector<Branch> branches) {
        const SpecularFace& face = faceAt(number);
        if (!face.specular.scatters()) return branches;
        const int before = at(view).shear, count = before < 0 ? options_.shears : 1;
        const int side = sideOf(at(view).view, face.plane);
        const Vec3 towards = towardsEye(at(view).view, incidentPoint(view, number, window));
        std::vector<Branch> out;
        for (const Branch& branch : branches)
            for (int i = 0; i < count; ++i) {
                // A second face takes its samples in another order.
                const int sample = before < 0 ? i : (before * 7 + 3) % options_.shears;
                const Vec2 facet = facetSample(sample, options_.sampling);
                FacetShear shear{face.specular.spread * facet, 1, {}};
                if (face.specular.roughness > 0) {
                    std::optional<double> eta;
                    if (branch.bounce == Bounce::Refracted)
                        eta = side > 0 ? *face.specular.ior : 1 / *face.specular.ior;
                    shear = facetShear(towards, face.plane, eta, face.specular.roughness, facet);
                    if (shear.weight == 0) continue;
                }
                Branch next = branch;
                next.factor *= shear.weight / double(count);
                next.shear = sample;
                next.view = seenFrom(at(view).view, face.plane, shearedEye(branch.view.eye, face.plane, shear.slope),
                                     branch.bounce == Bounce::Reflected ? side : -side, branch.view.mirrored);
                out.push_back(std::move(next));
            }
        return out;
    }

    /// From the nearest point of the face to the farthest of the scene.
    void fitDepths(int parent, ScheduledView& next) {
        double near = INFINITY, far = -INFINITY;
        for (const Vec2& place : next.window)
            if (const auto p = planePointAt(at(parent).view, faceAt(next.face).plane, place))
                near = std::min(near, depthOf(next.view, *p));
        for (int corner = 0; corner < 8; ++corner)
            far = std::max(far, depthOf(next.view, {corner & 1 ? input_.high.x : input_.low.x,
                                                    corner & 2 ? input_.high.y : input_.low.y,
                                                    corner & 4 ? input_.high.z : input_.low.z}));
        const bool perspective = next.view.eye.w != 0;
        if (!std::isfinite(near) || (perspective && near <= 0)) near = perspective ? input_.camera.near : 0;
        near -= 1e-3 * std::abs(near);  // the face itself and what touches it stay in
        far += 1e-3 * std::abs(far);
        if (!(far > near + 1e-6 * std::abs(near))) far = near + std::max(std::abs(near), 1e-6);
        next.near = near;
        setDepths(next.view, near, far);
        if (!options_.keepDepth && !next.adds && next.bounce == Bounce::Refracted) flattenDepths(next.view);
    }

    PassSchedule& out_;
    const ScheduleInput& input_;
    const SpecularOptions& options_;
};

}  // namespace

PassSchedule makeSchedule(std::vector<SpecularFace> faces, const ScheduleInput& input, const SpecularOptions& options) {
    require(
        input.width >= 1 && input.height >= 1 && options.depth >= 0 && options.stencilBits >= 1 && options.shears >= 1,
        "makeSchedule: sizes, shears and stencil bits must be >= 1, depth >= 0");
    const StencilCounter counter{options.stencilBits};
    if (!faces.empty() && options.depth > counter.deepest())
        throw Error(
            fmt::format("specular depth: expected at most {} with {} bits of stencil, half of whose range "
                        "counts shadows, found {}",
                        counter.deepest(), options.stencilBits, options.depth));
    if (!input.lights.empty() && !options.keepDepth)
        throw Error("light added by passes: expected views that keep depth, found flattened ones");
    PassSchedule out;
    out.faces = std::move(faces);
    out.lights = input.lights;
    Scheduler(out, input, options).start();
    return out;
}

bool maySee(const ScheduledView& view, int width, int height, const Vec3& centre, double radius) {
    const glm::dmat4 rows = glm::transpose(view.view.toClip);
    const PixelRect& r = view.scissor;
    const double left = 2.0 * r.x / width - 1, right = 2.0 * (r.x + r.width) / width - 1;
    const double bottom = 2.0 * r.y / height - 1, top = 2.0 * (r.y + r.height) / height - 1;
    const Vec4 planes[] = {rows[0] - left * rows[3], right * rows[3] - rows[0], rows[1] - bottom * rows[3],
                           top * rows[3] - rows[1], view.view.clip.value_or(Plane(0, 0, 0, 1))};
    return std::all_of(std::begin(planes), std::end(planes), [&](const Vec4& plane) {
        return glm::dot(plane, Vec4(centre, 1)) >= -radius * glm::length(Vec3(plane));
    });
}

double nearestDepth(const SpecularView& view, const Vec3& centre, double radius) {
    const Vec3 slope = view.eye.w == 0 ? Vec3(view.eye) : Vec3(view.toClip[0][3], view.toClip[1][3], view.toClip[2][3]);
    return depthOf(view, centre) - radius * glm::length(slope);
}

std::vector<int> pathOf(const PassSchedule& schedule, int view) {
    const ScheduledView& v = schedule.views[static_cast<std::size_t>(view)];
    if (v.parent < 0) return {};
    std::vector<int> path = pathOf(schedule, v.parent);
    path.push_back(stepOf(v.face, v.bounce));
    return path;
}

}  // namespace nacre
