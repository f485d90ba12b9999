// Runs the nacre command as a process: arguments, standard input and limits in; exit code and both outputs back.
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/core/scratch.hpp"

namespace nacre::tests {

struct Outcome {
    int code = -1;         ///< 128 + signal when killed
    std::string out, err;  ///< err without progress, which comes or not with the machine's speed
};

struct Surroundings {
    std::string input;
    std::string stdoutPath;  ///< instead of a file in the scratch folder
    rlim_t fileSize = RLIM_INFINITY;
    bool closed = false;    ///< standard input and error, as daemons' often are
    bool asNobody = false;  ///< root may write anywhere: be somebody else
};

inline std::string contents(const std::filesystem::path& path) {
    std::stringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

inline void becomeChild(const Surroundings& setup, const Scratch& scratch) {
    const std::string out = setup.stdoutPath.empty() ? (scratch / "out").string() : setup.stdoutPath;
    ::dup2(::open((scratch / "in").c_str(), O_RDONLY), 0);
    ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT, 0600), 1);
    ::dup2(::open((scratch / "err").c_str(), O_WRONLY | O_CREAT, 0600), 2);
    if (setup.closed) ::close(0), ::close(2);
    if (setup.fileSize != RLIM_INFINITY) {
        const rlimit limit{setup.fileSize, setup.fileSize};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    if (setup.asNobody && ::geteuid() == 0 && ::setuid(65534) != 0) ::_exit(99);
}

inline pid_t start(const std::vector<std::string>& arguments, const Surroundings& setup, const Scratch& scratch) {
    std::ofstream(scratch / "in", std::ios::binary) << setup.input;
    std::vector<char*> argv = {const_cast<char*>(NACRE_COMMAND)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    // Opened before the child may become somebody who can't reach the folder.
    const int program = ::open(NACRE_COMMAND, O_RDONLY | O_CLOEXEC);
    const pid_t child = ::fork();
    if (child != 0) {
        ::close(program);
        return child;
    }
    becomeChild(setup, scratch);
    ::fexecve(program, argv.data(), environ);
    ::_exit(98);
}

inline int waitFor(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

inline std::string withoutProgress(const std::string& err) {
    std::istringstream text(err);
    std::string kept;
    for (std::string line; std::getline(text, line);) {
        const bool last = text.eof();
        if (line.ends_with(" %") && line.starts_with("nacre: ") && !last) continue;  // progressLines
        kept += last ? line : line + '\n';
    }
    return kept;
}

inline Outcome nacre(const std::vector<std::string>& arguments, const Surroundings& setup = {}) {
    const Scratch io;
    Outcome outcome;
    outcome.code = waitFor(start(arguments, setup, io));
    outcome.out = contents(io / "out");
    outcome.err = withoutProgress(contents(io / "err"));
    return outcome;
}

}  // namespace nacre::tests
