#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/step/schedule.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// What bodies weigh that have just come to stand on others: where nothing that carries a body has
/// a warm start, its contacts start from what they share of its weight and of all that stands on
/// it, not from 0. Sweeps hand a load on from body to body and need the more of them the higher a
/// tower is; what they lack in the first steps of a scene shakes it, and small towers fall.
///
/// That is where sweeps start, not where they end. Only bodies have such a load that stand on what
/// contacts do not move, or on others that have one.
class FirstLoads {
  public:
    /// Changes step.impulses, after the warm start.
    void guess(const Simulation& simulation, StepData& step, Schedule& schedule);

  private:
    /// A run of contacts by which an upper body stands on a lower one.
    struct Support {
        double height;  ///< of the upper body [m]
        BodyId upper, lower;
        std::uint32_t run;
        double part;  ///< of each impulse along the normal that is upward
    };

    /// What weighs on a body.
    struct Load {
        double impulse = 0;  ///< downward [N s]
        PackedVec4 moment =
            PackedVec4::Zero();  ///< of it times where it acts, from the body's centre [N m s]
    };
    /// A point that carries a body.
    struct Place {
        const Support* support;
        std::size_t contact;
        Vec4 from_centre;  ///< across the direction of gravity, from the body's [m]
    };

    void number_loads(const Simulation& simulation);
    void list_places(const Simulation& simulation, const StepData& step, const Support* begin,
                     const Support* end);
    bool look(const Simulation& simulation, const StepData& step, Schedule& schedule);
    void list_supports(const Simulation& simulation, const StepData& step);
    void share_out(const Simulation& simulation, StepData& step);

    std::vector<std::uint8_t> known_;  ///< of every body: see first_loads.cpp
    std::vector<Support> supports_;    ///< of those that have a first load, the lowest first
    std::vector<std::uint32_t> load_;  ///< of every body: which of above_ is its
    std::vector<Load> above_;          ///< what stands on these, and at last on any others
    std::vector<Place> places_;        ///< of the points that carry a body
};

}  // namespace tesserae
