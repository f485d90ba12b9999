// nacre transfer: light transfer of a moving mesh's vertices, timed and measured.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cli/frame_range.hpp"
#include "cli/numbers.hpp"
#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "cli/transfer_light.hpp"
#include "cli/transfer_run.hpp"
#include "cli/verb.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/version.hpp"
#include "shading/motion.hpp"
#include "transfer/paper_method.hpp"

namespace nacre::cli {

using nlohmann::json;

namespace {

struct Settings {
    std::string model, output, clip, ply, sides = "auto", vectors = "widest", weights;
    TransferPlan plan;  ///< end 0: all
    std::optional<int> rings{};
    std::string ofLevels;    ///< the last option given that is for levels of detail alone
    std::string notWithLut;  ///< the first option given that the paper's method has no use for
    TransferLight light;
    std::size_t rays = 0;  ///< 0: no reference
    std::optional<int> referenceFrames{};
    bool asJson = false;
};

GlossPlan& gloss(Settings& s) {
    if (!s.plan.gloss) s.plan.gloss.emplace();
    return *s.plan.gloss;
}

void takeSpecular(Settings& s, const std::string& text) {
    double v[1];
    if (!parseNumbers(text, v) || !(v[0] >= 0 && v[0] <= 1))
        throw UsageError(fmt::format("expected a number 0 to 1, found '{}'", text));
    gloss(s).specular = v[0];
}

void takeNearby(Settings& s, const std::string& text) {
    double radii = 0;
    finiteInto(radii)(text);
    if (radii != 0 && radii < 1)
        throw UsageError(fmt::format("expected a number of radii, 0 or from 1 on, found '{}'", text));
    s.plan.options.nearby = radii;
}

void takeLodError(Settings& s, const std::string& text) {
    finiteInto(s.plan.options.lodError)(text);
    if (s.plan.options.lodError < 0) throw UsageError(fmt::format("expected an error of 0 or more, found '{}'", text));
    s.ofLevels = "--lod-error";
}

void takeEye(Settings& s, const std::string& text) {
    double v[3];
    const Vec3 eye = parseNumbers(text, v) ? Vec3(v[0], v[1], v[2]) : Vec3(NAN);
    if (!isFinite(eye)) throw UsageError(fmt::format("expected three finite numbers X,Y,Z, found '{}'", text));
    gloss(s).eye = eye;
}

BlockingSides sidesOf(const std::string& name) {
    return name == "front"  ? BlockingSides::Front
           : name == "fine" ? BlockingSides::Fine
           : name == "both" ? BlockingSides::Both
                            : BlockingSides::Auto;
}

const char* nameOf(BlockingSides sides) {
    return sides == BlockingSides::Front ? "front" : sides == BlockingSides::Fine ? "fine" : "both";
}

/// 3, 5-8, 12
std::string ranges(const std::vector<int>& numbers) {
    std::string out;
    for (std::size_t i = 0, last = 0; i < numbers.size(); i = last + 1) {
        for (last = i; last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1;) ++last;
        out += (i ? ", " : "") + std::to_string(numbers[i]);
        if (last > i) out += "-" + std::to_string(numbers[last]);
    }
    return out;
}

AnimatedMesh read(Settings& s) {
    MotionOptions motion;
    motion.clip = s.clip;
    // A file's whole motion, whichever frames are wanted: its poses make the groups that sets of blockers are for.
    std::error_code ignored;
    s.plan.poses = std::filesystem::is_regular_file(s.model, ignored);
    motion.frames = s.plan.poses ? 0 : s.plan.end;
    motion.note = [&](const std::string& note) { tell(fmt::format("{}: {}", s.model, note)); };
    AnimatedMesh animation = loadMotion(s.model, motion);
    const int count = static_cast<int>(animation.frames.size());
    if (s.plan.end == 0) s.plan.end = count;
    if (s.plan.end > count || s.plan.first >= s.plan.end)
        throw UsageError(fmt::format("--frames: expected frames of {}, which has {}, found {}:{}", s.model, count,
                                     s.plan.first, s.plan.end));
    return animation;
}

json errorJson(const TransferMeasure& m, std::size_t rays) {
    const TransferError& e = m.error;
    const auto ofVertices = [&](double value) { return e.vertices > 0 ? json(value) : json(); };
    return {{"l2_rel", ofVertices(e.mean)}, {"median", ofVertices(e.median)},
            {"p95", ofVertices(e.p95)},     {"total", ofVertices(e.total)},
            {"buried", e.buried},           {"rays", rays},
            {"vertices", e.vertices},       {"frames", m.frames}};
}

/// What the file says of itself besides what its numbers need: nothing that differs from run to run.
json description(const Context& context, const Settings& s, const TransferRun& run) {
    const SelfTransferOptions& o = s.plan.options;
    json out = {{"nacre", nacreVersion()},
                {"command_line", context.commandLine},
                {"source", s.model},
                {"options",
                 {{"mask", o.mask},
                  {"rings", o.rings},
                  {"coarse", run.coarse},
                  {"lod_angle", o.lodAngle},
                  {"lod_error", o.lodError},
                  {"nearby", o.nearby.value_or(usualNearby(o.mask))},
                  {"sides", nameOf(run.sides)}}},
                {"closed", run.closed},
                {"coarse_triangles", run.coarseTriangles},
                {"blockers", {{"listed", run.listed}, {"drawn", run.drawn}}},
                {"vertices_without_normal", run.withoutNormal},
                {"frames_reused", run.reused},
                {"frames_refused", run.refused}};
    if (s.plan.lut) out["options"]["lut"] = *s.plan.lut;
    if (!s.clip.empty()) out["options"]["clip"] = s.clip;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(s.model, ignored)) out["source_hash"] = fileHash(s.model);
    return out;
}

json speedJson(const TransferRun& run, const Settings& s) {
    const TransferSeconds& t = run.seconds;
    const double frames = static_cast<double>(run.recording.blocks.size());
    const std::size_t vertices = std::max<std::size_t>(run.recording.vertexCount(), 1);
    return {{"memory", {{"bytes", run.bytes}, {"bytes_per_vertex", run.bytes / vertices}}},
            {"vertices_per_second", static_cast<double>(run.computed) / run.wallSeconds},
            {"frames_per_second", frames / run.wallSeconds},
            {"compute_seconds", run.wallSeconds},
            {"vectors", s.vectors},
            {"threads", s.plan.options.threads},
            {"seconds",
             {{"rasterization", t.rasterization},
              {"integration", t.integration},
              {"transform", t.transform},
              {"other", t.other}}}};
}

std::string errorText(const json& e) {
    const auto buried = e["buried"].get<std::size_t>(), all = buried + e["vertices"].get<std::size_t>();
    if (e["l2_rel"].is_null()) return fmt::format("  error       no vertex to measure; {} of {} buried\n", buried, all);
    const auto number = [&](const char* key) { return e[key].get<double>(); };
    return fmt::format(
        "  error       l2_rel {:.4f} (median {:.4f}, p95 {:.4f}, total {:.4f}) against {} rays a vertex in {} frames; "
        "{} of "
        "{} vertices buried\n",
        number("l2_rel"), number("median"), number("p95"), number("total"), e["rays"].get<std::size_t>(),
        e["frames"].size(), buried, all);
}

std::string text(const Settings& s, const TransferRun& run, const json& data) {
    const TransferRecording& r = run.recording;
    std::string out =
        fmt::format("{}: {} frames ({} reused), {} vertices, {} triangles, order {}, {}\n", s.output, r.frames.size(),
                    run.reused, r.vertexCount(), r.triangles.size(), r.order, humanBytes(data["bytes"]));
    out += fmt::format("  speed       {:.4g} vertices/s, {:.4g} frames/s\n", data["vertices_per_second"].get<double>(),
                       data["frames_per_second"].get<double>());
    out += fmt::format("  blockers    {:.1f} triangles listed a vertex, {:.1f} {} drawn; {}, {} sides\n", run.listed,
                       run.drawn, s.plan.lut ? "of them" : "edges",
                       run.coarse == 0 ? "no levels" : fmt::format("coarsest level {} triangles", run.coarseTriangles),
                       nameOf(run.sides));
    if (run.bytes > 0)
        out += fmt::format("  memory      {} a vertex beside the tables\n",
                           humanBytes(data["memory"]["bytes_per_vertex"].get<std::size_t>()));
    const TransferSeconds& t = run.seconds;
    const double all = std::max(t.rasterization + t.integration + t.transform + t.other, 1e-30);
    out += fmt::format(
        "  time        {:.1f} % rasterization, {:.1f} % integration, {:.1f} % transform, {:.1f} % other of {:.3g} CPU "
        "s\n",
        100 * t.rasterization / all, 100 * t.integration / all, 100 * t.transform / all, 100 * t.other / all, all);
    if (run.sets)
        out += fmt::format("  pvs         {} {}, {} windows, {:.1f} % of blockers a group, {}\n",
                           run.sets->made ? "made" : "read", s.plan.visibleSets, run.sets->windows,
                           100 * run.sets->share, humanBytes(run.sets->bytes));
    if (run.withoutNormal > 0) out += fmt::format("  no normal   {} vertices: zeros\n", run.withoutNormal);
    if (data.contains("error")) out += errorText(data["error"]);
    if (data.contains("white"))
        out += fmt::format("  colours     {}, white {:.4g}\n", s.ply, data["white"].get<double>());
    return out;
}

void runTransferVerb(const Context& context, Settings s) {
    takeWeights(s.light, s.weights);
    if (s.ply.empty() && (s.light.turnDeg != 0 || s.light.white != 0))
        throw UsageError("--turn, --white: expected --ply, found none");
    if (s.plan.lut && !s.notWithLut.empty())
        throw UsageError(
            fmt::format("{}: expected no --lut, whose method is matt and has 32 x 32 bits, order 4 and one coarse mesh",
                        s.notWithLut));
    if (s.plan.gloss && s.plan.gloss->exponent == 0)
        throw UsageError("--specular, --eye: expected --glossy, found none");
    if (s.plan.gloss && !s.plan.visibleSets.empty())
        throw UsageError("--glossy: expected no --pvs, which is for matt transfer");
    s.plan.options.rings = s.rings.value_or(s.plan.lut ? PaperMethodOptions{}.rings : SelfTransferOptions{}.rings);
    // Who asks how levels are to be used wants some.
    if (!s.plan.lut && !s.ofLevels.empty() && s.plan.options.coarse == 0u)
        throw UsageError(fmt::format("{}: expected levels of detail, found --coarse 0", s.ofLevels));
    if (s.referenceFrames && s.rays == 0) throw UsageError("--reference-frames: expected --reference, found none");
    if ((s.plan.lut || !s.ofLevels.empty()) && !s.plan.options.coarse)
        s.plan.options.coarse = s.plan.lut ? PaperMethodOptions{}.coarse : kUsualCoarse;
    s.plan.options.sides = sidesOf(s.sides);
    if (s.plan.lut && s.plan.options.sides == BlockingSides::Fine)
        throw UsageError("--sides: expected auto, front or both with --lut, found 'fine'");
    s.plan.options.vectors = vectorSetFromString(s.vectors);
    maskKernel(s.plan.options.mask, s.plan.options.vectors);  // a processor without these vectors: said before the work
    requireWritable({s.model}, s.output, provisionalName(s.output), "");
    for (const auto& [flag, other] : {std::pair("--pvs", s.plan.visibleSets), {"--ply", s.ply}})
        if (!other.empty() && std::filesystem::weakly_canonical(other) == std::filesystem::weakly_canonical(s.output))
            throw UsageError(fmt::format("{}: expected another file than -o, found '{}'", flag, other));
    if (!s.ply.empty()) requirePlyPlace(s.ply, s.plan.first);
    if (s.plan.windowFrames > 0 && s.plan.visibleSets.empty())
        throw UsageError("--pvs-window: expected --pvs, found none");
    const LightCoefficients light = readLight(s.light, s.plan.options.order);
    const Progress progress = terminalProgress(context.quiet);
    report(progress, "reading " + s.model, 0);
    const Stopwatch reading;
    const AnimatedMesh animation = read(s);
    const double readSeconds = reading.seconds();
    TransferRun run = runTransfer(animation, s.plan, s.model, progress);
    if (run.joined > run.recording.weldOf.size() / 100)
        tell(fmt::format(
            "{}: {} of {} vertices are nearer to others than 1e-5 of the extent, and one with them: perhaps "
            "something is much larger than the rest",
            s.model, run.joined, run.recording.weldOf.size()));
    json& meta = run.recording.meta = description(context, s, run);
    if (!s.light.files.empty()) {
        meta["light"]["environments"] = s.light.files;
        for (const Rgb& c : light) meta["light"]["coefficients"].push_back({c.x, c.y, c.z});
    }
    if (s.rays > 0)
        meta["error"] =
            errorJson(measureTransfer(run.recording, s.rays, s.referenceFrames.value_or(8), progress), s.rays);
    const Stopwatch writing;
    writeTransfer(run.recording, s.output);
    json data = meta;
    data.update(speedJson(run, s));
    if (run.sets)
        data["pvs"] = {{"file", s.plan.visibleSets}, {"made", run.sets->made},   {"windows", run.sets->windows},
                       {"bytes", run.sets->bytes},   {"share", run.sets->share}, {"seconds", run.sets->seconds}};
    data["read_seconds"] = readSeconds;
    data["write_seconds"] = writing.seconds();
    data["bytes"] = std::filesystem::file_size(s.output);
    data["vertices"] = run.recording.vertexCount();
    data["triangles"] = run.recording.triangles.size();
    data["order"] = run.recording.order;
    data["frames"] = run.recording.frames.size();
    if (!s.ply.empty()) data["white"] = writePlyFrames(run.recording, light, s.light, s.ply, progress);
    endProgress();
    putData(s.asJson ? data.dump(2) + "\n" : text(s, run, data));
    if (run.refused.empty()) return;
    flushData();
    throw Error(fmt::format("{}: expected finite positions, found others in {} {}, refused; {} other frames are in {}",
                            s.model, run.refused.size() > 1 ? "frames" : "frame", ranges(run.refused),
                            run.recording.frames.size(), s.output));
}

constexpr const char* kDetails =
    "MODEL is an animated file (glTF, FBX, .X, MD2, IQM, ...), a mesh that stands still, or one of cloth, chess, which "
    "are\n"
    "made here. At each vertex all that blocks its hemisphere is drawn into a mask of N x N bits, which is integrated\n"
    "against spherical harmonics: V_i = integral of y_i V cos/pi. Radiance of a matt vertex is albedo x sum L_i V_i.\n"
    "OUT holds these coefficients for every frame, with the mesh; its format stands in transfer/transfer_file.hpp, "
    "and\n"
    "nacre info prints its header. Vertices that stay together are one. Frames in which nothing moves are computed "
    "once;\n"
    "a vertex without a normal gets zeros; a frame with positions that aren't finite is refused: the others are "
    "written,\n"
    "and the exit code is 1.\n"
    "With --glossy N, V is (1 - S) of the matt one + S that of (N + 2)/2pi (r.s)^N about the mirrored view r.\n"
    "Speed is wall time of the computation alone, after a frame to warm up; the split is CPU time of all threads.\n"
    "Transform: moving and listing blockers, and finding their silhouettes; lobes count as rasterization. Blockers: "
    "triangles that may block the vertex; drawn are the silhouettes' edges (with --lut triangles). Error: mean over "
    "vertices "
    "of |V - truth| / |truth|, "
    "with "
    "truth\n"
    "from --reference N rays a vertex through the full mesh; buried vertices, which see less than a hundredth, count "
    "only\n"
    "in total, the root of the sums' ratio. Both are cut at --order: what higher harmonics hold isn't counted.\n"
    "Example: the cloth's first second, in the light of a city:\n"
    "  nacre transfer cloth -o cloth.tv --frames 0:30 --reference 1024 --env city.hdr --ply cloth_####.ply";

std::vector<Option> options(const std::shared_ptr<Settings>& s) {
    const auto own = [s](const std::string& flag, std::function<void(const std::string&)> take) {
        return [s, flag, take](const std::string& given) {
            if (s->notWithLut.empty()) s->notWithLut = flag;
            take(given);
        };
    };
    return {
        {"model", "MODEL", "Animated mesh, or cloth, chess", into(s->model), true},
        {"-o,--output", "OUT", "The file to write", into(s->output), true},
        {"--frames", "A:B", "Frames A to B - 1, counted from 0 (default all)",
         [s](const std::string& given) {
             const FrameRange range = parseFrames(given);
             s->plan.first = range.first, s->plan.end = range.end;
         }},
        {"--clip", "NAME", "Of the file's animations, by name or number from 0 (default 0)", into(s->clip)},
        {"--mask",
         "N",
         "Bits a side of the hemisphere's mask (default 32: errs about 1 %; 64: a third of it, in 1.3 to 1.5 times the "
         "time; 16: 2 to 4 %, hardly faster)",
         own("--mask", [s](const std::string& given) { s->plan.options.mask = std::stoi(given); }),
         false,
         {"16", "32", "64", "128"}},
        {"--order", "L", "Highest band of the harmonics, 0 to 6 (default 4: 25 coefficients)",
         own("--order",
             integerInto([s](long long v) { s->plan.options.order = static_cast<int>(v); }, 0, kMaxTransferOrder))},
        {"--rings", "R",
         "With levels, the mesh itself blocks within so many rings of triangles, 1 or 2 (default 1; with --lut 2)",
         integerInto(
             [s](long long v) {
                 s->rings = static_cast<int>(v);
                 s->ofLevels = "--rings";
             },
             1, 2)},
        {"--coarse", "N",
         "Triangles of the coarsest level of detail, about; 0: the mesh itself everywhere, which errs less (default 0 "
         "up to 20000 triangles, else 500; with --rings, --lod-angle or --lod-error 500, with --lut 400). At 6000 "
         "triangles 1.1 to 1.3 times as fast, at 15000 twice",
         integerInto([s](long long v) { s->plan.options.coarse = static_cast<std::size_t>(v); }, 0, 1 << 30)},
        {"--lod-angle", "RAD",
         "A level is used where it is off by less, seen from the vertex (default 0.25: adds 0.5 to 1 % error)",
         own("--lod-angle", positiveInto([s](double v) {
                 s->plan.options.lodAngle = v;
                 s->ofLevels = "--lod-angle";
             }))},
        {"--lod-error", "E",
         "Vertices that err no more by it, relative to their light, in the first frame and in five of the motion see "
         "the "
         "coarsest level wherever it isn't near; the others go by --lod-angle (default 0.05: adds 0.5 % error; 0.15: "
         "1 to 2 %; 0: all go by the angle)",
         own("--lod-error", [s](const std::string& given) { takeLodError(*s, given); })},
        {"--nearby", "R",
         "Sixteen vertices share the silhouettes of what is farther than R radii, 1 or more, of their group; 0: each "
         "finds its own "
         "(default mask / 16, which takes a fifth less time and errs up to a sixth more)",
         own("--nearby", [s](const std::string& given) { takeNearby(*s, given); })},
        {"--pvs", "FILE",
         "Potentially visible sets: read from FILE where it is, else made from these frames and written there; "
         "blockers "
         "that no frame draws aren't listed: with --coarse a tenth faster, without hardly",
         own("--pvs", into(s->plan.visibleSets))},
        {"--pvs-window", "K", "Frames that share a set that is made (default all)",
         own("--pvs-window",
             integerInto([s](long long v) { s->plan.windowFrames = static_cast<int>(v); }, 1, 1 << 20))},
        {"--lut", "L",
         "HEMI's method as printed, to compare with, with a table of 6 L x L planes, to 512 (the paper's: 128); 0: "
         "exact planes",
         integerInto([s](long long v) { s->plan.lut = static_cast<int>(v); }, 0, 512)},
        {"--glossy", "N", "Phong's lobe of this exponent too, as seen from --eye: the coefficients are one viewer's",
         own("--glossy", positiveInto([s](double v) { gloss(*s).exponent = v; }))},
        {"--specular", "S", "Share of the lobe, the rest is matt (default 0.5)",
         own("--specular", [s](const std::string& given) { takeSpecular(*s, given); })},
        {"--eye", "X,Y,Z", "The viewer of --glossy (default: where nacre render looks from)",
         own("--eye", [s](const std::string& given) { takeEye(*s, given); })},
        {"--sides",
         "NAME",
         "Sides that block: front, both, fine (both of the mesh, front of its levels), by the mesh (auto, default)",
         into(s->sides),
         false,
         {"auto", "front", "fine", "both"}},
        {"--vectors",
         "NAME",
         "The processor's; the same bits for any (default widest)",
         own("--vectors", into(s->vectors)),
         false,
         {"plain", "avx2", "avx512", "widest"}},
        {"--reference", "N",
         "Measure the error against N rays a vertex, which have one of their own: 4096 show 1 % (1024: 1.2 to 1.5, "
         "256: 5)",
         integerInto([s](long long v) { s->rays = static_cast<std::size_t>(v); }, 1, 1 << 24)},
        {"--reference-frames", "K", "In at most K frames, spread over all (default 8)",
         integerInto([s](long long v) { s->referenceFrames = static_cast<int>(v); }, 1, 1 << 20)},
        {"--env",
         "FILE",
         "Radiance map to light with; may be repeated, and is blended (default: white)",
         [s](const std::string& given) { s->light.files.push_back(given); },
         false,
         {},
         true},
        {"--weights", "W,W,...", "Of each --env (default equal, of sum 1)", into(s->weights)},
        {"--turn", "DEGREES", "The light turns about y, from +z towards +x, so far in a second (default 0)",
         finiteInto(s->light.turnDeg)},
        {"--ply", "PLACE", "Also coloured meshes: a folder, or a name like cloth_####.ply", into(s->ply)},
        {"--white", "W", "Radiance shown as white in PLY (default 1.5 x the first frame's 90th percentile)",
         positiveInto([s](double v) { s->light.white = v; })},
        {"--threads", "N", "0 = all cores; the same bits for any",
         integerInto([s](long long v) { s->plan.options.threads = s->light.threads = static_cast<unsigned>(v); }, 0,
                     1024)},
        {"--json", "", "One JSON object on standard output", into(s->asJson)}};
}

}  // namespace

Verb transferVerb(Context& context) {
    const auto s = std::make_shared<Settings>();
    Verb verb{"transfer",
              "Soft self-shadows of a moving mesh: light transfer of every vertex and frame",
              kDetails,
              options(s),
              {}};
    verb.run = [s, &context] { runTransferVerb(context, *s); };
    return verb;
}

}  // namespace nacre::cli
