#include "cli/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.hpp"

namespace nacre::cli {

namespace {

constexpr std::size_t kMostErrors = 64 << 10;

/// Between fork and exec: only calls that a signal handler may make.
[[noreturn]] void become(char* const* argv, char* const* variables, const std::vector<int>& kept, int error,
                         pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(127);  // it ended before the line above
    const int null = ::open("/dev/null", O_RDWR);
    ::dup2(null, STDIN_FILENO);
    ::dup2(null, STDOUT_FILENO);
    ::dup2(error, STDERR_FILENO);
    for (const int descriptor : kept) ::fcntl(descriptor, F_SETFD, 0);
    ::execve("/proc/self/exe", argv, variables);
    ::_exit(127);
}

int statusOf(pid_t process, int flags) {
    int status = 0;
    while (::waitpid(process, &status, flags) < 0 && errno == EINTR) continue;
    return status;
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments, const ChildSetting& setting) {
    std::vector<char*> argv = {const_cast<char*>("nacre")};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    std::vector<char*> variables;
    for (const std::string& variable : setting.environment) variables.push_back(const_cast<char*>(variable.c_str()));
    for (char** variable = environ; *variable != nullptr; ++variable) variables.push_back(*variable);
    variables.push_back(nullptr);
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw Error(fmt::format("a pipe: can't make it: {}", std::strerror(errno)));
    const pid_t parent = ::getpid();
    process_ = ::fork();
    if (process_ == 0) become(argv.data(), variables.data(), setting.kept, ends[1], parent);
    const int code = errno;
    ::close(ends[1]);
    error_ = ends[0];
    if (process_ > 0) return;
    ::close(error_);
    throw Error(fmt::format("a process: can't start it: {}", std::strerror(code)));
}

ChildProcess::~ChildProcess() {
    if (process_ > 0) {
        ::kill(process_, SIGTERM);
        end();
    }
    ::close(error_);
}

bool ChildProcess::takeErrors() {
    char block[4096];
    const ssize_t size = ::read(error_, block, sizeof block);
    if (size < 0) return errno == EINTR || errno == EAGAIN;
    if (errors_.size() < kMostErrors) errors_.append(block, static_cast<std::size_t>(size));
    return size > 0;
}

/// A stopped process keeps SIGTERM pending. One that isn't must not get SIGCONT, which takes the stop of a tracer away:
/// the leak check of an ending process then waits for ever.
void ChildProcess::end() {
    while (WIFSTOPPED(statusOf(process_, WUNTRACED))) ::kill(process_, SIGCONT);
    process_ = -1;
}

int ChildProcess::wait() {
    const int status = statusOf(process_, 0);
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace nacre::cli
