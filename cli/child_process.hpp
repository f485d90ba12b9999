// This command again, as a child: what it says on standard error, and how it ended.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace nacre::cli {

/// One call of this same program, with nothing on standard input and standard output thrown away. The child ends when
/// this process does, by SIGTERM, so that it removes what it was writing.
class ChildProcess {
public:
    /// \param arguments  without the program's name  \throws nacre::Error when the system gives no process
    explicit ChildProcess(const std::vector<std::string>& arguments);
    ~ChildProcess();  ///< ends the child and waits for it, if it still runs
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    int descriptor() const { return error_; }  ///< to poll: readable, or at its end
    /// Takes what has arrived. \return false once the child has closed its standard error, as it does by ending
    bool takeErrors();
    /// Waits. \return 0, or the exit code, or 128 + the signal that ended it
    int wait();
    const std::string& errors() const { return errors_; }  ///< the first 64 KiB

private:
    pid_t process_ = -1;
    int error_ = -1;
    std::string errors_;
};

}  // namespace nacre::cli
