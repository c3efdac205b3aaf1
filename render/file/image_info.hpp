#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tesserae::render {

/// Name of the header attribute that holds the scene hash.
inline constexpr const char* kSceneHashAttribute = "tesserae/sceneHash";

/// What an image's header says, without its pixels.
struct ImageInfo {
    int width = 0, height = 0;           ///< of the whole frame [pixels]
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< the pixels that the file holds, half open
    std::vector<std::string> channels;
    std::vector<std::pair<std::string, std::string>> attributes;  ///< texts and numbers, by name
    std::string scene_hash;  ///< empty: not written by tesserae
};

/// @throws InputError   not a readable OpenEXR file, with the path and the reason
ImageInfo read_image_info(const std::filesystem::path& file);

}  // namespace tesserae::render
