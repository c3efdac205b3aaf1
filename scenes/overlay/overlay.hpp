// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "render/description.hpp"

namespace tesserae::scenes {

/// A line of text that is shown for some time.
struct Caption {
    std::string text;
    double from = 0;                                      ///< [s]
    double to = std::numeric_limits<double>::infinity();  ///< left out itself [s]
};

/// What is written over previews and films: [overlay] of a scene.
struct Overlay {
    std::string title;
    bool time = false;        ///< of the frame [s]
    bool w = false;           ///< how far along its fourth axis the slice is [m]
    bool dial = false;        ///< how far the slice has turned, while it turns
    double text_size = 0.05;  ///< of a line, as a part of the picture's height
    render::Color color = render::Color::Ones();  ///< linear
    std::string font = kFont;                     ///< a file that FreeType reads
    std::vector<Caption> captions;

    static constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

    bool is_empty() const { return title.empty() && !time && !w && !dial && captions.empty(); }
};

}  // namespace tesserae::scenes
