#include "shading/gpu_prefilter.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <chrono>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"

namespace nacre {
namespace {

constexpr int kBlock = 8;           // edge of the least that is drawn at once [texels]
constexpr double kTail = 1e-8;      // of the lobe's largest value: beyond, Phong and Beckmann are left out
constexpr int kIterations = 60000;  // llvmpipe silently leaves loops after 65535 steps of all loops together
constexpr double kUnseen = 1e-9;    // as in envmaps/prefilter.cpp

/// OpenGL's faces (OpenGL 4.6, table 8.19): columns s, t, middle.
const std::array<glm::mat3, 6> kGlFaces{{{0, 0, -1, 0, -1, 0, 1, 0, 0},
                                         {0, 0, 1, 0, -1, 0, -1, 0, 0},
                                         {1, 0, 0, 0, 0, 1, 0, 1, 0},
                                         {1, 0, 0, 0, 0, -1, 0, -1, 0},
                                         {1, 0, 0, 0, -1, 0, 0, 0, 1},
                                         {-1, 0, 0, 0, -1, 0, 0, 0, -1}}};

/// OpenEXR's texel (x, y) of a face in OpenGL's: left and right change places, on ±Y above and below.
glm::ivec2 glTexel(int face, int size, int x, int y) {
    return face == 2 || face == 3 ? glm::ivec2(x, size - 1 - y) : glm::ivec2(size - 1 - x, y);
}

const char* lobeDefine(const Lobe& lobe) {
    if (isMirror(lobe)) return "NACRE_PREFILTER_MIRROR";
    switch (lobe.kind) {
        case LobeKind::Mirror:
            return "NACRE_PREFILTER_MIRROR";
        case LobeKind::Diffuse:
            return "NACRE_PREFILTER_DIFFUSE";
        case LobeKind::Phong:
            return "NACRE_PREFILTER_PHONG";
        case LobeKind::Ggx:
            return "NACRE_PREFILTER_GGX";
        case LobeKind::Beckmann:
            return "NACRE_PREFILTER_BECKMANN";
        case LobeKind::GgxRefraction:
            return "NACRE_PREFILTER_GGX_REFRACTION";
        case LobeKind::BeckmannRefraction:
            return "NACRE_PREFILTER_BECKMANN_REFRACTION";
        case LobeKind::GgxAnisotropic:
            return "NACRE_PREFILTER_GGX_ANISOTROPIC";
    }
    throw std::invalid_argument("GpuPrefilter: no such lobe");
}

double chord(double theta) { return 2 * std::sin(std::min(theta, kPi / 2) / 2); }

/// Chord beyond which the lobe is left out.
double supportOf(const Lobe& lobe) {
    if (lobe.kind == LobeKind::Phong && lobe.exponent > 0) return chord(std::acos(std::pow(kTail, 1 / lobe.exponent)));
    const double tailSlope = lobe.alpha * std::sqrt(-std::log(kTail));  // where Beckmann's exponential is kTail
    if (lobe.kind == LobeKind::Beckmann) return chord(2 * std::atan(tailSlope));
    if (!isZonal(lobe.kind)) return chord(kPi / 2);
    const double end = zonalKernel(lobe).support;
    if (lobe.kind != LobeKind::BeckmannRefraction) return chord(end);
    const double thetaH = std::atan(tailSlope), sinT = std::sin(thetaH) / lobe.ior;
    return chord(sinT < 1 ? std::min(end, std::abs(thetaH - std::asin(sinT))) : end);
}

/// No lobe is read more coarsely than a cosine, of width 1, that ends as near. A hemisphere that ends sharply (Phong
/// below 1) is as hard to sum as a lobe a quarter as wide.
double widthOf(const Lobe& lobe) {
    if (lobe.kind == LobeKind::GgxAnisotropic) return std::min(2 * std::min(lobe.alpha, lobe.alphaY), 1.0);
    const ZonalKernel kernel = zonalKernel(lobe);
    const double width = std::min(kernel.width, chord(kernel.support) / std::sqrt(2.0));
    return lobe.kind == LobeKind::Phong && lobe.exponent < 1 ? width / 4 : width;
}

/// Steps of the shader's loops on a level of edge N, about: the share of its 6 N² texels that an ellipse holds, times
/// what boxes around it and neighbours that are drawn together add (measured: up to 2.4).
double stepsOn(const Lobe& lobe, int edge, double detail, bool last) {
    const bool anisotropic = lobe.kind == LobeKind::GgxAnisotropic;
    const double ratio = anisotropic ? std::max(lobe.alpha / lobe.alphaY, lobe.alphaY / lobe.alpha) : 1;
    const double reach = std::min({1.0, supportOf(lobe), last ? 1 : 4 * detail / edge});
    return 3 * 1.5 * sqr(edge) * reach * std::min(2.0, reach * ratio);
}

void validate(int sourceSize, const std::vector<PrefilterLevel>& levels, const GpuPrefilterOptions& options) {
    require(sourceSize >= 1, fmt::format("GpuPrefilter: expected a source size >= 1, found {}", sourceSize));
    require(options.detail >= 1 && options.detail <= 64,
            fmt::format("GpuPrefilter: expected a detail from 1 to 64, found {}", options.detail));
    require(!levels.empty(), "GpuPrefilter: expected one level or more");
    for (std::size_t k = 0; k < levels.size(); ++k) {
        validateLobe(levels[k].lobe);
        const int size = levels[0].size >> k;
        require(size >= 1 && levels[k].size == size,
                fmt::format("GpuPrefilter: expected level {} of size {}, found {}", k, size, levels[k].size));
    }
}

int halvings(int size) {
    int out = 0;
    for (; size % 2 == 0 && size > 1; size /= 2) ++out;
    return out;
}

void setFilter(GLenum target, GLint minify, GLint magnify, int lastLevel) {
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, minify);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, magnify);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_BASE_LEVEL, 0);
    glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, lastLevel);
}

