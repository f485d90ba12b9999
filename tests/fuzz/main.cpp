// nacre_fuzz [--seconds S] [--seed N] [--target NAME] CORPUS: feeds changed corpus files to the readers. In the preset
// `fuzz` the code reports where it is (GCC's -fsanitize-coverage=trace-pc), and inputs that reach new code are kept and
// changed further. The input at hand is in build/fuzz/NAME.last, so that it outlives a crash.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <map>
#include <random>

#include "core/file.hpp"
#include "tests/fuzz/targets.hpp"

namespace {

constexpr std::size_t kSites = 1 << 16;
std::array<std::uint8_t, kSites> visited, known;  // written by every instrumented branch: has to be global
std::uintptr_t previous = 0;

}  // namespace

extern "C" void __sanitizer_cov_trace_pc() {
    const auto here = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
    visited[(here ^ (previous << 1)) % kSites] = 1;
    previous = here;
}

namespace nacre::tests {
namespace {

using Clock = std::chrono::steady_clock;

/// Whether the last input reached something new; forgets where it was.
bool reachedNewCode() {
    bool isNew = false;
    for (std::size_t i = 0; i < kSites; ++i) {
        isNew = isNew || (visited[i] && !known[i]);
        known[i] |= visited[i];
    }
    visited.fill(0);
    return isNew;
}

/// Memory that is a file: what was written last stays when the process dies.
class LastInput {
public:
    explicit LastInput(const std::string& path) {
        const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC, 0644);
        if (file < 0 || ::ftruncate(file, kSize) != 0) throw std::runtime_error(path + ": can't write");
        memory_ = static_cast<std::uint8_t*>(::mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
        ::close(file);
    }
    ~LastInput() { ::munmap(memory_, kSize); }
    LastInput(const LastInput&) = delete;
    LastInput& operator=(const LastInput&) = delete;
    /// The first eight bytes are the length.
    void keep(const std::vector<std::uint8_t>& bytes) {
        const std::uint64_t size = std::min<std::uint64_t>(bytes.size(), kSize - 8);
        std::memcpy(memory_, &size, 8);
        if (size) std::memcpy(memory_ + 8, bytes.data(), size);
    }

private:
    static constexpr std::size_t kSize = 1 << 21;
    std::uint8_t* memory_ = nullptr;
};

struct Settings {
    double seconds = 60;
    std::uint64_t seed = 1;
    std::string target, corpus;
};

/// \return false when a defect was found
bool fuzz(const FuzzTarget& target, const Settings& settings, double seconds) {
    LastInput last("build/fuzz/" + target.name + ".last");
    std::vector<std::vector<std::uint8_t>> pool = corpusOf(settings.corpus, target.name);
    if (pool.empty()) throw std::runtime_error(settings.corpus + ": no files for " + target.name);
    known.fill(0);
    std::mt19937_64 random(settings.seed);
    const std::size_t seeds = pool.size();
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    std::uint64_t runs = 0;
    for (; runs < seeds || Clock::now() < end; ++runs) {
        std::vector<std::uint8_t> input =
            runs < seeds ? pool[runs] : mutated(pool[random() % pool.size()], pool[random() % pool.size()], random());
        if (input.size() > (1 << 20)) input.resize(1 << 20);
        last.keep(input);
        visited.fill(0);
        try {
            feed(target, input);
        } catch (const std::exception& error) {
            const std::string path = "build/fuzz/" + target.name + ".found";
            writeFile(path, {reinterpret_cast<const char*>(input.data()), input.size()});
            fmt::print("{}: after {} inputs: {}; see {}\n", target.name, runs, error.what(), path);
            return false;
        }
        if (reachedNewCode() && runs >= seeds) pool.push_back(input);
    }
    fmt::print("{:<11} {:>8} inputs, {} kept for reaching new code, no defect\n", target.name, runs,
               pool.size() - seeds);
    return true;
}

Settings parse(int argc, char** argv) {
    Settings settings;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const bool hasValue = i + 1 < argc;
        if (word == "--seconds" && hasValue)
            settings.seconds = std::stod(argv[++i]);
        else if (word == "--seed" && hasValue)
            settings.seed = std::stoull(argv[++i]);
        else if (word == "--target" && hasValue)
            settings.target = argv[++i];
        else
            settings.corpus = word;
    }
    if (settings.corpus.empty()) throw std::runtime_error("expected the corpus folder");
    return settings;
}

int run(int argc, char** argv) {
    const Settings settings = parse(argc, argv);
    std::filesystem::create_directories("build/fuzz");
    std::vector<FuzzTarget> chosen;
    for (const FuzzTarget& target : fuzzTargets())
        if (settings.target.empty() || settings.target == target.name) chosen.push_back(target);
    if (chosen.empty()) throw std::runtime_error("no target " + settings.target);
    bool good = true;
    for (const FuzzTarget& target : chosen)
        good = fuzz(target, settings, settings.seconds / static_cast<double>(chosen.size())) && good;
    return good ? 0 : 1;
}

}  // namespace
}  // namespace nacre::tests

int main(int argc, char** argv) {
    try {
        return nacre::tests::run(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "nacre_fuzz: {}\n", error.what());
        return 2;
    }
}
