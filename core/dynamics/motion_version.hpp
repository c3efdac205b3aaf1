// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tesserae {

/// The version of the law by which bodies move. Raise it in the commit in which any golden motion
/// hash in tests/scenes/golden_test.cpp moves: a trajectory says by which version it was made and
/// is continued by that one only.
constexpr int kMotionVersion = 43;

}  // namespace tesserae
