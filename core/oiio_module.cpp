// libnacre_oiio.so: OpenImageIO behind two C functions. A module of its own, because linking OpenImageIO costs every
// program 0.2 s of start-up and 130 MB.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "core/oiio_reader.h"

namespace {

template <std::size_t N>
void copyText(char (&target)[N], const std::string& text) {
    std::snprintf(target, N, "%s", text.c_str());
}

bool read(const char* path, NacreOiioImage& out) {
    const auto in = OIIO::ImageInput::open(path);
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
    if (out.values && in->read_image(0, 0, 0, out.channels, OIIO::TypeDesc::FLOAT, out.values)) return true;
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