void attach(GLenum target, GlName texture, int level) {
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, target, texture, level);
}

GLenum faceTarget(int face) { return GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face); }

void plainState() {
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glActiveTexture(GL_TEXTURE0);
}

class Stopwatch {
public:
    double milliseconds() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

GpuPrefilter::GpuPrefilter(ProgramLoader& loader, int sourceSize, std::vector<PrefilterLevel> levels,
                           const GpuPrefilterOptions& options)
    : sourceSize_(sourceSize), levels_(std::move(levels)), detail_(options.detail) {
    validate(sourceSize_, levels_, options);
    stripLevels_ = halvings(sourceSize_) + 1;
    for (int k = 0; k < levelCount(); ++k) parts_.push_back(partsOf(k));
    const char* vertex = "fullscreen.vert.glsl";
    for (const PrefilterLevel& level : levels_) {
        if (isMirror(level.lobe)) {
            int k = 0;
            while (k + 1 < stripLevels_ && sourceSize_ >> k > level.size) ++k;
            require(sourceSize_ >> k == level.size,
                    fmt::format("GpuPrefilter: a mirror's size must be the source's {} over a power of two, found {}",
                                sourceSize_, level.size));
        }
        programs_.push_back(
            &loader.load(vertex, "prefilter.frag.glsl", {{"NACRE_PREFILTER_LOBE", lobeDefine(level.lobe)}}));
    }
    copy_ = &loader.load(vertex, "prefilter_copy.frag.glsl");
    halve_ = &loader.load(vertex, "prefilter_halve.frag.glsl");
    makeTextures(options);
    warmUp();
}

void GpuPrefilter::makeTextures(const GpuPrefilterOptions& options) {
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, strip_.name());
    for (int k = 0; k < stripLevels_; ++k)
        glTexImage2D(GL_TEXTURE_2D, k, GL_RGBA32F, sourceSize_ >> k, 6 * (sourceSize_ >> k), 0, GL_RGBA, GL_FLOAT,
                     nullptr);
    setFilter(GL_TEXTURE_2D, GL_NEAREST_MIPMAP_NEAREST, GL_NEAREST, stripLevels_ - 1);
    int partial = 0;  // edge of the largest level that is summed in parts
    for (int k = levelCount() - 1; k >= 0; --k)
        if (parts_[k].size() > 1) partial = levels_[k].size;
    for (const TextureName& sums : sums_) {
        if (partial == 0) break;
        glBindTexture(GL_TEXTURE_2D, sums.name());
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, partial, partial, 0, GL_RGBA, GL_FLOAT, nullptr);
        setFilter(GL_TEXTURE_2D, GL_NEAREST, GL_NEAREST, 0);
    }
    glBindTexture(GL_TEXTURE_2D, 0);
    const GLint format = options.color == ColorFormat::Rgba16F ? GL_RGBA16F : GL_RGBA32F;
    for (const TextureName& chain : chains_) {
        glBindTexture(GL_TEXTURE_CUBE_MAP, chain.name());
        for (int k = 0; k < levelCount(); ++k) {
            const int size = levels_[k].size;
            const std::vector<float> black(static_cast<std::size_t>(size) * size * 4, 0.0f);
            for (int face = 0; face < 6; ++face)
                glTexImage2D(faceTarget(face), k, format, size, size, 0, GL_RGBA, GL_FLOAT, black.data());
        }
        setFilter(GL_TEXTURE_CUBE_MAP, GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR, levelCount() - 1);
    }
    glBindTexture(GL_TEXTURE_CUBE_MAP, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    const std::array<std::pair<GLenum, GlName>, 2> kinds = {
        {{GL_TEXTURE_2D, strip_.name()}, {faceTarget(0), chains_[0].name()}}};
    for (const auto& [target, name] : kinds) {
        attach(target, name, 0);
        const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
        if (status != GL_FRAMEBUFFER_COMPLETE)
            throw Error(fmt::format("GpuPrefilter: expected a complete framebuffer, found status 0x{:04x}", status));
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("textures of a GPU prefilter");
}

/// Drivers compile on a program's first draw, which no frame's budget should pay.
void GpuPrefilter::warmUp() {
    TextureName black;
    uploadCube(EnvMap(EnvLayout::Cube, 1), black);
    snapshot(black.name());
    glEnable(GL_SCISSOR_TEST);
    for (int level = 0; level < levelCount(); ++level) {
        prepare(level);
        drawBlocks(level, 0, 0, 1);
    }
    plainState();
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glFinish();
    checkGl("first draws of a GPU prefilter");
}

void GpuPrefilter::snapshot(GlName source) {
    plainState();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    attach(GL_TEXTURE_2D, strip_.name(), 0);
    glViewport(0, 0, sourceSize_, 6 * sourceSize_);
    glBindTexture(GL_TEXTURE_CUBE_MAP, source);
    copy_->set("nacre_prefilter_source", 0);
    copy_->set("nacre_prefilter_edge", sourceSize_);
    drawFullscreen(empty_);
    glBindTexture(GL_TEXTURE_CUBE_MAP, 0);
    glBindTexture(GL_TEXTURE_2D, strip_.name());
    halve_->set("nacre_prefilter_strip", 0);
    for (int k = 1; k < stripLevels_; ++k) {
        // Reading and drawing different levels of one texture is defined when the drawn one can't be read.
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, k - 1);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, k - 1);
        attach(GL_TEXTURE_2D, strip_.name(), k);
        glViewport(0, 0, sourceSize_ >> k, 6 * (sourceSize_ >> k));
        halve_->set("nacre_prefilter_edge", sourceSize_ >> k);
        drawFullscreen(empty_);
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, 0);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, stripLevels_ - 1);
}

