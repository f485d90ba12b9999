// Several pipes that draw one frame (HYBRID section 4.4): who takes part, what each draws, how their images come
// together.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "core/draw_share.hpp"
#include "shading/hybrid/compositing.hpp"
#include "shading/hybrid/reflected_power.hpp"
#include "shading/hybrid/virtual_lights.hpp"

namespace nacre {

inline constexpr int kMostPipes = 64;

/// BinarySwap: the pipelines add halves (compositing.hpp). Software: threads of the first pipe add all images, which
/// can go on while the pipes draw the next frame.
enum class Compositing { BinarySwap, Software };

struct CrewOptions {
    Compositing compositing = Compositing::BinarySwap;
    double patience = 30;  ///< [s] that the first pipe, done itself, waits for the others
};

/// A frame's images as the first pipe has them in the end.
struct CompositedFrame {
    std::vector<Image> images;        ///< four channels, one a target; none: draw again, with the new share
    std::vector<double> drawSeconds;  ///< a pipe; below 0: the images lack its part; NaN: it had none
};

/// One pipe's part in it. The first pipe leads: it says which frame is drawn and shows it. A pipe that is gone, or
/// answers later than the leader's patience, is left out of that frame, which then lacks what the pipe would have
/// drawn, and of all later ones, which the others share. Cores aren't equally fast: shares follow the time that pipes
/// took. Pipes beyond the samples draw nothing.
class PipeCrew {
public:
    /// \param link  outlives this \throws std::invalid_argument for more than kMostPipes, patience ≤ 0
    PipeCrew(PipeLink& link, const CrewOptions& options);
    /// The leader's: the others leave.
    ~PipeCrew();
    PipeCrew(const PipeCrew&) = delete;
    PipeCrew& operator=(const PipeCrew&) = delete;

    bool leads() const { return link_.self() == 0; }
    const CrewOptions& options() const { return options_; }
    int present() const;  ///< pipes that still take part
    /// Of the frame that was begun last: as large as lets all be done at once, going by the frames before.
    DrawShare share(int pipe) const;
    DrawShare share() const { return share(link_.self()); }

    /// The leader's: a frame at `time` begins.
    void begin(double time);
    /// The others': its time, nothing when there are no more. \throws nacre::Error when the leader is gone
    std::optional<double> await();

    /// The leader gets all sources' power in the end, the others give theirs. \param elements  how many
    void gather(std::vector<ElementPower>& sources, std::size_t elements);
    /// The others take what the leader has.
    void spread(VirtualLights& lights);

    /// Puts the targets' images together; all pipes call it. To the others it says whether to draw again.
    /// \param seconds  that this pipe drew. Leaves one of the targets bound
    /// \return the leader's: to be called once, by any thread, before the next frame's; Software adds in there
    std::function<CompositedFrame()> composite(ProgramLoader& loader, std::span<const RenderTarget* const> targets,
                                               double seconds, bool& again);

    /// One line a pipe that was lost since.
    std::vector<std::string> takeNotes();

private:
    struct Order {
        std::uint64_t pipes = 0;  ///< a bit each, that take part; 0: no more frames
        double time = 0;
        std::uint64_t frame = 0;
        std::array<double, kMostPipes + 1> cuts{};  ///< of the shares; pipes that are gone have none
    };
    void cut();
    void learn(const std::vector<double>& seconds);
    std::vector<int> members() const;
    PipeClock::time_point deadline(double times = 1) const;
    void lose(int pipe, const char* doing, std::uint64_t frame);
    void lose(int pipe, const char* doing) { lose(pipe, doing, order_.frame); }
    CompositedFrame compositeSwapped(ProgramLoader& loader, std::span<const RenderTarget* const> targets,
                                     double seconds, bool& again);
    std::vector<double> secondsBefore() const;
    std::vector<double> rollCall(double seconds);
    bool collectRows(std::span<const RenderTarget* const> targets, bool good, std::vector<Image>& images);
    CompositedFrame addInSoftware(CompositedFrame out, std::vector<float> mine, std::size_t targets, int width,
                                  int height, const std::vector<int>& pipes, std::uint64_t frame);

    PipeLink& link_;
    CrewOptions options_;
    Order order_;
    std::atomic<std::uint64_t> present_;
    std::mutex mutex_;  ///< of what frames' ends write, in other threads
    std::vector<std::string> notes_;
    std::array<double, kMostPipes> weights_;  ///< of the shares to come
};

}  // namespace nacre
