// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace tesserae::render {

/// Name of the header attribute that holds the scene hash.
inline constexpr const char* kSceneHashAttribute = "tesserae/sceneHash";
/// Names of those that hold the versions of the law of motion and of the picture.
inline constexpr const char* kMotionVersionAttribute = "tesserae/motionVersion";
inline constexpr const char* kPictureVersionAttribute = "tesserae/pictureVersion";

/// An attribute of a header: a text, a number, or some (a rational number's two parts, the four
/// of a camera's vector).
struct ImageAttribute {
    std::string name;
    std::variant<std::string, std::int64_t, double, std::vector<std::int64_t>, std::vector<double>>
        value;
    std::string text;  ///< the value as a person reads it
};

/// What an image's header says, without its pixels.
struct ImageInfo {
    int width = 0, height = 0;           ///< of the whole frame [pixels]
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< the pixels that the file holds, half open
    std::vector<std::string> channels;
    std::vector<ImageAttribute> attributes;       ///< those of simple types, by name
    std::string scene_hash;                       ///< empty: not written by tesserae
    int motion_version = 1, picture_version = 1;  ///< 1 where the header does not say it
};

/// @throws InputError   not a readable OpenEXR file, with the path and the reason
ImageInfo read_image_info(const std::filesystem::path& file);

}  // namespace tesserae::render
