// How the pipes of a frame talk to each other: threads, processes or MPI's ranks. No OpenGL in here.
#pragma once

#include <chrono>
#include <cstddef>
#include <span>
#include <vector>

namespace nacre {

using PipeClock = std::chrono::steady_clock;

/// What is sent one way arrives in order; the two don't wait for each other.
enum class PipeWay { Order, Image };
inline constexpr int kPipeWays = 2;

/// One pipe's ways to the others. Each way of each peer may be used by a thread of its own.
class PipeLink {
public:
    virtual ~PipeLink() = default;
    virtual int self() const = 0;
    virtual int count() const = 0;  ///< pipes, this one too
    /// Sends `out` and takes `in`, either of which may be empty, at once: two pipes may do so with each other.
    /// \return false when the peer is gone or isn't done at `deadline`; it isn't asked again
    virtual bool exchange(int peer, PipeWay way, std::span<const std::byte> out, std::span<std::byte> in,
                          PipeClock::time_point deadline) = 0;
};

/// Sockets of this machine: between threads, and between processes that inherit them.
class SocketLink final : public PipeLink {
public:
    /// \param sockets  one a peer and way, [peer · kPipeWays + way]; −1 to itself. Owned.
    SocketLink(int self, std::vector<int> sockets);
    ~SocketLink() override;
    SocketLink(const SocketLink&) = delete;
    SocketLink& operator=(const SocketLink&) = delete;

    int self() const override { return self_; }
    int count() const override { return static_cast<int>(sockets_.size()) / kPipeWays; }
    bool exchange(int peer, PipeWay way, std::span<const std::byte> out, std::span<std::byte> in,
                  PipeClock::time_point deadline) override;

private:
    int self_;
    std::vector<int> sockets_;
};

/// Of each pipe: what its SocketLink takes. Closed in processes that are started, unless they ask for them.
/// \throws nacre::Error when the system gives no more
std::vector<std::vector<int>> connectedSockets(int pipes);

/// Bytes of a value or of a list of them.
template <class T>
std::span<const std::byte> bytesIn(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}
template <class T>
std::span<const std::byte> bytesIn(const std::vector<T>& list) {
    return std::as_bytes(std::span(list));
}
template <class T>
std::span<std::byte> roomIn(T& value) {
    return std::as_writable_bytes(std::span(&value, 1));
}
template <class T>
std::span<std::byte> roomIn(std::vector<T>& list) {
    return std::as_writable_bytes(std::span(list));
}

}  // namespace nacre
