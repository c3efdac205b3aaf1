#pragma once

#include "core/dynamics/step/step_data.hpp"
#include "core/error.hpp"

namespace tesserae {

/// A body's position, velocity or angular velocity has grown so large that its square overflows,
/// or is no number. The lowest such body is named; the bodies are still as after the last step.
struct LeftFiniteRange : RunError {
    LeftFiniteRange(BodyId body, double time);
    BodyId body;
    double time;  ///< of the step's end [s]
};

/// Checks the bodies and works out what every step needs.
/// @throws InputError   a pair of shapes that can meet has no contacts yet; arrays of different
///                      lengths; 2^32 bodies or more
Simulation make_simulation(Bodies bodies, const PhysicsSettings& settings);

/// Sizes the step's arrays of bodies.
/// @throws InputError   dt is not finite or not > 0
void begin_step(const Simulation& simulation, StepData& step, double dt);

/// Whether the motion of all bodies in the range is.
bool is_finite(const Simulation& simulation, const StepData& step, Range bodies);

/// @throws LeftFiniteRange   naming the lowest body whose motion is not finite
void require_finite(const Simulation& simulation, const StepData& step);

/// The impulses that the sub-step leaves to the next, or the step if it is its last, are those of
/// step.impulses that are > 0, ascending, and of bodies that sleep the last ones.
struct LeftImpulses {
    KeptImpulses& impulses;
    std::vector<Bivector>& angular;  ///< where there is rolling friction
};
LeftImpulses left_impulses(Simulation& simulation, StepData& step);

/// How many of step.impulses in the range are > 0, and how many runs of contacts have any there.
KeptImpulses::Size count_pushing(const StepData& step, Range contacts);
/// Writes these to the places from `first` on.
void keep_pushing(const Simulation& simulation, const StepData& step, Range contacts,
                  KeptImpulses::Size first, const LeftImpulses& left);
/// All of them, beside those of bodies that sleep: where sleeping is on.
void merge_impulses(const Simulation& simulation, StepData& step, const LeftImpulses& left);

/// Contacts that are added up one after the other; the sums of pieces are then added in their
/// order, so that the report has the same bits for any number of threads.
constexpr std::size_t kReportPiece = 1024;

/// Sizes step.sums.
void begin_report(StepData& step);
/// @param contacts   begins with a piece
void sum_contacts(StepData& step, Range contacts);

/// Makes the step's result the present state, and what the next one needs of it the memory. Needs
/// step.sums and the memory's impulses.
StepReport commit_step(Simulation& simulation, StepData& step);

}  // namespace tesserae
