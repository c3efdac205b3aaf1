// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/step/schedule.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Guesses the loads of bodies that have just come to stand on others. If nothing that carries a
/// body has a warm start, its contacts start from their share of the weight of the body and of all
/// that stands on it, not from 0. Sweeps hand a load on from body to body and need more iterations
/// the higher a tower is; if they lack some in the first steps of a scene, the tower shakes, and
/// small ones fall.
///
/// The guess is where sweeps start, not where they end. Only bodies have one that stand on bodies
/// that contacts do not move, or on others that have one.
class FirstLoads {
  public:
    /// Adds the guesses to step.impulses, after find_warm_starts().
    void guess(const Simulation& simulation, StepData& step, Schedule& schedule);

  private:
    /// A run of contacts by which an upper body stands on a lower one.
    struct Support {
        double height;  ///< of the upper body [m]
        BodyId upper, lower;
        std::uint32_t run;
        double part;  ///< upward part of an impulse along the normal
    };

    /// The load on a body.
    struct Load {
        double impulse = 0;  ///< downward [N s]
        PackedVec4 moment =
            PackedVec4::Zero();  ///< impulse times place, from the body's centre [N m s]
    };
    /// A point that carries a body.
    struct Place {
        const Support* support;
        std::size_t contact;
        Vec4 from_centre;  ///< across gravity, from the body's centre [m]
    };

    void number_loads(const Simulation& simulation);
    void list_places(const Simulation& simulation, const StepData& step, const Support* begin,
                     const Support* end);
    bool look(const Simulation& simulation, const StepData& step, Schedule& schedule);
    void list_supports(const Simulation& simulation, const StepData& step);
    void share_out(const Simulation& simulation, StepData& step);

    std::vector<std::uint8_t> known_;  ///< one for each body: see first_loads.cpp
    std::vector<Support> supports_;    ///< of bodies that have a first load, the lowest first
    std::vector<std::uint32_t> load_;  ///< each body's place in above_
    std::vector<Load> above_;    ///< the load on each of these, and at last that on all others
    std::vector<Place> places_;  ///< the points that carry one body
};

}  // namespace tesserae
