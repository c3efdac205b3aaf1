// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/solver/constraint_rows.hpp"
#include "core/dynamics/solver/kernels/kernels.hpp"

// A coloured island as the passes of the solver see it: its bodies and colours.
namespace tesserae {

/// Does the parts of a pass one after the other. In parallel/ there is a class with the same
/// functions that uses all threads.
struct OneThread {
    /// Calls work(Range) for pieces of the bodies.
    template <class Work>
    void for_bodies(Range bodies, const Work& work) const {
        work(bodies);
    }
    /// Calls work(BatchRange) for pieces of the batches.
    /// @param points   about how many points a batch has
    template <class Work>
    void for_batches(BatchRange batches, std::size_t /*points*/, const Work& work) const {
        if (batches.begin < batches.end) work(batches);
    }
    /// Calls work(BatchRange) for pieces of the batches and returns the largest result, at least 0.
    template <class Work>
    double largest(BatchRange batches, std::size_t /*points*/, const Work& work) const {
        return batches.begin < batches.end ? work(batches) : 0;
    }
};

/// Calls work(place, Range) for the pieces of kSumPiece bodies in a range. The pieces are the same
/// for any number of threads.
template <class Threads, class Work>
void for_pieces(const Threads& threads, Range all, const Work& work) {
    threads.for_bodies(all, [&](Range some) {
        for (std::size_t i = some.begin; i < some.end; i += kSumPiece)
            work((i - all.begin) / kSumPiece, Range{i, std::min(i + kSumPiece, some.end)});
    });
}
/// Returns the results of work(Range) for the pieces of a range, in their order.
template <class Threads, class Work>
auto results_of_pieces(const Threads& threads, Range all, const Work& work) {
    std::vector<decltype(work(all))> results((all.end - all.begin + kSumPiece - 1) / kSumPiece);
    for_pieces(threads, all, [&](std::size_t place, Range piece) { results[place] = work(piece); });
    return results;
}

/// Starts the records of changes of the bodies in the range (places in ColouredIslands::bodies):
/// nothing has changed yet.
void begin_changes(const ColouredStage& stage, Range bodies);
/// Writes the bodies' step.impact_motion after the compression, whose changes are not added yet.
void keep_impact_motion(const ColouredStage& stage, Range bodies);
/// Returns twice the bodies' kinetic energy [J] before the compression and after it; its changes
/// are not added yet. See has_jammed().
std::array<double, 2> energies_of_compression(const ColouredStage& stage, Range bodies);
/// Adds the bodies' changes to their velocities.
void add_changes(const ColouredStage& stage, Range bodies);
/// Takes the warm start from the bodies' velocities again, see take_warm_start().
void take_warm_start_back(const ColouredStage& stage, Range bodies);

/// Returns twice the kinetic energy of the bodies' changes [J].
double energy_of_changes(const ColouredStage& stage, Range bodies);
/// Multiplies the bodies' changes by a part.
void leave_part_of_changes(const ColouredStage& stage, Range bodies, float part);

/// Keeps the bodies' changes by the load, before the sweeps of a position correction.
void begin_correction(const ColouredStage& stage, Range bodies);
/// Ends the sweeps of a position correction: bodies for which turns_correction() is true are not
/// turned by it.
void end_correction(const ColouredStage& stage, Range bodies);
/// Takes back the velocities of the position correction, once the bodies have moved.
void take_correction_back(const ColouredStage& stage, Range bodies);

/// One coloured island and its colours.
class ColouredIsland {
  public:
    ColouredIsland(const Simulation& simulation, StepData& step, std::size_t island)
        : all_(step.coloured),
          number_(island),
          place_(step.islands.coloured[island]),
          stage_{simulation, step, all_.mass_unit[place_]} {}

    /// Sets the cause that the next passes solve. Rows that an impact has made stay for the load.
    void begin(Cause cause) {
        stage_.cause = cause;
        stage_.parting = parting_of(stage_.step, number_);
        stage_.made = stage_.step.has_rows[number_] != 0;
    }
    void leave_friction_out() { stage_.friction = false; }

    const ColouredStage& stage() const { return stage_; }
    std::size_t number() const { return number_; }  ///< among all islands
    Range bodies() const { return {all_.first_body[place_], all_.first_body[place_ + 1]}; }
    /// The sums of the pieces of kSumPiece bodies.
    std::span<BodySums> body_sums() const {
        const auto [begin, end] = bodies();
        BodySums* const first = all_.body_sums.data() + begin / kSumPiece + place_;
        return {first, (end - begin + kSumPiece - 1) / kSumPiece};
    }

    /// Calls visit(batches of a colour, threads, lanes) for every colour in its turn. The last
    /// colour holds the pairs that are left over and share bodies: it gets one thread and one lane.
    template <class Threads, class Visit>
    void for_colours(const Threads& threads, LaneCount lanes, bool backward,
                     const Visit& visit) const {
        const std::uint32_t first = all_.first_colour[place_];
        const std::uint32_t count = all_.first_colour[place_ + 1] - first;
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t colour = backward ? count - 1 - i : i;
            const ColourBatches& batches = all_.colours[first + colour];
            if (colour + 1 < count)
                visit(batches, threads, lanes);
            else
                visit(batches, OneThread{}, LaneCount::kOne);
        }
    }

  private:
    ColouredIslands& all_;
    std::size_t number_;
    std::uint32_t place_;
    ColouredStage stage_;
};

/// Returns the constraints of a coloured island that are no contacts, or some of them.
/// @param some   in ColouredIslands::others
inline ConstraintRows<MotionOfChanges> others_of(const ColouredStage& stage, BatchRange some) {
    const std::vector<std::uint32_t>& others = stage.step.coloured.others;
    return {stage.simulation, stage.step,
            std::span(others).subspan(some.begin, some.end - some.begin)};
}

/// Calls round(batches), general(batches) and others(constraints) for pieces of all batches and
/// constraints.
template <class Threads, class Round, class General, class Others>
void for_all_rows(const ColouredIsland& island, const Threads& threads, const Round& round,
                  const General& general, const Others& others) {
    island.for_colours(threads, LaneCount::kOne, false,
                       [&](const ColourBatches& batches, const auto& at_work, LaneCount) {
                           at_work.for_batches(batches.round, 1, round);
                           at_work.for_batches(batches.general, kManifoldPoints, general);
                           at_work.for_batches(batches.others, kManifoldPoints, others);
                       });
}

/// Multiplies a load's impulses, and what they have changed, by a part.
template <class Threads>
void leave_part_of_load(const ColouredIsland& island, const Threads& threads, double part) {
    const ColouredStage& stage = island.stage();
    const auto left = static_cast<float>(part);
    for_all_rows(
        island, threads, [&](BatchRange some) { leave_part_of_round(stage, some, left); },
        [&](BatchRange some) { leave_part_of_general(stage, some, left); },
        [&](BatchRange some) { others_of(stage, some).leave_part(left); });
    threads.for_bodies(island.bodies(),
                       [&](Range bodies) { leave_part_of_changes(stage, bodies, left); });
}

}  // namespace tesserae
