#include "transfer/visible_sets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/error.hpp"
#include "core/file.hpp"

namespace nacre {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written and read as they lie in memory");

constexpr std::string_view kMagic = "NACRE_PV";
constexpr std::uint32_t kVersion = 3;
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 32;

struct Head {
    std::uint32_t version = kVersion, groups = 0, places = 0, windows = 0;
    std::uint64_t key = 0, check = 0;  ///< check: of all bytes behind the header
};

/// FNV-1a: a bit that turned over would hide a blocker without a word.
std::uint64_t checkOf(std::span<const std::uint8_t> bytes) {
    std::uint64_t hash = 0xcbf29ce484222325ull;
    for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3ull;
    return hash;
}

std::uint64_t wordsOf(std::uint64_t groups, std::uint64_t places) { return groups * ((places + 63) / 64); }

}  // namespace

std::span<const std::uint64_t> VisibleSets::at(int frame) const {
    for (const Window& w : windows)
        if (w.first <= frame && frame < w.end) return w.bits;
    return {};
}

VisibleSets findVisibleSets(const SelfTransfer& transfer, std::span<const NumberedFrame> frames, int windowFrames) {
    VisibleSets out{transfer.key(), transfer.groupCount(), transfer.placeCount(), {}};
    for (const NumberedFrame& frame : frames) {
        if (out.windows.empty() || (windowFrames > 0 && frame.number >= out.windows.back().end)) {
            const int first = windowFrames > 0 ? frame.number / windowFrames * windowFrames : 0;
            out.windows.push_back({first, first + windowFrames, {}});
            out.windows.back().bits.resize(wordsOf(out.groups, out.places));
        }
        if (windowFrames == 0) out.windows.back().end = frame.number + 1;
        transfer.compute(frame.positions, {}, {}, {{}, out.windows.back().bits});
    }
    return out;
}

void writeVisibleSets(const VisibleSets& sets, const std::filesystem::path& path) {
    std::string body;
    const auto put = [&](const void* from, std::size_t count) { body.append(static_cast<const char*>(from), count); };
    for (const VisibleSets::Window& w : sets.windows) {
        const std::int32_t frames[] = {w.first, w.end};
        put(frames, sizeof(frames));
    }
    for (const VisibleSets::Window& w : sets.windows) put(w.bits.data(), 8 * w.bits.size());
    const Head head{kVersion,    sets.groups,
                    sets.places, static_cast<std::uint32_t>(sets.windows.size()),
                    sets.key,    checkOf({reinterpret_cast<const std::uint8_t*>(body.data()), body.size()})};
    std::string bytes(kMagic);
    bytes.append(reinterpret_cast<const char*>(&head), sizeof(head));
    bytes += body;
    writeFile(path, bytes);
}

VisibleSets parseVisibleSets(std::span<const std::uint8_t> bytes, const std::string& name) {
    Head head;
    if (bytes.size() < kMagic.size() + sizeof(head) || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
        throw Error(fmt::format("{}: expected visible sets, which begin with {}, found another file", name, kMagic));
    std::memcpy(&head, bytes.data() + kMagic.size(), sizeof(head));
    if (head.version != kVersion)
        throw Error(fmt::format("{}: expected version {}, found {}", name, kVersion, head.version));
    const std::span<const std::uint8_t> body = bytes.subspan(kMagic.size() + sizeof(head));
    const double words = static_cast<double>(head.groups) * (static_cast<double>(head.places) / 64 + 1);
    const bool huge = static_cast<double>(head.windows) * (8 + 8 * words) > static_cast<double>(kMaxBytes);
    const std::uint64_t expected = huge ? kMaxBytes : head.windows * (8 + 8 * wordsOf(head.groups, head.places));
    if (body.size() != expected)
        throw Error(fmt::format("{}: expected {} bytes behind the header, found {}", name, expected, body.size()));
    VisibleSets out{head.key, head.groups, head.places, {}};
    std::size_t at = 0;
    const auto take = [&](void* to, std::size_t count) {
        if (count > 0) std::memcpy(to, body.data() + at, count);
        at += count;
    };
    for (std::uint32_t w = 0; w < head.windows; ++w) {
        std::int32_t frames[2];
        take(frames, sizeof(frames));
        if (frames[0] < 0 || frames[1] <= frames[0] || (w > 0 && frames[0] < out.windows.back().end))
            throw Error(fmt::format("{}: expected ascending windows of frames, found {} to {} at place {}", name,
                                    frames[0], frames[1], w));
        out.windows.push_back({frames[0], frames[1], {}});
    }
    for (VisibleSets::Window& w : out.windows) {
        w.bits.resize(wordsOf(head.groups, head.places));
        take(w.bits.data(), 8 * w.bits.size());
    }
    if (checkOf(body) != head.check)
        throw Error(fmt::format("{}: expected the bytes that were written, found others: the file is damaged", name));
    return out;
}

VisibleSets readVisibleSets(const std::filesystem::path& path) {
    return parseVisibleSets(readFile(path, kMaxBytes), path.string());
}

}  // namespace nacre
