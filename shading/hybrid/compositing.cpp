#include "shading/hybrid/compositing.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <bit>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"

namespace nacre {
namespace {

std::size_t floatsIn(std::span<const RenderTarget* const> targets, ImageRows rows) {
    return 4 * static_cast<std::size_t>(targets[0]->width()) * static_cast<std::size_t>(rows.count);
}

/// Draws pixels of readRows' form onto the targets.
void addRows(ProgramLoader& loader, std::span<const RenderTarget* const> targets, ImageRows rows,
             std::span<const float> pixels) {
    if (rows.count == 0) return;
    const Program& program = loader.load("fullscreen.vert.glsl", "pipe_add.frag.glsl");
    const std::size_t size = floatsIn(targets, rows);
    const TextureName texture;
    const VertexArray empty;
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    program.set("nacre_pipe_image", 0);
    program.set("nacre_pipe_row", rows.first);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    for (std::size_t i = 0; i < targets.size(); ++i) {
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, targets[i]->width(), rows.count, 0, GL_RGBA, GL_FLOAT,
                     pixels.subspan(i * size, size).data());
        targets[i]->bind();
        glViewport(0, rows.first, targets[i]->width(), rows.count);
        drawFullscreen(empty);
    }
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glBindTexture(GL_TEXTURE_2D, 0);
    checkGl("adding images of pipes");
}

/// The half of the rows that the lower or the upper partner keeps.
ImageRows half(ImageRows rows, bool upper) {
    const int lower = rows.count / 2;
    return upper ? ImageRows{rows.first + lower, rows.count - lower} : ImageRows{rows.first, lower};
}

}  // namespace

std::vector<float> readRows(std::span<const RenderTarget* const> targets, ImageRows rows) {
    const std::size_t size = floatsIn(targets, rows);
    std::vector<float> out(size * targets.size());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    for (std::size_t i = 0; i < targets.size() && rows.count > 0; ++i) {
        targets[i]->bindForReading();
        glReadPixels(0, rows.first, targets[i]->width(), rows.count, GL_RGBA, GL_FLOAT, out.data() + i * size);
    }
    checkGl("reading a pipe's image");
    return out;
}

ImageRows rowsAfterSwap(int height, int index, int count) {
    const int whole = static_cast<int>(std::bit_floor(static_cast<unsigned>(count)));
    if (index >= whole) return {};
    ImageRows rows{0, height};
    for (int bit = 1; bit < whole; bit *= 2) rows = half(rows, (index & bit) != 0);
    return rows;
}

bool binarySwap(ProgramLoader& loader, PipeLink& link, std::span<const int> pipes,
                std::span<const RenderTarget* const> targets, PipeClock::time_point deadline) {
    require(!targets.empty(), "binary swap: expected images");
    const auto found = std::find(pipes.begin(), pipes.end(), link.self());
    require(found != pipes.end(), "binary swap: expected this pipe among those that take part");
    const auto count = static_cast<int>(pipes.size()), index = static_cast<int>(found - pipes.begin());
    const int whole = static_cast<int>(std::bit_floor(pipes.size()));
    const auto pipe = [&](int i) { return pipes[static_cast<std::size_t>(i)]; };
    ImageRows rows{0, targets[0]->height()};
    if (index >= whole) {
        const std::vector<float> mine = readRows(targets, rows);
        return link.exchange(pipe(index - whole), PipeWay::Image, bytesIn(mine), {}, deadline);
    }
    bool good = true;
    const auto add = [&](int partner, ImageRows kept, const std::vector<float>& given) {
        std::vector<float> theirs(targets.size() * floatsIn(targets, kept));
        const bool there = link.exchange(pipe(partner), PipeWay::Image, bytesIn(given), roomIn(theirs), deadline);
        if (there) addRows(loader, targets, kept, theirs);
        good = good && there;
    };
    if (index + whole < count) add(index + whole, rows, {});
    for (int bit = 1; bit < whole; bit *= 2) {
        const bool upper = (index & bit) != 0;
        const ImageRows kept = half(rows, upper);
        add(index ^ bit, kept, readRows(targets, half(rows, !upper)));
        rows = kept;
    }
    return good;
}

void addImages(std::vector<float>& sum, std::span<const std::vector<float>> images, unsigned threads) {
    for (const std::vector<float>& image : images)
        require(image.size() == sum.size(), "compositing: expected images of one size");
    constexpr std::size_t kChunk = 1 << 16;
    parallelFor((sum.size() + kChunk - 1) / kChunk, threads, [&](std::size_t chunk) {
        const std::size_t end = std::min(sum.size(), (chunk + 1) * kChunk);
        for (const std::vector<float>& image : images)
            for (std::size_t i = chunk * kChunk; i < end; ++i) sum[i] += image[i];
    });
}

Image imageOf(std::span<const float> pixels, int width, int height) {
    const std::size_t row = 4 * static_cast<std::size_t>(width);
    require(pixels.size() == row * static_cast<std::size_t>(height), "compositing: expected four floats a pixel");
    Image out(width, height, 4);
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
        std::copy_n(pixels.begin() + static_cast<std::ptrdiff_t>(y * row), row,
                    out.data().begin() + static_cast<std::ptrdiff_t>((static_cast<std::size_t>(height) - 1 - y) * row));
    return out;
}

}  // namespace nacre
