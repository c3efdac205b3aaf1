// SPDX-License-Identifier: Apache-2.0
#include "render/file/preview.hpp"

#include <png.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <new>
#include <numeric>

#include "core/error.hpp"
#include "core/file/file_writer.hpp"

namespace tesserae::render {
namespace {

/// Steps of a summed value. sRGB's first code is 320 of them, and over the largest area (65536 x
/// 65536) a sum is exact as a double.
constexpr double kOne = 1 << 20;

/// Steps of a linear value. What is no number, as a damaged image may hold it, is black.
std::uint64_t steps_of(double value) {
    return value > 0 ? static_cast<std::uint64_t>(std::lround(kOne * std::min(value, 1.0))) : 0;
}

/// sRGB code of a linear value in [0, 1] (IEC 61966-2-1).
std::uint8_t srgb_code(double v) {
    const double encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

/// Where libpng's bytes go and what went wrong on the way.
struct PngTarget {
    FileWriter* writer;
    std::exception_ptr failure;  ///< of the writer: exceptions must not cross libpng's C frames
    char message[120] = "";      ///< libpng's own
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    auto* target = static_cast<PngTarget*>(png_get_error_ptr(png));
    std::snprintf(target->message, sizeof target->message, "%s", message);
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_bytes(png_structp png, png_bytep bytes, png_size_t count) {
    auto* target = static_cast<PngTarget*>(png_get_io_ptr(png));
    try {
        target->writer->write(bytes, count);
        return;
    } catch (...) {
        target->failure = std::current_exception();
    }
    png_error(png, "write");
}

void on_flush(png_structp) {}

/// All calls that can jump back here. Nothing in this frame has a destructor, and nothing that
/// changes after setjmp is read after a jump.
bool encode(png_structp png, png_infop info, PngTarget* target, int width, int height, int channels,
            const std::uint8_t* pixels) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_write_fn(png, target, on_bytes, on_flush);
    // A seventh larger than by default, in a third of the time.
    png_set_compression_level(png, 2);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
                 channels == 4 ? PNG_COLOR_TYPE_RGBA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    for (int y = 0; y < height; ++y)
        png_write_row(png, pixels + static_cast<std::size_t>(y) * static_cast<std::size_t>(width) *
                                        static_cast<std::size_t>(channels));
    png_write_end(png, info);
    return true;
}

}  // namespace

PreviewSize preview_size_of(const Settings& settings, const Crop& window) {
    const int width = window.x1 - window.x0, height = window.y1 - window.y0;
    const int wanted = settings.preview_size > 0 ? settings.preview_size : kPreviewWidth;
    if (wanted >= width) return {width, height};
    // Half of height * wanted / width, rounded.
    const std::int64_t whole = width, half = (std::int64_t{height} * wanted + whole) / (2 * whole);
    return {wanted, static_cast<int>(std::max<std::int64_t>(2, 2 * half))};
}

PreviewAxis::PreviewAxis(int picture, int preview) {
    const int common = std::gcd(picture, preview);
    of_picture_ = static_cast<std::uint64_t>(preview / common);
    of_preview_ = static_cast<std::uint64_t>(picture / common);
}

Preview::Preview(const Crop& window, const Settings& settings, std::span<const Stamp> overlay)
    : window_(window),
      gain_(std::min(std::exp2(settings.exposure), std::numeric_limits<double>::max())),
      sky_(settings.sky),
      ghosts_(settings.ghosts),
      overlay_(overlay.begin(), overlay.end()),
      size_(preview_size_of(settings, window)),
      columns_(window.x1 - window.x0, size_.width),
      rows_(window.y1 - window.y0, size_.height),
      sums_(static_cast<Sum*>(std::calloc(count(), sizeof(Sum)))) {
    if (!sums_) throw std::bad_alloc();
}

void Preview::add(int x, int y, const PreviewPixel& pixel) {
    const std::array<float, 4> over =
        ghosts_ == GhostsIn::kOver ? pixel.ghost : std::array<float, 4>{};
    const double clear = 1 - over[3];
    Sum value = {};
    for (std::size_t i = 0; i < 3; ++i)
        value[i] = steps_of(std::min(gain_ * pixel.color[i], 1.0) * clear + over[i]);
    if (sky_ == Sky::kTransparent) value[3] = steps_of(pixel.color[3] * clear + over[3]);
    rows_.for_each_overlap(y - window_.y0, [&](std::uint64_t row, std::uint64_t height) {
        columns_.for_each_overlap(x - window_.x0, [&](std::uint64_t column, std::uint64_t width) {
            Sum& sum = sums_[row * static_cast<std::uint64_t>(size_.width) + column];
            for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += width * height * value[i];
        });
    });
}

void Preview::add(const TileImage& tile) {
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x) {
            const Pixel& pixel = tile.at(x, y);
            PreviewPixel shown = {{pixel.color[0], pixel.color[1], pixel.color[2], pixel.alpha},
                                  {}};
            if (!tile.layers.empty())
                std::copy_n(tile.layers[tile.index(x, y)].ghost, 4, shown.ghost.begin());
            add(x, y, shown);
        }
}

bool Preview::add_sums(std::uint64_t first, std::span<const Sum> sums) {
    if (first > count() || sums.size() > count() - first) return false;
    for (std::size_t i = 0; i < sums.size(); ++i)
        for (std::size_t c = 0; c < 4; ++c) sums_[first + i][c] += sums[i][c];
    return true;
}

std::vector<std::uint8_t> Preview::codes() const {
    const auto channels = static_cast<std::size_t>(this->channels());
    std::vector<std::uint8_t> pixels(channels * count());
    const double all = kOne * static_cast<double>(columns_.length() * rows_.length());
    const auto width = static_cast<std::size_t>(size_.width);
    tbb::parallel_for(0, size_.height, [&](int y) {
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t at = static_cast<std::size_t>(y) * width + x;
            std::array<double, 4> sum;
            std::copy(sums_[at].begin(), sums_[at].end(), sum.begin());
            const double covered = sum[3] > 0 ? sum[3] : std::max({sum[0], sum[1], sum[2]});
            const double whole = channels == 3 ? all : covered;
            for (std::size_t i = 0; i < 3; ++i)
                pixels[channels * at + i] =
                    whole > 0 ? srgb_code(std::min(sum[i] / whole, 1.0)) : 0;
            if (channels == 4)
                pixels[channels * at + 3] =
                    static_cast<std::uint8_t>(std::lround(255 * covered / all));
        }
    });
    return pixels;
}

void Preview::write(const std::filesystem::path& path) const {
    std::vector<std::uint8_t> pixels = codes();
    lay_over(overlay_, size_.width, size_.height, channels(), pixels);
    FileWriter writer(path);
    PngTarget target = {&writer, nullptr};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &target, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    const bool done =
        info && encode(png, info, &target, size_.width, size_.height, channels(), pixels.data());
    png_destroy_write_struct(&png, &info);
    if (target.failure) std::rethrow_exception(target.failure);
    if (!done)
        throw RunError(fmt::format("{}: libpng: {}", path.string(),
                                   target.message[0] ? target.message : "out of memory"));
    writer.finish();
}

}  // namespace tesserae::render
