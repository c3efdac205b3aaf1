// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tesserae::scenes {

/// The name that `word` was probably meant to be: the one with the fewest edits (a character
/// inserted, removed, replaced, or two neighbours swapped; letter case is free), if that is at most
/// a third of the word's length; the first of several. Empty if none is that near.
std::string_view nearest_name(std::string_view word, std::span<const std::string_view> names);

/// `; did you mean "NAME"?` or nothing.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> names);

}  // namespace tesserae::scenes
