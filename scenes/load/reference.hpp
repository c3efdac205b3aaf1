// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace tesserae::scenes {

/// The reference of scene files, as Markdown: every table and key with its type, unit, default,
/// what is allowed, and what it means. Made from the lists of keys by which scenes are read.
/// @param topic   "": all of it; else a table or one of its keys: "render", "body.friction"
/// @throws InputError   no table or key is called so; names the nearest
std::string reference(std::string_view topic);

}  // namespace tesserae::scenes
