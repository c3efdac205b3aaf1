// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace tesserae {

/// What a step found in the middle of its last sub-step. Contacts of sleeping bodies count as they
/// were when the bodies fell asleep, but their overlap does not.
struct StepReport {
    std::uint64_t contacts = 0;   ///< contact points that touch or overlap
    double penetration = 0;       ///< deepest overlap [m], >= 0
    double mean_penetration = 0;  ///< mean overlap of these points [m], >= 0
    double residual = 0;  ///< largest change of a contact's normal velocity that the solver still
                          ///< made in its last iteration [m/s]
    std::uint64_t asleep = 0;  ///< number of bodies asleep
    /// The most sweeps that a solve of the contacts and joints of a group of touching bodies took:
    /// of an impact, a load or a position correction; at most PhysicsSettings::iterations.
    std::uint64_t sweeps = 0;
};

}  // namespace tesserae
