#include "tests/demos/viewer/display.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cstdlib>

#include <chrono>
#include <csignal>
#include <thread>

#include "core/error.hpp"
#include "core/file.hpp"

namespace nacre::tests {
namespace {

constexpr int kPatience = 60'000;  ///< [ms]: only a broken program needs it

std::uint32_t word(const std::vector<std::uint8_t>& bytes, std::size_t index) {
    const std::uint8_t* b = bytes.data() + 4 * index;
    return std::uint32_t{b[0]} << 24 | std::uint32_t{b[1]} << 16 | std::uint32_t{b[2]} << 8 | b[3];
}

}  // namespace

Child::Child(const std::vector<std::string>& words, int channel, const std::vector<std::string>& variables) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw Error("pipe failed");
    std::vector<char*> argv;
    for (const std::string& w : words) argv.push_back(const_cast<char*>(w.c_str()));
    argv.push_back(nullptr);
    // Window libraries that are unloaded leave what the leak checker can't name: a sanitizer looks for all else.
    const char* sanitizer = std::getenv("ASAN_OPTIONS");
    const std::string noLeaks =
        "ASAN_OPTIONS=" + (sanitizer ? std::string(sanitizer) + ":" : std::string()) + "detect_leaks=0";
    pid_ = ::fork();
    if (pid_ == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that is killed leaves nothing behind
        ::dup2(ends[1], channel);
        ::putenv(const_cast<char*>(noLeaks.c_str()));
        for (const std::string& v : variables) ::putenv(const_cast<char*>(v.c_str()));
        ::execvp(argv[0], argv.data());
        ::_exit(98);
    }
    ::close(ends[1]);
    pipe_ = ends[0];
}

Child::~Child() {
    if (!ended_) {
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
    }
    ::close(pipe_);
}

std::string Child::line() {
    for (;;) {
        const auto end = buffer_.find('\n');
        if (end != std::string::npos) {
            std::string out = buffer_.substr(0, end);
            buffer_.erase(0, end + 1);
            return out;
        }
        pollfd waiting{pipe_, POLLIN, 0};
        if (::poll(&waiting, 1, kPatience) == 0) throw Error("no line for a minute; so far: " + buffer_);
        char bytes[4096];
        const ssize_t count = ::read(pipe_, bytes, sizeof bytes);
        if (count <= 0) return std::exchange(buffer_, {});
        buffer_.append(bytes, static_cast<std::size_t>(count));
    }
}

int Child::code() {
    for (int waited = 0; waited < kPatience; waited += 10) {
        int status = 0;
        if (::waitpid(pid_, &status, WNOHANG) == pid_) {
            ended_ = true;
            return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    throw Error("the process did not end within a minute");
}

Display::Display() {
    // The server chooses a free number and tells it when it is ready.
    server_ =
        std::make_unique<Child>(std::vector<std::string>{"Xvfb", "-displayfd", "1", "-screen", "0", "800x960x24",
                                                         "-nolisten", "tcp", "-fbdir", scratch_.folder().string()},
                                1);
    const std::string number = server_->line();
    if (number.empty()) throw Error("expected Xvfb (package xvfb) to start, found that it didn't");
    name_ = ":" + number;
}

std::vector<std::uint8_t> Display::codes(int x, int y, int width, int height) const {
    // The frame buffer as an X window dump (XWDFile.h): 25 words of header, colour map, rows of 4 bytes B G R x.
    const std::vector<std::uint8_t> dump = readFile(scratch_ / "Xvfb_screen0", 1u << 26);
    const std::size_t first = word(dump, 0) + 12 * word(dump, 19), stride = word(dump, 12);
    std::vector<std::uint8_t> out;
    for (int row = y; row < y + height; ++row)
        for (int column = x; column < x + width; ++column) {
            const std::size_t at =
                first + static_cast<std::size_t>(row) * stride + 4 * static_cast<std::size_t>(column);
            for (const std::size_t c : {2, 1, 0}) out.push_back(dump.at(at + c));
        }
    return out;
}

void Display::send(const std::vector<std::string>& words) const {
    std::vector<std::string> all = {"xdotool"};
    all.insert(all.end(), words.begin(), words.end());
    if (Child(all, 1, {"DISPLAY=" + name_}).code() != 0)
        throw Error("expected xdotool (package xdotool) to send " + words.at(0) + ", found that it failed");
}

static std::vector<std::string> viewerWords(std::vector<std::string> words) {
    words.insert(words.begin(), NACRE_VIEW);
    words.emplace_back("--trace");
    return words;
}

Viewer::Viewer(const Display& display, std::vector<std::string> words)
    : child_(viewerWords(std::move(words)), 1, {"DISPLAY=" + display.name(), "WAYLAND_DISPLAY="}) {}

nlohmann::json Viewer::until(const std::function<bool(const nlohmann::json&)>& wanted) {
    std::string last;
    for (;;) {
        const std::string text = child_.line();
        if (text.empty()) throw Error("the viewer ended; its last line: " + last);
        const nlohmann::json line = nlohmann::json::parse(text);
        if (wanted(line)) return line;
        last = text;
    }
}

}  // namespace nacre::tests
