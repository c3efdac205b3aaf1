// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/motion/fast_bodies.hpp"
#include "core/function_ref.hpp"

namespace tesserae {

/// What stopped bodies have lost of a sub-step, and how they regain it: in rounds. In each round
/// the impacts of these bodies are solved where they touch, and they go on for the time that is
/// left to them, until they are stopped again. Other bodies have moved for all of the sub-step and
/// stand still; impacts change their velocities alone. What whirls on another body hits it many
/// times in a sub-step, and would else be held where it is, at a velocity at which it does not
/// move.
///
/// Gravity has acted in the middle of the sub-step. Along the ways of rounds it only does its work.
/// Bodies with joints and bodies that touch sleeping ones do not regain what they have lost.
class LostTime {
  public:
    /// Is called when a sub-step begins.
    void begin() { left_.clear(); }
    /// Is called when bodies have been stopped in a half of it.
    void add(const Simulation& simulation, const StepData& step, const FastBodies& fast_bodies);
    bool any() const { return !left_.empty(); }
    /// Is called after the second half.
    /// @param solve_impacts   solves the impacts of step.contacts
    void regain(const Simulation& simulation, StepData& step, Schedule& schedule,
                FastBodies& fast_bodies, FunctionRef<void(StepData&)> solve_impacts);

  private:
    void swap_bodies(StepData& step);
    void find_contacts(const Simulation& simulation);
    void advance(const Simulation& simulation, Schedule& schedule);
    void end_round(const Simulation& simulation, const FastBodies& fast_bodies);

    std::vector<double> left_;       ///< of every body [s]; empty if none has lost any time
    std::vector<double> moved_;      ///< of every body: how long it has moved in the round [s]
    std::vector<Contact> contacts_;  ///< of the round
    std::vector<std::uint8_t> is_late_, is_met_;  ///< of every body: has time left; bears one
    StepData round_;
};

}  // namespace tesserae
