// SPDX-License-Identifier: Apache-2.0
#include "scenes/compare/image_difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tesserae::scenes {
namespace {

using render::Crop;
using render::ImageChannel;
using render::ImagePixels;
using render::PixelType;

/// A channel of both images: its places in their planes.
struct SharedChannel {
    std::size_t in_a = 0, in_b = 0;
    PixelType type = PixelType::kHalf;
    double sum_of_squares = 0;
    ChannelDifference difference;
};

Crop intersection(const Crop& a, const Crop& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

std::vector<SharedChannel> match_channels(const std::vector<ImageChannel>& a,
                                          const std::vector<ImageChannel>& b,
                                          ImageDifference& difference) {
    std::vector<SharedChannel> shared;
    const auto is_named = [](const std::string& name) {
        return [&name](const ImageChannel& c) { return c.name == name; };
    };
    for (std::size_t i = 0; i < a.size(); ++i) {
        const auto other = std::find_if(b.begin(), b.end(), is_named(a[i].name));
        if (other == b.end()) {
            difference.only_a.push_back(a[i].name);
        } else if (other->type != a[i].type) {
            difference.other_type.push_back(fmt::format("{}: {} in A, {} in B", a[i].name,
                                                        name_of(a[i].type), name_of(other->type)));
        } else {
            SharedChannel channel{i, static_cast<std::size_t>(other - b.begin()), a[i].type, 0, {}};
            channel.difference.name = a[i].name;
            shared.push_back(std::move(channel));
        }
    }
    for (const ImageChannel& c : b)
        if (std::none_of(a.begin(), a.end(), is_named(c.name))) difference.only_b.push_back(c.name);
    return shared;
}

/// The bytes of a line's pixel in a plane that begins with line y0.
const unsigned char* bytes_at(const render::PixelPlanes& planes, std::size_t channel,
                              PixelType type, const Crop& window, int x, int y, int y0) {
    const auto width = static_cast<std::size_t>(window.x1 - window.x0);
    const std::size_t pixel =
        static_cast<std::size_t>(y - y0) * width + static_cast<std::size_t>(x - window.x0);
    return planes[channel].data() + pixel * render::bytes_of(type);
}

/// The shortest decimal that reads back as the value.
std::string text_of(PixelType type, double value) {
    // Of a half or float the decimal that is shortest among floats.
    return type == PixelType::kUint ? fmt::format("{}", static_cast<std::uint32_t>(value))
                                    : fmt::format("{}", static_cast<float>(value));
}

class PixelComparison {
  public:
    PixelComparison(const ImagePixels& a, const ImagePixels& b, ImageDifference& difference)
        : a_(a),
          b_(b),
          both_(intersection(a.window(), b.window())),
          channels_(match_channels(a.channels(), b.channels(), difference)),
          difference_(difference) {}

    void compare() {
        if (both_.x0 >= both_.x1 || both_.y0 >= both_.y1) return;
        const int lines = std::min(a_.block_lines(), b_.block_lines());
        for (int y0 = both_.y0; y0 < both_.y1;) {
            const int y1 = std::min(both_.y1, y0 + lines);
            a_.read(y0, y1, planes_a_);
            b_.read(y0, y1, planes_b_);
            for (int y = y0; y < y1; ++y)
                for (SharedChannel& channel : channels_) compare_line(channel, y, y0);
            y0 = y1;
        }
        const double pixels =
            static_cast<double>(both_.x1 - both_.x0) * static_cast<double>(both_.y1 - both_.y0);
        for (SharedChannel& channel : channels_) {
            if (channel.difference.pixels == 0) continue;
            channel.difference.rms = std::sqrt(channel.sum_of_squares / pixels);
            difference_.channels.push_back(std::move(channel.difference));
        }
    }

  private:
    void compare_line(SharedChannel& channel, int y, int y0) {
        const std::size_t bytes = render::bytes_of(channel.type);
        const unsigned char* a =
            bytes_at(planes_a_, channel.in_a, channel.type, a_.window(), both_.x0, y, y0);
        const unsigned char* b =
            bytes_at(planes_b_, channel.in_b, channel.type, b_.window(), both_.x0, y, y0);
        if (std::memcmp(a, b, bytes * static_cast<std::size_t>(both_.x1 - both_.x0)) == 0) return;
        for (int x = both_.x0; x < both_.x1; ++x, a += bytes, b += bytes)
            if (std::memcmp(a, b, bytes) != 0)
                add(channel, x, y, render::value_of(channel.type, a),
                    render::value_of(channel.type, b));
    }

    void add(SharedChannel& channel, int x, int y, double a, double b) {
        std::optional<PixelDifference>& first = difference_.first;
        // Within a line channel comes after channel: the first pixel may be of a later one.
        if (!first || (y == first->y && x < first->x))
            first = PixelDifference{x,
                                    y,
                                    channel.difference.name,
                                    text_of(channel.type, a),
                                    text_of(channel.type, b),
                                    std::abs(a - b)};
        ChannelDifference& sum = channel.difference;
        ++sum.pixels;
        if (!std::isfinite(a) || !std::isfinite(b)) {
            ++sum.not_finite;
            return;
        }
        const double apart = std::abs(a - b);
        channel.sum_of_squares += apart * apart;
        if (sum.pixels - sum.not_finite == 1 || apart > sum.largest)
            sum.largest = apart, sum.x = x, sum.y = y;
    }

    const ImagePixels &a_, &b_;
    Crop both_;
    std::vector<SharedChannel> channels_;
    ImageDifference& difference_;
    render::PixelPlanes planes_a_, planes_b_;
};

}  // namespace

ImageDifference compare_images(const std::filesystem::path& a, const std::filesystem::path& b) {
    const ImagePixels image_a(a), image_b(b);
    ImageDifference difference;
    difference.window_a = image_a.window(), difference.window_b = image_b.window();
    PixelComparison(image_a, image_b, difference).compare();
    return difference;
}

}  // namespace tesserae::scenes