/// Levels of the strip that a level's lobe is summed on.
GpuPrefilter::Range GpuPrefilter::rangeOf(int level) const {
    const double width = widthOf(levels_[level].lobe), support = supportOf(levels_[level].lobe);
    const auto place = [&](double angle) {  // as nacre_prefilter_share
        return std::clamp(std::log2(angle * sourceSize_ / (2 * detail_)), 0.0, stripLevels_ - 1.0);
    };
    return {static_cast<int>(std::floor(place(width))), static_cast<int>(std::ceil(place(std::max(width, support))))};
}

/// One part, or so many rows of one level of the strip that even all their texels are within kIterations.
std::vector<glm::ivec4> GpuPrefilter::partsOf(int level) const {
    const Lobe& lobe = levels_[level].lobe;
    if (isMirror(lobe)) return {glm::ivec4(0)};
    const Range range = rangeOf(level);
    double steps = 0;
    for (int k = range.first; k <= range.last; ++k) steps += stepsOn(lobe, sourceSize_ >> k, detail_, k == range.last);
    if (steps < kIterations) return {{range.first, range.last, 0, 6 * sourceSize_}};
    std::vector<glm::ivec4> out;
    for (int k = range.first; k <= range.last; ++k) {
        const int edge = sourceSize_ >> k, rows = std::max(1, kIterations / (edge + 8));  // 8: of the loops around
        for (int row = 0; row < 6 * edge; row += rows) out.push_back({k, k, row, std::min(6 * edge, row + rows)});
    }
    return out;
}

