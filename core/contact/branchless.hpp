// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tesserae {

/// Returns a && b without a branch; either() returns a || b. They are for an a that nobody can
/// predict, where both arguments are cheap and safe to evaluate.
inline bool both(bool a, bool b) { return (static_cast<int>(a) & static_cast<int>(b)) != 0; }
inline bool either(bool a, bool b) { return (static_cast<int>(a) | static_cast<int>(b)) != 0; }

}  // namespace tesserae
