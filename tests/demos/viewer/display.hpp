// A screen in memory, the viewer on it, and real X events: what tests of the window need.
#pragma once

#include <sys/types.h>

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/core/scratch.hpp"

namespace nacre::tests {

/// A child process whose standard output or error can be read line by line. Killed, by its number, at the end.
class Child {
public:
    /// \param words  the program and its arguments. \param channel  1: standard output is read, 2: standard error
    Child(const std::vector<std::string>& words, int channel, const std::vector<std::string>& variables = {});
    ~Child();
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// The next line without its end; empty when the process has closed the channel. \throws nacre::Error after a
    /// minute without one
    std::string line();
    /// Its exit code, once it has ended; 128 + signal. \throws nacre::Error after a minute
    int code();
    pid_t pid() const { return pid_; }

private:
    pid_t pid_ = -1;
    int pipe_ = -1;
    bool ended_ = false;
    std::string buffer_;
};

/// Xvfb on a display of its own, without TCP.
class Display {
public:
    Display();
    const std::string& name() const { return name_; }  ///< ":99"
    /// What the screen shows in a rectangle, 8-bit codes, RGB.
    std::vector<std::uint8_t> codes(int x, int y, int width, int height) const;
    /// xdotool with these words, which sends the events through the server. \throws nacre::Error when it fails
    void send(const std::vector<std::string>& words) const;

private:
    Scratch scratch_;
    std::unique_ptr<Child> server_;
    std::string name_;
};

/// nacre_view with --trace.
class Viewer {
public:
    Viewer(const Display& display, std::vector<std::string> words);
    /// Reads lines until one for which `wanted` holds. \throws nacre::Error when the viewer ends, or after a minute
    nlohmann::json until(const std::function<bool(const nlohmann::json&)>& wanted);
    int code() { return child_.code(); }

private:
    Child child_;
};

}  // namespace nacre::tests
