// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/syntax_hint.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tesserae::scenes {

std::string syntax_hint(std::string_view what, std::size_t line, std::size_t column,
                        std::string_view text) {
    const auto says = [&](std::string_view part) { return what.find(part) != what.npos; };
    // The line that the parser stopped in, to see whether it stopped at its end.
    for (; line > 1 && !text.empty(); --line)
        text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    const auto length = std::min(text.find_first_of("\r\n"), text.size());
    const bool at_end = column > length;
    if (says("string") && (says("end-of-file") || (says("control characters") && at_end)))
        return "; the string has no closing quote";
    if (says("could not determine value type"))
        return "; expected a number, true or false, a \"string\" in quotes, an [array] or a "
               "{ key = table }";
    if (!says("cannot redefine existing table")) return {};
    for (const char* table : {"body", "lattice", "joint", "material", "light"})
        if (says(fmt::format("'{}'", table)))
            return fmt::format("; there may be several [[{}]], each with two brackets", table);
    return "; expected one table of this name, with all its keys";
}

}  // namespace tesserae::scenes
