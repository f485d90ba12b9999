// The tensor file: the container of the RGL material database's `.bsdf` files (Dupuy & Jakob 2018, supplement).
// "tensor_file\0", version (2 bytes, 1 and 0), uint32 number of fields, then per field: uint16 name length, name,
// uint16 dimensions, uint8 type, uint64 offset of its data from the start of the file, uint64 size of each dimension.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace nacre {

/// One named array, row-major, little-endian. `bytes` points into the file's bytes.
struct TensorField {
    enum Type : std::uint8_t { UInt8 = 1, Int8, UInt16, Int16, UInt32, Int32, UInt64, Int64, Half, Float, Double };
    std::string name;
    Type type = UInt8;
    std::vector<std::uint64_t> shape;
    std::span<const std::uint8_t> bytes;
};

/// Reads the directory of a tensor file; every name, size and offset is checked against the file's size.
/// \param bytes  must outlive the result   \param name  used in messages
/// \throws nacre::Error naming file, field, expected and found
std::vector<TensorField> parseTensorFile(std::span<const std::uint8_t> bytes, const std::string& name);

/// The field `field` with type and shape checked; 0 in `shape` stands for any size ≥ 1.
/// \throws nacre::Error naming file, field, expected and found
const TensorField& tensorField(const std::vector<TensorField>& fields, const std::string& field, TensorField::Type type,
                               const std::vector<std::uint64_t>& shape, const std::string& name);

/// The numbers of a field of type Float.
std::vector<float> floatsOf(const TensorField& field);

}  // namespace nacre
