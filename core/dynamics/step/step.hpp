// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/step/step_data.hpp"
#include "core/error.hpp"

namespace tesserae {

/// The error that a body's position, velocity or angular velocity is not a number or is so large
/// that its square overflows. It names the lowest such body. The bodies are still as after the last
/// step.
struct LeftFiniteRange : RunError {
    LeftFiniteRange(BodyId body, double time);
    BodyId body;
    double time;  ///< of the step's end [s]
};

/// Checks the bodies and computes what every step needs.
/// @param turned        bodies that something besides contacts and joints may turn
/// @throws InputError   a pair of shapes that can meet has no contacts yet; arrays of different
///                      lengths; 2^32 bodies or more; see make_joints()
Simulation make_simulation(Bodies bodies, const PhysicsSettings& settings,
                           std::vector<Joint> joints = {}, std::span<const BodyId> turned = {});

/// Sizes the step's arrays of bodies.
/// @throws InputError   dt is not finite or not > 0
void begin_step(const Simulation& simulation, StepData& step, double dt);

/// Returns whether the motion of all bodies in the range is finite.
bool is_finite(const Simulation& simulation, const StepData& step, Range bodies);

/// Checks that the motion of all bodies is finite.
/// @throws LeftFiniteRange   naming the lowest body whose motion is not finite
void require_finite(const Simulation& simulation, const StepData& step);

/// The lists of impulses that a sub-step leaves to the next sub-step, or to the next step if it is
/// the last. They are those of step.impulses that are > 0, ascending, and for sleeping bodies the
/// last ones.
struct LeftImpulses {
    KeptImpulses& impulses;
    std::vector<Bivector>& angular;  ///< where there is rolling friction
};
/// Returns the lists to which this sub-step writes.
LeftImpulses left_impulses(Simulation& simulation, StepData& step);

/// Returns the number of step.impulses in the range that are > 0, and that of the runs of contacts
/// that have any there.
KeptImpulses::Size count_pushing(const StepData& step, Range contacts);
/// Writes the impulses that are > 0 in the range to the places from `first` on.
void keep_pushing(const Simulation& simulation, const StepData& step, Range contacts,
                  KeptImpulses::Size first, const LeftImpulses& left);
/// Merges all impulses that are > 0 with those of sleeping bodies, where sleeping is on.
void merge_impulses(const Simulation& simulation, StepData& step, const LeftImpulses& left);

/// The number of contacts that are added up as one piece. The sums of pieces are added in their
/// order, so that the report has the same bits for any number of threads.
constexpr std::size_t kReportPiece = 1024;

/// Sizes step.sums.
void begin_report(StepData& step);
/// Adds up the contacts in the range for the report.
/// @param contacts   the range begins with a piece
void sum_contacts(StepData& step, Range contacts);

/// Makes the step's result the present state, and moves what the next step needs to the memory.
/// Needs step.sums and the memory's impulses.
StepReport commit_step(Simulation& simulation, StepData& step);

}  // namespace tesserae
