// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/file/channel_places.hpp"
#include "render/file/preview.hpp"
#include "render/finished_picture.hpp"

namespace tesserae {

/// What is in a finished picture.
struct Picture::Inside {
    struct Layer {
        std::vector<std::string> channels;  ///< their names in files
        std::vector<float> values;          ///< by rows, in each by pixels, of each by channels
    };

    /// Room for the layers that some channels make.
    Inside(const render::Crop& window, std::span<const render::ChannelPlace> places);

    /// Sets a pixel's value.
    /// @param channel   index into the places
    float& value(std::size_t channel, int x, int y);
    /// @throws InputError   there is no such layer
    const Layer& layer(std::string_view name) const;

    render::Crop window;
    std::vector<std::string> names;  ///< of the layers
    std::vector<Layer> layers;
    std::string image;                       ///< the bytes of its file
    std::optional<render::Preview> preview;  ///< none without colour
    std::vector<std::string> warnings;

  private:
    struct Place {
        std::size_t layer, channel;
    };
    std::vector<Place> places_;
};

}  // namespace tesserae