void GpuPrefilter::prepare(int level) const {
    const Lobe& lobe = levels_[level].lobe;
    const Program& program = *programs_[level];
    program.set("nacre_prefilter_strip", 0);
    program.set("nacre_prefilter_edge", sourceSize_);
    program.set("nacre_prefilter_size", static_cast<float>(levels_[level].size));
    if (isMirror(lobe)) {
        program.set("nacre_prefilter_first", halvings(sourceSize_ / levels_[level].size));
        return;
    }
    const double width = widthOf(lobe), support = supportOf(lobe);
    program.set("nacre_prefilter_first", rangeOf(level).first);
    program.set("nacre_prefilter_last", rangeOf(level).last);
    program.set("nacre_prefilter_before", 1);
    const double parameter = lobe.kind == LobeKind::Phong ? lobe.exponent : lobe.alpha;
    program.set("nacre_prefilter_lobe_values", glm::vec4(parameter, width, support, detail_));
    const bool anisotropic = lobe.kind == LobeKind::GgxAnisotropic;
    program.set("nacre_prefilter_second", static_cast<float>(anisotropic ? lobe.alphaY : (lobe.ior - 1) / lobe.ior));
    program.set("nacre_prefilter_axis", glm::vec3(glm::normalize(lobe.axis)));
    // GGX's anisotropic tails see every texel of a hemisphere, whatever alpha.
    program.set("nacre_prefilter_unseen",
                anisotropic ? 0.0f : static_cast<float>(kUnseen * zonalIntegral(zonalKernel(lobe))));
}

int GpuPrefilter::blocksAFace(int level) const {
    const int row = (levels_[level].size + kBlock - 1) / kBlock;
    return row * row;
}

/// \param blocks  within one row of blocks, or whole rows
void GpuPrefilter::drawBlocks(int level, int face, int firstBlock, int blocks) {
    const int size = levels_[level].size, row = (size + kBlock - 1) / kBlock;
    glViewport(0, 0, size, size);
    const int across = std::min(blocks, row), down = (blocks + row - 1) / row;
    glScissor(firstBlock % row * kBlock, firstBlock / row * kBlock, across * kBlock, down * kBlock);
    const Program& program = *programs_[level];
    program.set("nacre_prefilter_destination", kGlFaces[static_cast<std::size_t>(face)]);
    const std::vector<glm::ivec4>& parts = parts_[level];
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const bool ends = i + 1 == parts.size();
        if (!isMirror(levels_[level].lobe)) {
            program.set("nacre_prefilter_part", glm::vec4(parts[i]));
            program.set("nacre_prefilter_goes_on", i > 0 ? 1 : 0);
            program.set("nacre_prefilter_ends", ends ? 1 : 0);
        }
        if (parts.size() > 1) {
            glActiveTexture(GL_TEXTURE1);
            glBindTexture(GL_TEXTURE_2D, i > 0 ? sums_[(i + 1) % 2].name() : 0);
            glActiveTexture(GL_TEXTURE0);
        }
        if (ends)
            attach(faceTarget(face), chains_[1 - shown_].name(), level);
        else
            attach(GL_TEXTURE_2D, sums_[i % 2].name(), 0);
        drawFullscreen(empty_);
    }
    if (parts.size() == 1) return;
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, 0);
    glActiveTexture(GL_TEXTURE0);
}

