#include "transfer/transfer_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/json_field.hpp"
#include "transfer/mask_tables.hpp"

namespace nacre {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "arrays are written and read as they lie in memory");

namespace {

constexpr std::string_view kMagic = "NACRE_TV";
constexpr std::size_t kFixed = kMagic.size() + 8;            ///< bytes before the header
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 36;  // of a file: more than memory holds
constexpr int kMaxCount = std::numeric_limits<int>::max();

/// Empty, or what is wrong: the rules for what is written and what was read.
std::string problemOf(const TransferRecording& r) {
    const std::size_t vertices = r.vertexCount();
    if (r.order < 0 || r.order > kMaxTransferOrder)
        return fmt::format("expected an order of 0 to {}, found {}", kMaxTransferOrder, r.order);
    if (!std::isfinite(r.framesPerSecond) || r.framesPerSecond <= 0)
        return fmt::format("expected frames per second > 0, found {}", r.framesPerSecond);
    if (r.gloss && !(std::isfinite(r.gloss->exponent) && r.gloss->exponent >= 0 && r.gloss->specular >= 0 &&
                     r.gloss->specular <= 1 && isFinite(r.gloss->eye)))
        return fmt::format(
            "expected an exponent >= 0, a specular share of 0 to 1 and a finite eye, found {}, {} and [{}, {}, {}]",
            r.gloss->exponent, r.gloss->specular, r.gloss->eye.x, r.gloss->eye.y, r.gloss->eye.z);
    if (r.blocks.empty()) return "expected at least one block, found none";
    for (std::size_t t = 0; t < r.triangles.size(); ++t)
        for (int c = 0; c < 3; ++c)
            if (r.triangles[t][c] >= vertices)
                return fmt::format("expected vertices below {}, found {} in triangle {}", vertices, r.triangles[t][c],
                                   t);
    for (std::size_t v = 0; v < r.weldOf.size(); ++v)
        if (r.weldOf[v] >= vertices)
            return fmt::format("expected vertices below {}, found {} for source vertex {}", vertices, r.weldOf[v], v);
    std::vector<std::uint8_t> used(r.blocks.size(), 0);
    for (std::size_t f = 0; f < r.frames.size(); ++f) {
        const auto [number, block] = r.frames[f];
        if (number < 0 || (f > 0 && number <= r.frames[f - 1].number))
            return fmt::format("expected ascending frame numbers from 0, found {} at place {}", number, f);
        if (block < 0 || static_cast<std::size_t>(block) >= r.blocks.size())
            return fmt::format("expected blocks 0 to {}, found {} for frame {}", r.blocks.size() - 1, block, number);
        used[static_cast<std::size_t>(block)] = 1;
    }
    for (std::size_t b = 0; b < r.blocks.size(); ++b) {
        if (!used[b]) return fmt::format("expected a frame for each block, found none for block {}", b);
        const auto& [positions, coefficients] = r.blocks[b];
        if (positions.size() != vertices || coefficients.size() != vertices * r.coefficientCount())
            return fmt::format(
                "expected {} vertices of {} coefficients, found {} positions and {} coefficients in block {}", vertices,
                r.coefficientCount(), positions.size(), coefficients.size(), b);
        const auto finite = [](float x) { return std::isfinite(x); };
        const auto place = std::find_if_not(positions.begin(), positions.end(), [&](const glm::vec3& p) {
            return finite(p.x) && finite(p.y) && finite(p.z);
        });
        if (place != positions.end())
            return fmt::format("expected finite positions, found another at vertex {} of block {}",
                               place - positions.begin(), b);
        const auto number = std::find_if_not(coefficients.begin(), coefficients.end(), finite);
        if (number != coefficients.end())
            return fmt::format("expected finite coefficients, found {} in block {}", *number, b);
    }
    return {};
}

json headerOf(const TransferRecording& r) {
    json header = r.meta;
    header["kind"] = "transfer";
    header["version"] = kTransferFileVersion;
    header["order"] = r.order;
    header["frames_per_second"] = r.framesPerSecond;
    header["vertices"] = r.vertexCount();
    header["source_vertices"] = r.weldOf.size();
    header["triangles"] = r.triangles.size();
    header["blocks"] = r.blocks.size();
    header["frames"] = header["block_of_frame"] = json::array();
    for (const TransferRecording::Frame& frame : r.frames) {
        header["frames"].push_back(frame.number);
        header["block_of_frame"].push_back(frame.block);
    }
    if (r.gloss) {
        const Vec3& eye = r.gloss->eye;
        header["glossy"] = {
            {"exponent", r.gloss->exponent}, {"specular", r.gloss->specular}, {"eye", {eye.x, eye.y, eye.z}}};
    }
    return header;
}

/// What comes after another in a file's bytes; sizes were checked.
class Cursor {
public:
    explicit Cursor(std::span<const std::uint8_t> bytes) : rest_(bytes) {}
    template <typename T>
    std::vector<T> take(std::size_t count) {
        std::vector<T> out(count);
        if (count > 0) std::memcpy(out.data(), rest_.data(), count * sizeof(T));
        rest_ = rest_.subspan(count * sizeof(T));
        return out;
    }

private:
    std::span<const std::uint8_t> rest_;
};

/// Counts and frames; the arrays still empty.
struct Head {
    TransferRecording recording;
    std::size_t sourceVertices = 0, triangles = 0, vertices = 0, blocks = 0;
    std::uint64_t bodyBytes() const {  // below 2^31 each and 2^31 blocks of 2^31 vertices: too large for 64 bits only
        const double block =
            static_cast<double>(vertices) * (12 + 4 * static_cast<double>(recording.coefficientCount()));
        if (static_cast<double>(blocks) * block > static_cast<double>(kMaxBytes)) return kMaxBytes;
        return 4 * sourceVertices + 12 * triangles + blocks * vertices * (12 + 4 * recording.coefficientCount());
    }
};

Head parseHead(json header, const std::string& name) {
    Head head;
    TransferRecording& r = head.recording;
    const JsonField field(header, name);
    const auto count = [&](const char* key) { return static_cast<std::size_t>(field.at(key).integer(0, kMaxCount)); };
    r.order = field.at("order").integer(0, kMaxTransferOrder);
    r.framesPerSecond = field.at("frames_per_second").positive();
    head.sourceVertices = count("source_vertices");
    head.triangles = count("triangles");
    head.vertices = count("vertices");
    head.blocks = count("blocks");
    const std::vector<JsonField> numbers = field.at("frames").items(1),
                                 blocks = field.at("block_of_frame").items(numbers.size(), numbers.size());
    for (std::size_t f = 0; f < numbers.size(); ++f)
        r.frames.push_back({numbers[f].integer(0, kMaxCount), blocks[f].integer(0, kMaxCount)});
    if (const auto gloss = field.find("glossy"))
        r.gloss = RecordedGloss{gloss->at("exponent").number(0), gloss->at("specular").number(0, 1),
                                gloss->at("eye").vector()};
    r.meta = std::move(header);
    return head;
}

}  // namespace

