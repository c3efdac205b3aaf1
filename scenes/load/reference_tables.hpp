// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

// What the reference of scene files says, before it is made text.
namespace tesserae::scenes {

/// A key, as the reference explains it.
struct ReferenceRow {
    std::string key, type, unit, otherwise, allowed, meaning;
};
/// Keys of a table that hold together: all of them, or those of one shape or type.
struct ReferencePart {
    std::string heading;  ///< empty: the table's own
    std::vector<ReferenceRow> rows;
};
struct ReferenceTable {
    std::string name, header, about;
    std::vector<ReferencePart> parts;
};

/// Returns all tables that a scene file can have, with all keys that are read.
std::vector<ReferenceTable> all_reference_tables();

}  // namespace tesserae::scenes
