// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/solver/constraint_rows.hpp"
#include "core/dynamics/solver/kernels/kernels.hpp"

// A group of coloured islands as the passes of the solver see it: bodies and colours.
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
/// @param mass_unit   of their island [kg]
void begin_changes(const ColouredStage& stage, Range bodies, double mass_unit);
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
/// Ends the sweeps of a position correction: takes what they have changed out of the bodies'
/// changes.
void end_correction(const ColouredStage& stage, Range bodies);
/// Moves the bodies by it, see displace().
void apply_correction(const ColouredStage& stage, Range bodies);

/// A group of coloured islands and its colours.
class ColouredGroup {
  public:
    /// @param island   the first of the group
    ColouredGroup(const Simulation& simulation, StepData& step, std::size_t island)
        : all_(step.coloured),
          first_(step.islands.coloured[island]),
          group_(all_.group[first_]),
          stage_{simulation, step, first_, all_.shares_batches[group_] != 0} {}

    /// Sets the cause that the next passes solve. Rows that an impact has made stay for the load.
    void begin(Cause cause) {
        stage_.cause = cause;
        stage_.made = stage_.step.has_rows[island(0)] != 0;
        for (const int member : members())
            stage_.parting[member] = parting_of(stage_.step, island(member));
    }

    const ColouredStage& stage() const { return stage_; }
    Members members() const {
        return Members::first(
            static_cast<int>(all_.first_member[group_ + 1] - all_.first_member[group_]));
    }
    /// Returns the number of an island among all.
    std::size_t island(int member) const { return all_.islands[place(member)]; }
    double mass_unit(int member) const { return all_.mass_unit[place(member)]; }
    Range bodies(int member) const {
        return {all_.first_body[place(member)], all_.first_body[place(member) + 1]};
    }
    /// The sums of the pieces of kSumPiece bodies of an island.
    std::span<BodySums> body_sums(int member) const {
        const auto [begin, end] = bodies(member);
        BodySums* const first = all_.body_sums.data() + begin / kSumPiece + place(member);
        return {first, (end - begin + kSumPiece - 1) / kSumPiece};
    }

    /// Calls visit(batches of a colour, threads, lanes) for every colour in its turn. The last
    /// colour holds the pairs that are left over and share bodies: it gets one thread and one lane.
    template <class Threads, class Visit>
    void for_colours(const Threads& threads, LaneCount lanes, bool backward,
                     const Visit& visit) const {
        const std::uint32_t first = all_.first_colour[group_];
        const std::uint32_t count = all_.first_colour[group_ + 1] - first;
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
    std::size_t place(int member) const { return first_ + static_cast<std::size_t>(member); }

    ColouredIslands& all_;
    std::uint32_t first_;  ///< place of the first island among the coloured ones
    std::uint32_t group_;
    ColouredStage stage_;
};

/// Returns the constraints of a coloured island that are no contacts, or some of them. An island
/// that has any is a group by itself.
/// @param some   in ColouredIslands::others
inline ConstraintRows<MotionOfChanges> others_of(const ColouredStage& stage, BatchRange some) {
    const std::vector<std::uint32_t>& others = stage.step.coloured.others;
    return {stage.simulation, stage.step,
            std::span(others).subspan(some.begin, some.end - some.begin)};
}

/// Calls round(batches), general(batches) and others(constraints) for pieces of all batches and
/// constraints.
template <class Threads, class Round, class General, class Others>
void for_all_rows(const ColouredGroup& group, const Threads& threads, const Round& round,
                  const General& general, const Others& others) {
    group.for_colours(threads, LaneCount::kOne, false,
                      [&](const ColourBatches& batches, const auto& at_work, LaneCount) {
                          at_work.for_batches(batches.round, 1, round);
                          at_work.for_batches(batches.general, kManifoldPoints, general);
                          at_work.for_batches(batches.others, kManifoldPoints, others);
                      });
}

/// Multiplies the loads of some islands, and what they have changed, by a part each.
template <class Threads>
void leave_part_of_load(const ColouredGroup& group, const Threads& threads,
                        const PerMember<double>& parts, Members some) {
    const ColouredStage& stage = group.stage();
    PerMember<float> left;
    left.fill(1);
    for (const int member : some) left[member] = static_cast<float>(parts[member]);
    for_all_rows(
        group, threads, [&](BatchRange batches) { leave_part_of_round(stage, batches, left); },
        [&](BatchRange batches) { leave_part_of_general(stage, batches, left); },
        [&](BatchRange others) { others_of(stage, others).leave_part(left[0]); });
    for (const int member : some)
        threads.for_bodies(group.bodies(member), [&](Range bodies) {
            leave_part_of_changes(stage, bodies, left[member]);
        });
}

/// Calls add(member, item of list, lane) for the lanes of all batches. The list has an item for
/// every batch.
template <class Item, class Add>
void for_lanes_of_members(const std::vector<Batch>& all, BatchRange batches,
                          const std::vector<Item>& list, const Add& add) {
    for (std::uint32_t i = batches.begin; i < batches.end; ++i)
        for (std::size_t k = 0; k < kLanes && all[i].points[k] > 0; ++k)
            add(all[i].member[k], list[i], k);
}

}  // namespace tesserae
