// libnacre_oiio.so: OpenImageIO behind two C functions. A module of its own, because linking OpenImageIO costs every
// program 0.2 s of start-up and 130 MB.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "core/oiio_reader.h"

namespace {

template <std::size_t N>
void copyText(char (&target)[N], const std::string& text) {
    std::snprintf(target, N, "%s", text.c_str());
}

template <typename T>
bool readAs(OIIO::ImageInput& in, OIIO::TypeDesc type, const NacreOiioImage& out, std::size_t count) {
    std::vector<T> raw(count);
    if (!in.read_image(0, 0, 0, out.channels, type, raw.data())) return false;
    std::transform(raw.begin(), raw.end(), out.values, [](T v) { return static_cast<float>(v); });
    return true;
}

/// In the file's own type, so that OpenImageIO scales nothing.
bool readCodes(OIIO::ImageInput& in, const NacreOiioImage& out, std::size_t count) {
    switch (in.spec().format.basetype) {
        case OIIO::TypeDesc::UINT8:
            return readAs<std::uint8_t>(in, OIIO::TypeDesc::UINT8, out, count);
        case OIIO::TypeDesc::INT8:
            return readAs<std::int8_t>(in, OIIO::TypeDesc::INT8, out, count);
        case OIIO::TypeDesc::UINT16:
            return readAs<std::uint16_t>(in, OIIO::TypeDesc::UINT16, out, count);
        case OIIO::TypeDesc::INT16:
            return readAs<std::int16_t>(in, OIIO::TypeDesc::INT16, out, count);
        case OIIO::TypeDesc::UINT32:
            return readAs<std::uint32_t>(in, OIIO::TypeDesc::UINT32, out, count);
        case OIIO::TypeDesc::INT32:
            return readAs<std::int32_t>(in, OIIO::TypeDesc::INT32, out, count);
        default:
            return in.read_image(0, 0, 0, out.channels, OIIO::TypeDesc::FLOAT, out.values);
    }
}

bool readValues(OIIO::ImageInput& in, const NacreOiioImage& out, std::size_t count) {
    if (out.codes) return readCodes(in, out, count);
    return in.read_image(0, 0, 0, out.channels, OIIO::TypeDesc::FLOAT, out.values);
}

bool read(const char* path, NacreOiioImage& out) {
    OIIO::ImageSpec wish;
    if (out.codes) wish.attribute("oiio:UnassociatedAlpha", 1);
    const auto in = OIIO::ImageInput::open(path, &wish);
    if (!in) {
        copyText(out.message, OIIO::geterror());
        return false;
    }
    const OIIO::ImageSpec& spec = in->spec();
    copyText(out.format, in->format_name());
    copyText(out.sample_type, spec.format.c_str());
    copyText(out.color_space, spec.get_string_attribute("oiio:ColorSpace"));
    out.is_integer = spec.format.basetype != OIIO::TypeDesc::FLOAT && spec.format.basetype != OIIO::TypeDesc::HALF &&
                     spec.format.basetype != OIIO::TypeDesc::DOUBLE;
    out.width = spec.width;
    out.height = spec.height;
    out.channels = std::min(spec.nchannels, 4);
    const long long values = 1LL * spec.width * spec.height * out.channels;
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 || spec.depth > 1 || spec.width > out.max_edge ||
        spec.height > out.max_edge || values > out.max_values) {
        copyText(out.message, "an image of " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                                  " x " + std::to_string(spec.depth));
        return false;
    }
    out.values = static_cast<float*>(std::malloc(static_cast<std::size_t>(values) * sizeof(float)));
    if (out.values && readValues(*in, out, static_cast<std::size_t>(values))) return true;
    copyText(out.message, out.values ? in->geterror() : "no memory");
    std::free(out.values);
    out.values = nullptr;
    return false;
}

}  // namespace

extern "C" int nacre_oiio_read(const char* path, NacreOiioImage* image) {
    try {
        return read(path, *image) ? 0 : 1;
    } catch (const std::exception& error) {
        copyText(image->message, error.what());
        return 1;
    }
}

extern "C" void nacre_oiio_free(NacreOiioImage* image) {
    std::free(image->values);
    image->values = nullptr;
}
