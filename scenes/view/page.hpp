// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tesserae::scenes {

/// A file of the page's sources, scenes/view/page, as it was when the program was built.
struct PageSource {
    std::string_view name, text;
};
/// All of them, by name; written by embed.cmake.
const std::vector<PageSource>& page_sources();

/// The page: index.html, with each source and datum that it names in place of the name.
/// @param hash    of the scene, 32 hexadecimal digits: by it a page is known again
/// @param scene   as page_scene()
/// @param poses   as PosePacker
/// @param joints  the page draws joints; else what index.html has for them is left out
std::string page_text(std::string_view hash, std::string_view scene, std::string_view poses,
                      bool joints);

/// The scene's hash of a page that page_text() made, from its beginning; empty if it is none.
std::string page_hash(std::string_view beginning);

}  // namespace tesserae::scenes
