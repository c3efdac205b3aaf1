// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tesserae {

/// Every number that is given is at most this in size (metres, seconds, kg, ...), so that squares,
/// fourth powers and their products stay far inside the range of double.
constexpr double kLargest = 1e15;
/// Every size that must be positive (radius, side, frame rate) is at least this.
constexpr double kSmallest = 1e-15;
/// Masses [kg] whose inertia and inverse inertia stay inside the range of double for all sizes.
constexpr double kLeastMass = 1e-60, kLargestMass = 1e60;

}  // namespace tesserae
