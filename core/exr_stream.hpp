// Bytes in memory as OpenEXR reads them. Not part of the interface.
#pragma once

#include <Iex.h>
#include <ImfIO.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>

namespace nacre::exr {

class MemoryIStream : public Imf::IStream {
public:
    explicit MemoryIStream(std::span<const std::uint8_t> bytes) : Imf::IStream("file"), bytes_(bytes) {}
    bool read(char c[], int n) override {
        const std::uint64_t left = position_ < bytes_.size() ? bytes_.size() - position_ : 0;
        if (n < 0 || static_cast<std::uint64_t>(n) > left)
            throw IEX_NAMESPACE::InputExc(
                fmt::format("bytes {} to {} named in a file of {}: it is cut short or corrupt", position_,
                            position_ + static_cast<std::uint64_t>(std::max(n, 0)), bytes_.size()));
        std::memcpy(c, bytes_.data() + position_, static_cast<std::size_t>(n));
        position_ += static_cast<std::uint64_t>(n);
        return position_ < bytes_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t pos) override { position_ = pos; }

private:
    std::span<const std::uint8_t> bytes_;
    std::uint64_t position_ = 0;
};

}  // namespace nacre::exr
