#include "core/temporary_files.hpp"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <system_error>

namespace nacre {
namespace {

enum SlotState : int { Free, Changing, Taken };

/// A handler may neither allocate nor lock: fixed room, and states that change in one step.
struct Slot {
    std::atomic<int> state{Free};
    std::array<char, 4096> path{};
};
static_assert(std::atomic<int>::is_always_lock_free);

// Global because a signal handler has no arguments of its own.
std::array<Slot, 32> slots;

extern "C" void removeAndEnd(int signal) {
    for (Slot& slot : slots)
        if (slot.state.load() == Taken) ::unlink(slot.path.data());
    ::signal(signal, SIG_DFL);
    ::raise(signal);
}

int registerPath(const std::filesystem::path& path) {
    if (path.native().size() >= slots[0].path.size()) return -1;
    for (std::size_t i = 0; i < slots.size(); ++i) {
        int expected = Free;
        if (!slots[i].state.compare_exchange_strong(expected, Changing)) continue;
        std::memcpy(slots[i].path.data(), path.c_str(), path.native().size() + 1);
        slots[i].state.store(Taken);
        return static_cast<int>(i);
    }
    return -1;
}

}  // namespace

TemporaryFile::TemporaryFile(const std::filesystem::path& path) : path_(path), slot_(registerPath(path)) {}

TemporaryFile::~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
    if (slot_ >= 0) slots[static_cast<std::size_t>(slot_)].state.store(Free);
}

void removeTemporaryFilesOnSignals() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction before {};
        ::sigaction(signal, nullptr, &before);
        if (before.sa_handler == SIG_IGN) continue;  // nohup
        struct sigaction action {};
        action.sa_handler = removeAndEnd;
        ::sigaction(signal, &action, nullptr);
    }
}

}  // namespace nacre
