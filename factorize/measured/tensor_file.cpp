#include "factorize/measured/tensor_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "core/error.hpp"

namespace nacre {

static constexpr std::array<std::uint64_t, 12> kTypeBytes = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
static constexpr std::array<const char*, 12> kTypeNames = {"none",  "uint8",  "int8",  "uint16",  "int16",   "uint32",
                                                           "int32", "uint64", "int64", "float16", "float32", "float64"};
static constexpr std::uint64_t kMaxFields = 1024, kMaxDimensions = 16;  // far above any published file

namespace {
/// Takes numbers off the front of the file; complains when it ends first.
struct Cursor {
    std::span<const std::uint8_t> bytes;
    const std::string& name;
    std::size_t at = 0;

    std::span<const std::uint8_t> take(std::size_t count, const char* what) {
        if (count > bytes.size() - at)
            throw Error(fmt::format("{}: expected {} bytes of {} at byte {}, found the end of the file at {}", name,
                                    count, what, at, bytes.size()));
        at += count;
        return bytes.subspan(at - count, count);
    }
    template <class T>
    T number(const char* what) {
        T value;
        std::memcpy(&value, take(sizeof value, what).data(), sizeof value);
        return value;
    }
};
}  // namespace

/// Names go into messages of one line.
static std::string printable(std::span<const std::uint8_t> bytes) {
    std::string text(bytes.begin(), bytes.end());
    for (char& c : text)
        if (c < 0x20 || c > 0x7e) c = '?';
    return text;
}

/// Product of the sizes times the size of a number, or `limit` + 1 when it is larger than `limit`.
static std::uint64_t dataBytes(const TensorField& field, std::uint64_t limit) {
    std::uint64_t total = kTypeBytes[field.type];
    for (const std::uint64_t size : field.shape) {
        if (size == 0) return 0;
        if (total > limit / size) return limit + 1;
        total *= size;
    }
    return total;
}

static TensorField readField(Cursor& cursor) {
    TensorField field;
    const auto nameLength = cursor.number<std::uint16_t>("a field's name length");
    field.name = printable(cursor.take(nameLength, "a field's name"));
    const auto dimensions = cursor.number<std::uint16_t>("a field's dimensions");
    if (dimensions > kMaxDimensions)
        throw Error(fmt::format("{}: field '{}': expected at most {} dimensions, found {}", cursor.name, field.name,
                                kMaxDimensions, dimensions));
    const auto type = cursor.number<std::uint8_t>("a field's type");
    if (type == 0 || type >= kTypeBytes.size())
        throw Error(fmt::format("{}: field '{}': expected a type from 1 to {}, found {}", cursor.name, field.name,
                                kTypeBytes.size() - 1, type));
    field.type = static_cast<TensorField::Type>(type);
    const auto offset = cursor.number<std::uint64_t>("a field's offset");
    for (int i = 0; i < dimensions; ++i) field.shape.push_back(cursor.number<std::uint64_t>("a field's shape"));
    const std::uint64_t fileBytes = cursor.bytes.size(), size = dataBytes(field, fileBytes);
    if (offset > fileBytes || size > fileBytes - offset)
        throw Error(fmt::format("{}: field '{}': expected {} [{}] at byte {}, found a file of {} bytes", cursor.name,
                                field.name, kTypeNames[type], fmt::join(field.shape, ", "), offset, fileBytes));
    field.bytes = cursor.bytes.subspan(offset, size);
    return field;
}

std::vector<TensorField> parseTensorFile(std::span<const std::uint8_t> bytes, const std::string& name) {
    static constexpr std::string_view kMagic("tensor_file\0", 12);
    Cursor cursor{bytes, name};
    const auto magic = cursor.take(kMagic.size(), "a tensor file's signature");
    if (!std::equal(magic.begin(), magic.end(), kMagic.begin()))
        throw Error(fmt::format("{}: expected a tensor file, found one that starts with '{}'", name, printable(magic)));
    const auto major = cursor.number<std::uint8_t>("version"), minor = cursor.number<std::uint8_t>("version");
    if (major != 1 || minor != 0)
        throw Error(fmt::format("{}: expected tensor file version 1.0, found {}.{}", name, major, minor));
    const auto count = cursor.number<std::uint32_t>("number of fields");
    if (count > kMaxFields)
        throw Error(fmt::format("{}: expected at most {} fields, found {}", name, kMaxFields, count));
    std::vector<TensorField> fields;
    for (std::uint32_t i = 0; i < count; ++i) fields.push_back(readField(cursor));
    std::size_t end = cursor.at;
    for (const TensorField& field : fields)
        end = std::max(end, static_cast<std::size_t>(field.bytes.data() - bytes.data()) + field.bytes.size());
    if (end != bytes.size())
        throw Error(
            fmt::format("{}: expected the last field to end the file at {} bytes, found {}", name, end, bytes.size()));
    return fields;
}

static std::string shapeText(const std::vector<std::uint64_t>& shape) {
    std::string out;
    for (const std::uint64_t size : shape)
        out += (out.empty() ? "" : ", ") + (size ? std::to_string(size) : std::string("≥ 1"));
    return out;
}

const TensorField& tensorField(const std::vector<TensorField>& fields, const std::string& field, TensorField::Type type,
                               const std::vector<std::uint64_t>& shape, const std::string& name) {
    const auto found = std::find_if(fields.begin(), fields.end(), [&](const auto& f) { return f.name == field; });
    if (found == fields.end()) throw Error(fmt::format("{}: expected a field '{}', found none", name, field));
    bool fits = found->type == type && found->shape.size() == shape.size();
    for (std::size_t i = 0; fits && i < shape.size(); ++i)
        fits = shape[i] ? found->shape[i] == shape[i] : found->shape[i] >= 1;
    if (!fits)
        throw Error(fmt::format("{}: field '{}': expected {} [{}], found {} [{}]", name, field, kTypeNames[type],
                                shapeText(shape), kTypeNames[found->type], fmt::join(found->shape, ", ")));
    return *found;
}

std::vector<float> floatsOf(const TensorField& field) {
    std::vector<float> out(field.bytes.size() / sizeof(float));
    std::memcpy(out.data(), field.bytes.data(), out.size() * sizeof(float));
    return out;
}

}  // namespace nacre
