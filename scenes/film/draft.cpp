// SPDX-License-Identifier: Apache-2.0
#include "scenes/film/draft.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tesserae::scenes {

std::vector<std::string> draft_overrides(const Scene& scene) {
    const render::Settings& settings = scene.render;
    constexpr int kSmaller = 3, kFewer = 4;
    const auto smaller = [](int pixels) { return (pixels + kSmaller - 1) / kSmaller; };
    std::vector<std::string> sets = {
        fmt::format("render.size=[{}, {}]", smaller(settings.width), smaller(settings.height)),
        fmt::format("render.samples={}", std::max(1, settings.samples / kFewer)),
        "render.integrator=\"direct\"", "render.noise_target=0"};
    if (!scene.gives_ghost_depth) {
        sets.push_back("render.ghost_depth=1");
        sets.push_back("render.ghosts=\"over\"");
    }
    if (settings.preview_size > 0)
        sets.push_back(fmt::format("render.preview_size={}", smaller(settings.preview_size)));
    if (settings.crop) {
        const render::Crop& c = *settings.crop;
        sets.push_back(fmt::format("render.crop=[{}, {}, {}, {}]", c.x0 / kSmaller, c.y0 / kSmaller,
                                   smaller(c.x1), smaller(c.y1)));
    }
    return sets;
}

}  // namespace tesserae::scenes
