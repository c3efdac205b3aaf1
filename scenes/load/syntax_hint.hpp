// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tesserae::scenes {

/// What a syntax error of TOML most likely comes from: "; the string has no closing quote". Empty
/// where that cannot be told.
/// @param what            the parser's own words
/// @param line, column    where it stopped in the text, from 1 on
std::string syntax_hint(std::string_view what, std::size_t line, std::size_t column,
                        std::string_view text);

}  // namespace tesserae::scenes