bool GpuPrefilter::update(GlName source, double milliseconds) {
    const Stopwatch watch;
    if (!begun_) {
        snapshot(source);
        glFinish();
        begun_ = true;
        level_ = face_ = block_ = 0;
        blockMilliseconds_ = 0;
    }
    plainState();
    glEnable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glBindTexture(GL_TEXTURE_2D, strip_.name());
    prepare(level_);
    bool complete = false;
    do {
        const int row = (levels_[level_].size + kBlock - 1) / kBlock, inRow = row - block_ % row;
        const double left = milliseconds - watch.milliseconds();
        int blocks = blockMilliseconds_ > 0 ? static_cast<int>(std::clamp(left / blockMilliseconds_, 1.0, 1e6)) : 1;
        blocks = inRow == row && blocks >= row ? std::min(blocks / row * row, blocksAFace(level_) - block_)
                                               : std::min(blocks, inRow);
        const double start = watch.milliseconds();
        drawBlocks(level_, face_, block_, blocks);
        glFinish();
        blockMilliseconds_ = std::max((watch.milliseconds() - start) / blocks, 1e-4);
        block_ += blocks;
        if (block_ < blocksAFace(level_)) continue;
        block_ = 0;
        if (++face_ < 6) continue;
        face_ = 0;
        blockMilliseconds_ = 0;
        complete = ++level_ == levelCount();
        if (!complete) prepare(level_);
    } while (!complete && watch.milliseconds() + blockMilliseconds_ < milliseconds);
    plainState();
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("GPU prefilter");
    if (complete) {
        shown_ = 1 - shown_;
        ready_ = true;
        begun_ = false;
    }
    return complete;
}

double GpuPrefilter::progress() const {
    if (!begun_) return 0;
    double done = 0, all = 0;
    for (int k = 0; k < levelCount(); ++k) {
        const double face = blocksAFace(k);
        all += 6 * face;
        done += k < level_ ? 6 * face : k == level_ ? face_ * face + block_ : 0;
    }
    return done / all;
}

EnvMap GpuPrefilter::read(int level) const {
    require(level >= 0 && level < levelCount(), "GpuPrefilter: no such level");
    const int size = levels_[level].size;
    EnvMap out(EnvLayout::Cube, size);
    std::vector<float> pixels(static_cast<std::size_t>(size) * size * 4);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    for (int face = 0; face < 6; ++face) {
        attach(faceTarget(face), result(), level);
        glReadPixels(0, 0, size, size, GL_RGBA, GL_FLOAT, pixels.data());
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const glm::ivec2 at = glTexel(face, size, x, y);
                const float* p = &pixels[(static_cast<std::size_t>(at.y) * size + at.x) * 4];
                out.image.setRgb(x, face * size + y, Rgb(p[0], p[1], p[2]));
            }
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("reading a prefiltered cube");
    return out;
}

void uploadCube(const EnvMap& map, const TextureName& texture) {
    require(map.layout == EnvLayout::Cube, "uploadCube: expected a cube");
    const int size = map.size();
    std::vector<float> pixels(static_cast<std::size_t>(size) * size * 3);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_CUBE_MAP, texture.name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (int face = 0; face < 6; ++face) {
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const glm::ivec2 at = glTexel(face, size, x, y);
                for (int c = 0; c < 3; ++c)
                    pixels[(static_cast<std::size_t>(at.y) * size + at.x) * 3 + c] =
                        map.image.at(x, face * size + y, c);
            }
        glTexImage2D(faceTarget(face), 0, GL_RGB32F, size, size, 0, GL_RGB, GL_FLOAT, pixels.data());
    }
    setFilter(GL_TEXTURE_CUBE_MAP, GL_LINEAR, GL_LINEAR, 0);
    glBindTexture(GL_TEXTURE_CUBE_MAP, 0);
    checkGl("upload of a cube");
}

}  // namespace nacre
