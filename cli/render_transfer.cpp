#include "cli/render_transfer.hpp"

#include <fmt/format.h>

#include "cli/output_file.hpp"
#include "cli/picture_output.hpp"
#include "cli/terminal.hpp"
#include "cli/transfer_run.hpp"
#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/image_output.hpp"

namespace nacre::cli {
namespace {

using nlohmann::json;

/// Indices into the file's frames.
std::vector<std::size_t> chosenFrames(const TransferPictures& p, const TransferRecording& recording) {
    const bool numbered = p.output.find('#') != std::string::npos;
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < recording.frames.size(); ++i) {
        const int number = recording.frames[i].number;
        if (!p.frames || (number >= p.frames->first && (p.frames->end == 0 || number < p.frames->end)))
            out.push_back(i);
    }
    if (out.empty())
        throw UsageError(fmt::format("{}: expected frames of {} to {}, found {}:{}", p.file,
                                     recording.frames.front().number, recording.frames.back().number, p.frames->first,
                                     p.frames->end > 0 ? std::to_string(p.frames->end) : ""));
    if (!p.frames && !numbered) return {out[0]};
    if (out.size() > 1 && !numbered)
        throw UsageError(fmt::format("-o: expected a name with # for the frames' numbers, found '{}'", p.output));
    return out;
}

class Pictures {
public:
    Pictures(const TransferPictures& settings, TransferRecording recording, PlayedLight light)
        : settings_(settings), light_(std::move(light)), player_(std::move(recording)) {
        camera_ = settings.viewDeg
                      ? cameraAround(player_.bounds(), settings.viewDeg->x * kPi / 180, settings.viewDeg->y * kPi / 180)
                      : player_.standardCamera();
        white_ = settings.light.white;
    }

    /// Draws, writes and measures one frame. \return what it was
    json frame(std::size_t index) {
        const int number = player_.frameNumber(index);
        const std::string output = numberedName(settings_.output, number);
        const double turnDeg = settings_.fromDeg + settings_.light.turnDeg * number / player_.framesPerSecond();
        light_.turn = turnDeg * kPi / 180;
        const Stopwatch watch;
        const Image picture =
            drawn([&](const RenderTarget& target) { player_.draw(loader_, target, camera_, index, light_); });
        seconds_ += watch.seconds();
        json out = {{"frame", number}, {"output", output}, {"turn_deg", turnDeg}};
        if (settings_.reference)
            out["error"] = compare(index, picture, output);
        else if (white_ == 0)
            white_ = pictureWhite(picture);
        writePicture(picture, output, white_);
        return out;
    }

    double white() const { return white_; }
    double seconds() const { return seconds_; }
    const TransferPlayer& player() const { return player_; }

private:
    Image drawn(const std::function<void(const RenderTarget&)>& draw) const {
        const SceneShot& shot = settings_.shot;
        const RenderTarget target({.width = shot.samples * shot.width, .height = shot.samples * shot.height});
        target.clear();
        draw(target);
        return shrunk(target.read(), shot.samples);
    }

    json compare(std::size_t index, const Image& picture, const std::string& output) {
        const TransferRecording& recording = *player_.recording();
        const TransferRecording::Block& block =
            recording.blocks[static_cast<std::size_t>(recording.frames[index].block)];
        const std::vector<double> traced = tracedVectors(recording, block, settings_.rays);
        const std::vector<float> truth(traced.begin(), traced.end());
        const Image reference = drawn(
            [&](const RenderTarget& target) { player_.drawWith(truth, loader_, target, camera_, index, light_); });
        if (white_ == 0) white_ = pictureWhite(reference);
        writePicture(reference, besideName(output, "reference", pictureEnding(output)), white_);
        writePng(differenceImage(picture, reference, white_, 0.2), besideName(output, "difference", ".png"));
        json out = differenceJson(compareImages(picture, reference, white_));
        out["total"] = transferError(block.coefficients, traced, recording.coefficientCount()).total;
        return out;
    }

    const TransferPictures& settings_;
    ProgramLoader loader_;
    PlayedLight light_;
    TransferPlayer player_;
    Camera camera_;
    double white_ = 0, seconds_ = 0;
};

std::string text(const TransferPictures& p, const json& data) {
    const json& frames = data["frames"];
    std::string out = fmt::format("{}: {} x {} pixels, {} vertices, white {:.4g}, {:.3g} ms a frame with drawing\n",
                                  p.output, p.shot.width, p.shot.height, data["vertices"].get<std::size_t>(),
                                  data["white"].get<double>(), 1e3 * data["seconds_a_frame"].get<double>());
    for (const json& f : frames) {
        if (!f.contains("error")) continue;
        const json& e = f["error"];
        out += fmt::format(
            "  frame {}: PSNR {:.2f} dB, relative RMSE {:.4f}, transfer off by {:.4f} of all together, against {} rays "
            "a vertex\n",
            f["frame"].get<int>(), e["psnr"].get<double>(), e["relative_rmse"].get<double>(), e["total"].get<double>(),
            p.rays);
    }
    return out;
}

}  // namespace

void renderTransfer(const Context& context, const TransferPictures& p) {
    pictureEnding(p.output);
    const Progress progress = terminalProgress(context.quiet);
    report(progress, "reading " + p.file, 0);
    TransferRecording recording = readTransfer(p.file);
    if (recording.triangles.empty()) throw Error(fmt::format("{}: expected triangles, found none", p.file));
    if (recording.gloss && p.viewDeg)
        throw UsageError(
            fmt::format("--view: expected a matt transfer file, found {}, which is glossy for one viewer", p.file));
    const std::vector<std::size_t> chosen = chosenFrames(p, recording);
    const std::string first = numberedName(p.output, recording.frames[chosen[0]].number);
    requireWritable({p.file}, first, provisionalName(first), "");
    PlayedLight light = readLights(p.light, recording.order);
    const nacre::Context gl(GlApi::Core33);
    Pictures pictures(p, std::move(recording), std::move(light));
    json data;
    for (const std::size_t index : chosen) {
        report(progress, "frames", static_cast<double>(data["frames"].size()) / static_cast<double>(chosen.size()));
        data["frames"].push_back(pictures.frame(index));
    }
    data.update({{"output", p.output},
                 {"width", p.shot.width},
                 {"height", p.shot.height},
                 {"samples", p.shot.samples},
                 {"vertices", pictures.player().vertexCount()},
                 {"white", pictures.white()},
                 {"seconds_a_frame", pictures.seconds() / static_cast<double>(chosen.size())},
                 {"renderer", gl.description()}});
    if (p.reference) data["rays"] = p.rays;
    endProgress();
    putData(p.asJson ? data.dump(2) + "\n" : text(p, data));
}

}  // namespace nacre::cli
