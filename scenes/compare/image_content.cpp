// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "render/file/image_pixels.hpp"
#include "scenes/compare/file_content.hpp"
#include "scenes/load/hash.hpp"

namespace tesserae::scenes {

Content image_content(const std::filesystem::path& file) {
    const render::ImagePixels image(file);
    const render::Crop& window = image.window();
    std::vector<StreamHash> hashes(image.channels().size());
    image.for_each_block([&](int, int, const render::PixelPlanes& planes) {
        for (std::size_t c = 0; c < hashes.size(); ++c)
            hashes[c].add(planes[c].data(), planes[c].size());
    });
    Content content{FileKind::kImage, {}};
    for (std::size_t c = 0; c < hashes.size(); ++c) {
        const render::ImageChannel& channel = image.channels()[c];
        content.entries.push_back({channel.name,
                                   fmt::format("{} {},{} to {},{}", render::name_of(channel.type),
                                               window.x0, window.y0, window.x1, window.y1),
                                   hashes[c].hex()});
    }
    return content;
}

}  // namespace tesserae::scenes
