#include "cli/pipe_processes.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <thread>

#include "core/error.hpp"

namespace nacre::cli {
namespace {

constexpr const char* kVariable = "NACRE_PIPE";  // "pipe:socket,socket,…"

}  // namespace

void shareRasterizerThreads(int pipes) {
    if (pipes < 2) return;  // as it comes
    const int each = std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / pipes);
    ::setenv("LP_NUM_THREADS", std::to_string(each).c_str(), 0);
}

PipeProcesses::PipeProcesses(const std::vector<std::string>& arguments, int count) {
    shareRasterizerThreads(count);
    std::vector<std::vector<int>> sockets = connectedSockets(count);
    link_ = std::make_unique<SocketLink>(0, std::move(sockets[0]));
    for (int pipe = 1; pipe < count; ++pipe) {
        const std::vector<int>& own = sockets[static_cast<std::size_t>(pipe)];
        const SocketLink closed(pipe, own);  // here, once the child has them
        ChildSetting setting{{fmt::format("{}={}:{}", kVariable, pipe, fmt::join(own, ","))}, {}};
        std::copy_if(own.begin(), own.end(), std::back_inserter(setting.kept), [](int s) { return s >= 0; });
        children_.push_back(std::make_unique<ChildProcess>(arguments, setting));
    }
}

std::string PipeProcesses::lastWords(int pipe) {
    ChildProcess& child = *children_.at(static_cast<std::size_t>(pipe - 1));
    ::fcntl(child.descriptor(), F_SETFL, O_NONBLOCK);
    for (std::string before = "?"; before != child.errors();) {
        before = child.errors();
        child.takeErrors();
    }
    std::istringstream lines(child.errors());
    std::string last;
    for (std::string line; std::getline(lines, line);)
        if (!line.empty()) last = line;
    return last.rfind("nacre: ", 0) == 0 ? last.substr(7) : last;
}

std::unique_ptr<PipeLink> inheritedPipe() {
    const char* given = std::getenv(kVariable);
    if (given == nullptr) return nullptr;
    std::istringstream text(given);
    int pipe = 0;
    char mark = 0;
    std::vector<int> sockets;
    text >> pipe;
    for (int socket = 0; text >> mark >> socket;) sockets.push_back(socket);
    return std::make_unique<SocketLink>(pipe, std::move(sockets));
}

}  // namespace nacre::cli
