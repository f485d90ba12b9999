#include "cli/terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <mutex>

#include "core/error.hpp"

namespace nacre::cli {

void putData(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
        throw Error(fmt::format("standard output: can't write: {}", std::strerror(errno)));
}

void flushData() {
    if (std::fflush(stdout) != 0) throw Error(fmt::format("standard output: can't write: {}", std::strerror(errno)));
}

void tell(std::string_view message) {
    endProgress();
    const std::string line = fmt::format("nacre: {}\n", message);
    std::fwrite(line.data(), 1, line.size(), stderr);
}

using Clock = std::chrono::steady_clock;

/// \param text  with places for what is done and per cent  \param last  when a line came last
static Progress every(double seconds, Clock::time_point last, std::FILE* out, const char* text) {
    struct State {
        Clock::time_point last;
        std::mutex mutex{};  // bakers may report from several threads
    };
    const std::shared_ptr<State> state(new State{last});
    return [=](const std::string& what, double share) {
        const std::lock_guard lock(state->mutex);
        const auto now = Clock::now();
        if (now - state->last < std::chrono::duration<double>(seconds)) return;
        state->last = now;
        const std::string line = fmt::format(fmt::runtime(text), what, 100 * share);
        std::fwrite(line.data(), 1, line.size(), out);
    };
}

Progress progressLines(std::FILE* out, double seconds) {
    return every(seconds, Clock::now(), out, "nacre: {} {:.0f} %\n");
}

Progress terminalProgress(bool quiet) {
    if (quiet) return {};
    if (!::isatty(STDERR_FILENO)) return progressLines(stderr, 10);
    return every(0.1, {}, stderr, "\r\033[K{} {:.0f} %");
}

void endProgress() {
    if (::isatty(STDERR_FILENO)) std::fputs("\r\033[K", stderr);
}

std::string humanBytes(std::size_t bytes) {
    if (bytes < 1024) return fmt::format("{} bytes", bytes);
    if (bytes < 1024 * 1024) return fmt::format("{:.1f} KiB", static_cast<double>(bytes) / 1024);
    return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1024 * 1024));
}

}  // namespace nacre::cli
