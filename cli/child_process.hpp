// This command again, as a child: what it says on standard error, and how it ended.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace nacre::cli {

/// What a child has besides its arguments.
struct ChildSetting {
    std::vector<std::string> environment{};  ///< NAME=value, before the inherited variables
    std::vector<int> kept{};                 ///< descriptors that it inherits although they close on exec
};

/// One call of this same program, with nothing on standard input and standard output thrown away. The child ends when
/// this process does, by SIGTERM, so that it removes what it was writing.
class ChildProcess {
public:
    /// \param arguments  without the program's name  \throws nacre::Error when the system gives no process
    explicit ChildProcess(const std::vector<std::string>& arguments, const ChildSetting& setting = {});
    ~ChildProcess();  ///< ends the child, a stopped one too, and waits for it
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    int descriptor() const { return error_; }  ///< to poll: readable, or at its end
    /// Takes what has arrived. \return false once the child has closed its standard error, as it does by ending
    bool takeErrors();
    /// Waits. \return 0, or the exit code, or 128 + the signal that ended it
    int wait();
    const std::string& errors() const { return errors_; }  ///< the first 64 KiB

private:
    void end();

    pid_t process_ = -1;
    int error_ = -1;
    std::string errors_;
};

}  // namespace nacre::cli
