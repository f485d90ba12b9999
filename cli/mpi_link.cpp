#include "cli/mpi_link.hpp"

#include "core/error.hpp"

#ifdef NACRE_MPI
#define OMPI_SKIP_MPICXX
#define MPICH_SKIP_MPICXX
#include <mpi.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <list>
#include <mutex>
#include <thread>

#include "cli/pipe_processes.hpp"
#endif

namespace nacre::cli {

#ifdef NACRE_MPI
namespace {

/// Messages to itself and others go through buffers of its own: one that never arrives must outlive the call.
class MpiLink final : public PipeLink {
public:
    MpiLink() : gone_(static_cast<std::size_t>(sizeOf(MPI_COMM_WORLD))) {
        MPI_Comm_rank(MPI_COMM_WORLD, &self_);
        MPI_Comm machine;
        MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, self_, MPI_INFO_NULL, &machine);
        shareRasterizerThreads(sizeOf(machine));
        MPI_Comm_free(&machine);
    }
    /// MPI_Finalize waits for all ranks. When some are lost, or this one leaves by an error, mpirun ends them as it
    /// sees this process end without.
    ~MpiLink() override {
        bool lost = std::uncaught_exceptions() > 0;
        for (const std::atomic<bool>& gone : gone_) lost = lost || gone;
        if (!lost) MPI_Finalize();
    }
    int self() const override { return self_; }
    int count() const override { return static_cast<int>(gone_.size()); }

    bool exchange(int peer, PipeWay way, std::span<const std::byte> out, std::span<std::byte> in,
                  PipeClock::time_point deadline) override {
        std::atomic<bool>& gone = gone_.at(static_cast<std::size_t>(peer));
        if (gone) return false;
        Exchange exchange{{out.begin(), out.end()}, std::vector<std::byte>(in.size())};
        const int tag = static_cast<int>(way);
        if (!in.empty())
            MPI_Irecv(exchange.in.data(), static_cast<int>(in.size()), MPI_BYTE, peer, tag, MPI_COMM_WORLD,
                      &exchange.requests[0]);
        if (!out.empty())
            MPI_Isend(exchange.out.data(), static_cast<int>(out.size()), MPI_BYTE, peer, tag, MPI_COMM_WORLD,
                      &exchange.requests[1]);
        if (!finished(exchange, deadline)) {
            gone = true;
            const std::lock_guard lock(mutex_);
            abandoned_.push_back(std::move(exchange));
            return false;
        }
        std::copy(exchange.in.begin(), exchange.in.end(), in.begin());
        return true;
    }

private:
    struct Exchange {
        std::vector<std::byte> out, in;
        std::array<MPI_Request, 2> requests{MPI_REQUEST_NULL, MPI_REQUEST_NULL};
    };

    static int sizeOf(MPI_Comm communicator) {
        int out = 0;
        MPI_Comm_size(communicator, &out);
        return out;
    }

    /// Looks again and again, ever more slowly: MPI's own waits take a whole core.
    static bool finished(Exchange& exchange, PipeClock::time_point deadline) {
        std::chrono::microseconds pause(1);
        for (int done = 0;;) {
            MPI_Testall(2, exchange.requests.data(), &done, MPI_STATUSES_IGNORE);
            if (done) return true;
            if (PipeClock::now() >= deadline) return false;
            std::this_thread::sleep_for(pause);
            pause = std::min(2 * pause, std::chrono::microseconds(500));
        }
    }

    int self_ = 0;
    std::vector<std::atomic<bool>> gone_;
    std::mutex mutex_;
    std::list<Exchange> abandoned_;
};

}  // namespace

std::unique_ptr<PipeLink> mpiLink() {
    int threads = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_MULTIPLE, &threads);
    if (threads < MPI_THREAD_MULTIPLE)
        throw Error("--mpi: expected an MPI whose threads may all send, found one without");
    return std::make_unique<MpiLink>();
}
#else
std::unique_ptr<PipeLink> mpiLink() {
    throw Error("--mpi: expected a command built with MPI, found one without: install libopenmpi-dev and build again");
}
#endif

}  // namespace nacre::cli
