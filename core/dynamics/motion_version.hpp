// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tesserae {

/// The version of the law by which bodies move. Raise it in the commit that changes the bits of any
/// motion, of which not every one is among the golden ones (tests/scenes/golden_test.cpp): a
/// trajectory says by which version it was made and is continued by that one only.
constexpr int kMotionVersion = 44;

}  // namespace tesserae
