#include "shading/hybrid/pipe_link.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/error.hpp"

namespace nacre {
namespace {

/// \return −1: the other end is gone; else bytes, 0 when nothing goes at the moment
ssize_t moved(ssize_t result, bool receiving) {
    if (result > 0) return result;
    if (result == 0) return receiving ? -1 : 0;
    return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR ? 0 : -1;
}

int millisecondsUntil(PipeClock::time_point deadline) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - PipeClock::now()).count();
    return static_cast<int>(std::clamp<decltype(left)>(left, 0, 3600000));
}

void closeAll(const std::vector<int>& sockets) {
    for (const int socket : sockets)
        if (socket >= 0) ::close(socket);
}

}  // namespace

SocketLink::SocketLink(int self, std::vector<int> sockets) : self_(self), sockets_(std::move(sockets)) {
    require(self >= 0 && self < count() && sockets_.size() % kPipeWays == 0, "pipes: expected sockets to each");
}

SocketLink::~SocketLink() { closeAll(sockets_); }

bool SocketLink::exchange(int peer, PipeWay way, std::span<const std::byte> out, std::span<std::byte> in,
                          PipeClock::time_point deadline) {
    require(peer >= 0 && peer < count() && peer != self_, "pipes: expected another pipe");
    const std::size_t first = static_cast<std::size_t>(peer) * kPipeWays;
    const int socket = sockets_[first + static_cast<std::size_t>(way)];
    bool there = true;
    while (there && (!out.empty() || !in.empty())) {
        pollfd wanted{socket, static_cast<short>((out.empty() ? 0 : POLLOUT) | (in.empty() ? 0 : POLLIN)), 0};
        const int ready = ::poll(&wanted, 1, millisecondsUntil(deadline));
        if (ready < 0 && errno == EINTR) continue;
        there = ready > 0;
        if (there && !out.empty() && (wanted.revents & (POLLOUT | POLLHUP | POLLERR))) {
            const ssize_t sent = moved(::send(socket, out.data(), out.size(), MSG_DONTWAIT | MSG_NOSIGNAL), false);
            there = sent >= 0;
            if (there) out = out.subspan(static_cast<std::size_t>(sent));
        }
        if (there && !in.empty() && (wanted.revents & (POLLIN | POLLHUP | POLLERR))) {
            const ssize_t got = moved(::recv(socket, in.data(), in.size(), MSG_DONTWAIT), true);
            there = got >= 0;
            if (there) in = in.subspan(static_cast<std::size_t>(got));
        }
    }
    // A part of a message may be on its way: what comes later would be misread. The peer sees the end.
    for (std::size_t i = 0; !there && i < kPipeWays; ++i) ::shutdown(sockets_[first + i], SHUT_RDWR);
    return there;
}

std::vector<std::vector<int>> connectedSockets(int pipes) {
    const auto count = static_cast<std::size_t>(pipes);
    std::vector<std::vector<int>> out(count, std::vector<int>(count * kPipeWays, -1));
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = a + 1; b < count; ++b)
            for (std::size_t way = 0; way < kPipeWays; ++way) {
                int ends[2];
                if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
                    const int code = errno;
                    for (const std::vector<int>& sockets : out) closeAll(sockets);
                    throw Error(fmt::format("pipes: can't connect {}: {}", pipes, std::strerror(code)));
                }
                out[a][b * kPipeWays + way] = ends[0];
                out[b][a * kPipeWays + way] = ends[1];
            }
    return out;
}

}  // namespace nacre
