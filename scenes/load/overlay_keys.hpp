// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenes/load/picture_keys.hpp"
#include "scenes/overlay/overlay.hpp"

namespace tesserae::scenes {

/// Text that is shown on one line.
struct OneLine {
    static constexpr const char* kAllowed = "one line, at most 1000 bytes";
    bool may_be_empty = false;

    void read(TableReader& reader, const char* key, std::string& text) const {
        if (!reader.read(key, text)) return;
        const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
        if ((text.empty() && !may_be_empty) || text.size() > 1000 ||
            std::any_of(text.begin(), text.end(), is_control))
            reader.fail(key, fmt::format("expected one line of text{}, at most 1000 bytes",
                                         may_be_empty ? "" : " that is not empty"));
    }
    void write(EffectiveWriter& out, const char* key, const std::string& text) const {
        if (!text.empty()) out.key(key, text);
    }
};

/// [overlay], but for its [[overlay.caption]]
void overlay_keys(auto& self, const auto& visit) {
    visit({"title", "", "This line stands at the top left."}, self.title, OneLine{true});
    visit({"time", "", "The frame's time is told."}, self.time, FalseOrUnwritten{});
    visit({"w", "", "How far along its fourth axis the slice is, is told."}, self.w,
          FalseOrUnwritten{});
    visit({"dial", "",
           "While the slice turns, a needle shows the angle between its fourth axis and w."},
          self.dial, FalseOrUnwritten{});
    visit({"text_size", "", "A line of text is this part of the picture's height."}, self.text_size,
          Interval{0, 1, true});
    visit({"color", "", "Text and dial have this color; a dark rim is round them."}, self.color,
          kUnit);
    visit({"font", "", "Text is in the font of this file, which has a path from where you are."},
          self.font, NotEmpty{});
}

/// [[overlay.caption]]
void caption_keys(auto& self, const auto& visit) {
    visit({"text", "", "This line stands in the middle, at the bottom."}, self.text,
          Required{"expected a line of text", OneLine{}});
    visit({"from", "s", "The caption is shown from this time on."}, self.from, Interval{});
    visit({"to", "s", "The caption is gone at this time.", "the film's end"}, self.to,
          RealOrUnwritten{Interval{}, Caption{}.to});
}

}  // namespace tesserae::scenes
