#pragma once

#include "core/dynamics/state/step_data.hpp"
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

/// Appends those of step.impulses in the range that are > 0.
void list_pushing(const StepData& step, Range contacts, std::vector<ContactImpulse>& list);
/// The same of step.angular_impulses.
void list_pushing_angular(const StepData& step, Range contacts, std::vector<Bivector>& list);

/// Keeps step.pushing for the next sub-step, beside the impulses of bodies that sleep.
void end_substep(const Simulation& simulation, StepData& step);

/// Contacts that are added up one after the other; the sums of pieces are then added in their
/// order, so that the report has the same bits for any number of threads.
constexpr std::size_t kReportPiece = 1024;

/// Sizes step.sums.
void begin_report(StepData& step);
/// @param contacts   begins with a piece
void sum_contacts(StepData& step, Range contacts);

/// Makes the step's result the present state, and what the next one needs of it the memory. Needs
/// step.sums.
StepReport commit_step(Simulation& simulation, StepData& step);

}  // namespace tesserae
