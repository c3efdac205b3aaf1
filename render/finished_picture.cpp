// SPDX-License-Identifier: Apache-2.0
#include "render/finished_picture.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "core/file/file_writer.hpp"
#include "core/file/read_file.hpp"
#include "render/picture_inside.hpp"

namespace tesserae {
namespace {

namespace fs = std::filesystem;

/// The channels of a file that tesserae writes, those of a layer after each other.
std::vector<render::ChannelPlace> places_in(std::span<const render::ImageChannel> channels) {
    std::vector<render::ChannelPlace> places;
    const auto is_there = [&](const std::string& name) {
        return std::find_if(channels.begin(), channels.end(), [&](const auto& channel) {
                   return channel.name == name;
               }) != channels.end();
    };
    for (render::ChannelPlace& place : render::all_channel_places())
        if (is_there(place.name)) places.push_back(std::move(place));
    return places;
}

/// What a preview shows of a pixel of the layers "color" and "ghost".
render::PreviewPixel preview_pixel(const Picture::Inside::Layer& color,
                                   const Picture::Inside::Layer* ghost, std::size_t pixel) {
    render::PreviewPixel shown;
    std::copy_n(color.values.begin() + static_cast<std::ptrdiff_t>(4 * pixel), 4,
                shown.color.begin());
    if (ghost != nullptr)
        std::copy_n(ghost->values.begin() + static_cast<std::ptrdiff_t>(4 * pixel), 4,
                    shown.ghost.begin());
    return shown;
}

/// The preview of pixels that were read from a file, without exposure and overlay.
std::optional<render::Preview> preview_of(const Picture::Inside& picture) {
    const auto find = [&](const char* name) -> const Picture::Inside::Layer* {
        const auto at = std::find(picture.names.begin(), picture.names.end(), name);
        if (at == picture.names.end()) return nullptr;
        const auto& layer = picture.layers[static_cast<std::size_t>(at - picture.names.begin())];
        return layer.channels.size() == 4 ? &layer : nullptr;
    };
    const Picture::Inside::Layer* color = find("color");
    if (color == nullptr) return {};
    std::optional<render::Preview> preview(std::in_place, picture.window, render::Settings());
    std::size_t pixel = 0;
    for (int y = picture.window.y0; y < picture.window.y1; ++y)
        for (int x = picture.window.x0; x < picture.window.x1; ++x)
            preview->add(x, y, preview_pixel(*color, find("ghost"), pixel++));
    return preview;
}

/// A file of one kind must not be named as another.
void require_ending(const fs::path& file, const char* ending) {
    if (file.extension() != ending)
        throw InputError(fmt::format("{}: expected a name that ends in {}", file.string(), ending));
}

}  // namespace

Picture::Inside::Inside(const render::Crop& of, std::span<const render::ChannelPlace> places)
    : window(of) {
    for (const render::ChannelPlace& place : places) {
        const auto at = std::find(names.begin(), names.end(), place.layer);
        const auto layer = static_cast<std::size_t>(at - names.begin());
        if (at == names.end()) {
            names.emplace_back(place.layer);
            layers.emplace_back();
        }
        places_.push_back({layer, layers[layer].channels.size()});
        layers[layer].channels.push_back(place.name);
    }
    const auto pixels = static_cast<std::size_t>(window.x1 - window.x0) *
                        static_cast<std::size_t>(window.y1 - window.y0);
    for (Layer& layer : layers) layer.values.resize(pixels * layer.channels.size());
}

float& Picture::Inside::value(std::size_t channel, int x, int y) {
    const Place& place = places_[channel];
    Layer& layer = layers[place.layer];
    const auto pixel =
        static_cast<std::size_t>(y - window.y0) * static_cast<std::size_t>(window.x1 - window.x0) +
        static_cast<std::size_t>(x - window.x0);
    return layer.values[pixel * layer.channels.size() + place.channel];
}

const Picture::Inside::Layer& Picture::Inside::layer(std::string_view name) const {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end())
        throw InputError(fmt::format("layer \"{}\": the picture has none of this name; it has {}",
                                     name, fmt::join(names, ", ")));
    return layers[static_cast<std::size_t>(at - names.begin())];
}

Picture Picture::read(const fs::path& exr) {
    const render::ImagePixels pixels(exr);
    const std::vector<render::ChannelPlace> places = places_in(pixels.channels());
    if (places.empty())
        throw InputError(fmt::format("{}: has no channel that tesserae writes", exr.string()));
    const auto inside = std::make_shared<Inside>(pixels.window(), places);
    pixels.for_each_block([&](int begin, int end, const render::PixelPlanes& planes) {
        for (std::size_t i = 0; i < places.size(); ++i) {
            const auto& channels = pixels.channels();
            const auto at = std::find_if(channels.begin(), channels.end(),
                                         [&](const auto& c) { return c.name == places[i].name; });
            const unsigned char* value =
                planes[static_cast<std::size_t>(at - channels.begin())].data();
            for (int y = begin; y < end; ++y)
                for (int x = inside->window.x0; x < inside->window.x1; ++x) {
                    inside->value(i, x, y) = static_cast<float>(render::value_of(at->type, value));
                    value += render::bytes_of(at->type);
                }
        }
    });
    inside->image = read_file(exr);
    inside->preview = preview_of(*inside);
    return Picture(inside);
}

int Picture::width() const { return inside_->window.x1 - inside_->window.x0; }
int Picture::height() const { return inside_->window.y1 - inside_->window.y0; }
int Picture::left() const { return inside_->window.x0; }
int Picture::top() const { return inside_->window.y0; }

const std::vector<std::string>& Picture::layers() const { return inside_->names; }

bool Picture::has(std::string_view layer) const {
    return std::find(layers().begin(), layers().end(), layer) != layers().end();
}

const std::vector<std::string>& Picture::channels(std::string_view layer) const {
    return inside_->layer(layer).channels;
}

std::span<const float> Picture::layer(std::string_view name) const {
    return inside_->layer(name).values;
}

const std::vector<std::string>& Picture::warnings() const { return inside_->warnings; }

void Picture::write_image(const fs::path& exr) const {
    require_ending(exr, ".exr");
    write_file(exr, inside_->image);
}

void Picture::write_preview(const fs::path& png) const {
    require_ending(png, ".png");
    if (!inside_->preview) inside_->layer("color");
    if (!inside_->preview)
        throw InputError("layer \"color\": has not all of R, G, B and A: no preview without them");
    inside_->preview->write(png);
}

}  // namespace tesserae
