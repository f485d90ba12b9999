// Every reader of foreign bytes, as something that can be fed with anything.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace nacre::tests {

struct FuzzTarget {
    std::string name;  ///< its folder in tests/fuzz/corpus
    /// Reads, and uses what was read. nacre::Error and std::invalid_argument are the right answers to broken bytes;
    /// every other exception, and what the sanitizers find, is a defect.
    void (*read)(std::span<const std::uint8_t> bytes);
};

const std::vector<FuzzTarget>& fuzzTargets();

/// target.read(bytes) with the two right answers taken. \throws whatever else it throws
void feed(const FuzzTarget& target, std::span<const std::uint8_t> bytes);

/// A changed copy: a few of bits, bytes, numbers, blocks. Deterministic in `seed`. \param other  a block may come from
/// it
std::vector<std::uint8_t> mutated(const std::vector<std::uint8_t>& bytes, const std::vector<std::uint8_t>& other,
                                  std::uint64_t seed);

/// The files below folder/NAME of a target, sorted by name.
std::vector<std::vector<std::uint8_t>> corpusOf(const std::string& folder, const std::string& name);

}  // namespace nacre::tests
