#pragma once

namespace tesserae {

/// a && b and a || b without a branch, where nobody can predict a and both are cheap and safe to
/// evaluate.
inline bool both(bool a, bool b) { return (static_cast<int>(a) & static_cast<int>(b)) != 0; }
inline bool either(bool a, bool b) { return (static_cast<int>(a) | static_cast<int>(b)) != 0; }

}  // namespace tesserae