void writeTransfer(const TransferRecording& r, const std::filesystem::path& path) {
    const std::string problem = problemOf(r);
    require(problem.empty(), "transfer file: " + problem);
    const std::string header = headerOf(r).dump(1, ' ', false, json::error_handler_t::replace);
    writeThenRename(path, [&](const std::filesystem::path& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        const auto put = [&](const auto* values, std::size_t count) {
            out.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(count * sizeof(*values)));
        };
        const std::uint32_t fixed[] = {kTransferFileVersion, static_cast<std::uint32_t>(header.size())};
        put(kMagic.data(), kMagic.size());
        put(fixed, 2);
        put(header.data(), header.size());
        put(r.weldOf.data(), r.weldOf.size());
        put(r.triangles.data(), r.triangles.size());
        for (const TransferRecording::Block& block : r.blocks) {
            put(block.positions.data(), block.positions.size());
            put(block.coefficients.data(), block.coefficients.size());
        }
        out.close();
        if (!out) throw Error(std::strerror(errno));
    });
}

TransferRecording parseTransfer(std::span<const std::uint8_t> bytes, const std::string& name) {
    const auto begins = [&] { return std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0; };
    if (bytes.size() < kFixed || !begins())
        throw Error(fmt::format("{}: expected a transfer file, which begins with {}, found another", name, kMagic));
    std::uint32_t fixed[2];
    std::memcpy(fixed, bytes.data() + kMagic.size(), sizeof(fixed));
    if (fixed[0] != kTransferFileVersion)
        throw Error(fmt::format("{}: expected version {}, found {}", name, kTransferFileVersion, fixed[0]));
    if (fixed[1] > bytes.size() - kFixed)
        throw Error(fmt::format("{}: expected a header of {} bytes, found {}", name, fixed[1], bytes.size() - kFixed));
    const std::string_view text(reinterpret_cast<const char*>(bytes.data() + kFixed), fixed[1]);
    Head head = parseHead(parseJson(text, name), name);
    const std::span<const std::uint8_t> body = bytes.subspan(kFixed + fixed[1]);
    if (body.size() != head.bodyBytes())
        throw Error(
            fmt::format("{}: expected {} bytes behind the header, found {}", name, head.bodyBytes(), body.size()));
    TransferRecording& r = head.recording;
    if (head.blocks > r.frames.size())
        throw Error(
            fmt::format("{}: expected at most a block a frame, found {} for {}", name, head.blocks, r.frames.size()));
    Cursor cursor(body);
    r.weldOf = cursor.take<std::uint32_t>(head.sourceVertices);
    r.triangles = cursor.take<glm::uvec3>(head.triangles);
    for (std::size_t b = 0; b < head.blocks; ++b) {
        TransferRecording::Block& block = r.blocks.emplace_back();
        block.positions = cursor.take<glm::vec3>(head.vertices);
        block.coefficients = cursor.take<float>(head.vertices * r.coefficientCount());
    }
    const std::string problem = problemOf(r);
    if (!problem.empty()) throw Error(fmt::format("{}: {}", name, problem));
    return std::move(r);
}

TransferRecording readTransfer(const std::filesystem::path& path) {
    return parseTransfer(readFile(path, kMaxBytes), path.string());
}

bool isTransferFile(const std::filesystem::path& path) {
    char begin[kMagic.size()] = {};
    std::ifstream(path, std::ios::binary).read(begin, sizeof(begin));
    return std::string_view(begin, sizeof(begin)) == kMagic;
}

}  // namespace nacre
