// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/dynamics/constraints/contact_targets.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Takes back the energy and the angular momentum that joints would add to the bodies that they
/// connect, in a load or an impact.
///
/// What holds does no work. But where light links whip round faster than the step can follow, the
/// joints do some. Then the bodies' motion is scaled down by as much: relative to what is fixed and
/// holds them, so that the joints keep them; if nothing does, relative to their motion as one rigid
/// body, so that momentum and angular momentum stay.
class JointGain {
  public:
    /// Starts before a load or an impact.
    /// @param bodies   those of the joints that can move, ascending, with all that joints connect
    ///                 with them; before a load gravity has acted on them already
    void begin(const Simulation& simulation, const StepData& step, std::span<const BodyId> bodies,
               Cause cause);
    /// Counts motion that the joints give a body beside that by their impulses, by moments that
    /// have no counterpart.
    /// @param place   among the bodies
    void add(std::size_t place, const BodyMotion& motion);
    /// Takes back the angular momentum of what add() has counted, where nothing fixed holds the
    /// bodies: they turn back as one rigid body, which joints allow.
    /// @param constraints   numbers in step.constraints
    void give_momentum_back(const Simulation& simulation, StepData& step,
                            std::span<const std::uint32_t> constraints);
    /// Takes back the energy that the joints have added by their present impulses.
    void give_energy_back(const Simulation& simulation, StepData& step,
                          std::span<const std::uint32_t> constraints) const;

  private:
    /// Motion as of one rigid body.
    struct Frame;
    /// A body, its motion before the load, what gravity has added, and what add() counts.
    struct Moved {
        BodyId group, body;
        BodyMotion before, by_gravity, given;
    };

    BodyMotion mean_of(const StepData& step, BodyId id) const;
    double gain_of(const Simulation& simulation, const StepData& step,
                   std::span<const std::uint32_t> constraints, BodyId group,
                   const Frame& frame) const;
    std::optional<Frame> frame_of_holder(const Simulation& simulation, const StepData& step,
                                         std::span<const std::uint32_t> constraints,
                                         BodyId group) const;
    template <class MotionOf>
    Frame frame_of(const Simulation& simulation, const StepData& step, BodyId group,
                   const MotionOf& motion_of) const;
    void turn_back(const Simulation& simulation, StepData& step, BodyId group);
    void slow_down(const Simulation& simulation, StepData& step, BodyId group, const Frame& frame,
                   double gain) const;
    template <class Visit>
    void for_all_in(BodyId group, const Visit& visit) const;

    bool has_given_ = false;      ///< add() was called
    std::vector<Moved> moved_;    ///< ascending by body
    std::vector<BodyId> groups_;  ///< of them, ascending: see Joints::group
};

}  // namespace tesserae
