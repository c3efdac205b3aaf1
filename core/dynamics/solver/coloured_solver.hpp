#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/dynamics/solver/blow.hpp"
#include "core/dynamics/solver/coloured_kernels.hpp"
#include "core/dynamics/solver/conjugate.hpp"

namespace tesserae {

// Coloured islands are solved in float, eight contacts at a time: velocities as changes since the
// sub-step's start, which are added to the state at the end, and targets less what the start has,
// worked out in double. So neither a body's place nor its speed costs accuracy. The points of a
// pair are one item of a colour: its bodies are read and written once for all of them.
//
// The colours are the same for any number of threads, and so are the bits.

/// Does the parts of a pass one after the other; parallel/ has one that uses all threads.
struct OneThread {
    /// Calls work(Range) for pieces of the bodies.
    template <class Work>
    void for_bodies(Range bodies, const Work& work) const {
        work(bodies);
    }
    /// Calls work(BatchRange) for pieces of the batches.
    /// @param points   of a batch, about
    template <class Work>
    void for_batches(BatchRange batches, std::size_t /*points*/, const Work& work) const {
        if (batches.begin < batches.end) work(batches);
    }
    /// The same with results, of which it returns the largest, at least 0.
    template <class Work>
    double largest(BatchRange batches, std::size_t /*points*/, const Work& work) const {
        return batches.begin < batches.end ? work(batches) : 0;
    }
};

/// The records of the bodies in the range (places in ColouredIslands::bodies), unchanged yet.
void begin_changes(const ColouredStage& stage, Range bodies);
/// step.blow_motion of the bodies: with the changes of the compression, not added yet.
void keep_blow_motion(const ColouredStage& stage, Range bodies);
/// Whether friction has in the compression, whose changes are not added yet; see can_jam().
bool has_jammed(const ColouredStage& stage, Range bodies);
/// Adds the changes to the velocities.
void add_changes(const ColouredStage& stage, Range bodies);
/// What take_recalled() took.
void add_recalled(const ColouredStage& stage, Range bodies);
/// Takes them back after the bodies have moved. Those that turn unevenly have changed their angular
/// velocity, as if by an impulse.
void take_changes_back(const ColouredStage& stage, Range bodies);

/// Keeps the changes of the load, and takes back what the push then changed.
void begin_push(const ColouredStage& stage, Range bodies);
void take_push_back(const ColouredStage& stage, Range bodies);

/// One coloured island and its colours.
class ColouredIsland {
  public:
    ColouredIsland(const Simulation& simulation, StepData& step, std::size_t island, Cause cause,
                   bool friction = true)
        : all_(step.coloured),
          place_(step.islands.coloured[island]),
          stage_{simulation, step,     all_.mass_unit[place_],
                 cause,      friction, step.has_rows[island] != 0} {}

    const ColouredStage& stage() const { return stage_; }
    Range bodies() const { return {all_.first_body[place_], all_.first_body[place_ + 1]}; }

    /// Calls visit(batches of a colour, threads, lanes) for every colour in its turn. The last one
    /// holds what is left over, which shares bodies: one thread and one lane.
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
    const ColouredIslands& all_;
    std::uint32_t place_;
    ColouredStage stage_;
};

/// Calls round(stage, batches) and general(stage, batches) for pieces of all batches.
template <class Threads, class Round, class General>
void for_all_rows(const ColouredIsland& island, const Threads& threads, const Round& round,
                  const General& general) {
    island.for_colours(threads, LaneCount::kOne, false,
                       [&](const ColourBatches& batches, const auto& at_work, LaneCount) {
                           at_work.for_batches(batches.round, 1, round);
                           at_work.for_batches(batches.general, kManifoldPoints, general);
                       });
}

/// Pairs of sweeps along conjugate directions, see conjugate.hpp.
template <class Threads>
class ConjugateDirections {
  public:
    ConjugateDirections(const ColouredIsland& island, const Threads& threads)
        : island_(island), threads_(threads) {
        const ColouredStage& stage = island.stage();
        for_rows([&](BatchRange some) { take_recalled_round(stage, some); },
                 [&](BatchRange some) { take_recalled_general(stage, some); });
        for_bodies([](auto... of) { take_recalled(of...); });
        for (std::size_t i = island.bodies().begin; i < island.bodies().end; ++i)
            rounding_ += kFloatStep * kFloatStep * stage.step.coloured.body_sums[i][0];
        for_bodies([](auto... of) { begin_directions(of...); });
        begin_rows();
    }
    /// After the last pair.
    void end() const {
        for_bodies([](auto... of) { add_recalled(of...); });
    }
    /// The direction after a pair of sweeps.
    /// @return the largest change of a body's velocity by a step along it [m/s]
    double find() {
        const ColouredStage& stage = island_.stage();
        for_bodies([](auto... of) { weigh_step(of...); });
        for_rows([&](BatchRange some) { weigh_round_step(stage, some); },
                 [&](BatchRange some) { weigh_general_step(stage, some); });
        Sums sums = {};  // r.z, r.p_last and the energy
        for (std::size_t i = island_.bodies().begin; i < island_.bodies().end; ++i)
            for (std::size_t k = 0; k < 3; ++k) sums[k] += stage.step.coloured.body_sums[i][k];
        rounding_ = std::max(rounding_, kFloatStep * kFloatStep * sums[2]);
        const Sums of_rows = work();
        for (std::size_t k = 0; k < 3; ++k) sums[k] += of_rows[k];
        const double ratio = last_slope_ > 0 ? sums[0] / last_slope_ : 0;
        look_for_rise(ratio, sums[2]);
        carried_ = ratio > 0 && plain_ == 0 ? static_cast<float>(ratio) : 0;
        for_bodies([this](auto... of) { find_direction(of..., carried_); });

        double twice_energy = 0, fastest = 0;
        for (std::size_t i = island_.bodies().begin; i < island_.bodies().end; ++i) {
            twice_energy += stage.step.coloured.body_sums[i][0];
            fastest = std::max(fastest, stage.step.coloured.body_sums[i][1]);
        }
        const double length = (sums[0] + carried_ * sums[1]) / twice_energy;
        holds_ = plain_ == 0 && length > 1 && sums[0] > rounding_;
        length_ = holds_ ? static_cast<float>(std::min(length, kLongestStep)) : 1;
        slope_ = sums[0];
        return length_ * std::sqrt(fastest);
    }
    /// From there on to the next pair.
    void go_on() {
        const ColouredStage& stage = island_.stage();
        last_slope_ = holds_ ? slope_ : 0;
        if (!holds_) {
            plain_ = std::max(0, plain_ - 1);
            for_bodies([](auto... of) { go_from_end(of...); });
            return begin_rows();
        }
        for_bodies([this](auto... of) { go_along(of..., length_); });
        for_rows([&](BatchRange some) { go_along_round(stage, some, carried_, length_); },
                 [&](BatchRange some) { go_along_general(stage, some, carried_, length_); });
    }

  private:
    using Sums = std::array<double, 3>;
    /// What is changed by less than this part of what is recalled, or has been changed, is
    /// rounding, of which directions would grow.
    static constexpr double kFloatStep = 1e-6;

    /// After a step along a direction that led away from the solution there are none for a while.
    /// @param ratio   of r.z to that before the step
    void look_for_rise(double ratio, double energy) {
        if (last_slope_ > 0 && !(energy <= last_energy_ && ratio <= kMostCarried)) {
            plain_ = pause_;
            pause_ = 2 * pause_;
        }
        last_energy_ = energy;
    }
    /// Calls work(stage, bodies).
    template <class Work>
    void for_bodies(const Work& work) const {
        threads_.for_bodies(island_.bodies(), [&](Range bodies) { work(island_.stage(), bodies); });
    }
    template <class Round, class General>
    void for_rows(const Round& round, const General& general) const {
        for_all_rows(island_, threads_, round, general);
    }
    void begin_rows() const {
        const ColouredStage& stage = island_.stage();
        for_rows([&](BatchRange some) { begin_round_directions(stage, some); },
                 [&](BatchRange some) { begin_general_directions(stage, some); });
    }
    /// Sums of round_work and general_work, in the order of the batches for any number of threads.
    Sums work() const {
        const ColouredIslands& coloured = island_.stage().step.coloured;
        Sums sums = {};
        const auto add = [&](const auto& list, BatchRange batches) {
            for (std::uint32_t i = batches.begin; i < batches.end; ++i)
                for (std::size_t k = 0; k < 3; ++k)
                    for (const float x : list[i][k].lane) sums[k] += x;
        };
        island_.for_colours(OneThread{}, LaneCount::kOne, false,
                            [&](const ColourBatches& batches, const auto&, LaneCount) {
                                add(coloured.round_work, batches.round);
                                add(coloured.general_work, batches.general);
                            });
        return sums;
    }

    const ColouredIsland& island_;
    const Threads& threads_;
    double slope_ = 0, last_slope_ = 0;  ///< r.z
    double last_energy_ = 0;             ///< at the end of the last pair
    double rounding_ = 0;                ///< of a slope
    int plain_ = 0, pause_ = 1;  ///< pairs without a direction, now and the next time
    float carried_ = 0, length_ = 1;
    bool holds_ = false;  ///< the direction
};

/// One iteration.
/// @return its residual [m/s]
template <class Threads>
double sweep_coloured(const ColouredIsland& island, Sweep sweep, const Threads& threads,
                      LaneCount lanes) {
    const ColouredStage& stage = island.stage();
    double residual = 0;
    island.for_colours(threads, lanes, sweep.backward,
                       [&](const ColourBatches& batches, const auto& at_work, LaneCount at_once) {
                           const auto round = [&](BatchRange piece) {
                               return sweep_round(stage, piece, sweep, at_once);
                           };
                           const auto general = [&](BatchRange piece) {
                               return sweep_general(stage, piece, sweep, at_once);
                           };
                           double of_round = 0;
                           if (!sweep.backward) of_round = at_work.largest(batches.round, 1, round);
                           residual = std::max(residual, at_work.largest(batches.general,
                                                                         kManifoldPoints, general));
                           if (sweep.backward) of_round = at_work.largest(batches.round, 1, round);
                           residual = std::max(residual, of_round);
                       });
    return residual;
}

/// @return the residual of the last iteration [m/s]
template <class Threads>
double iterate_coloured(const ColouredIsland& island, Pass pass, const Effort& effort,
                        const Threads& threads, LaneCount lanes) {
    return iterate(pass, effort,
                   [&](Sweep sweep) { return sweep_coloured(island, sweep, threads, lanes); });
}

/// A load by conjugate directions. It ends once neither a row's velocity nor, by the next step, a
/// body's changes by more than the tolerance: what all of a wall does together no row sees.
/// @return the residual of the last iteration [m/s]
template <class Threads>
double iterate_along_conjugates(const ColouredIsland& island, const Effort& effort,
                                const Threads& threads, LaneCount lanes) {
    std::optional<ConjugateDirections<Threads>> directions;
    double residual = 0;
    for (int i = 0; i < effort.sweeps; ++i) {
        Sweep sweep = sweep_of(Pass::kSolve, effort, i);
        sweep.adjoint = sweep.backward;
        if (sweep.backward && directions) directions->go_on();
        if (sweep.backward && !directions) directions.emplace(island, threads);
        residual = sweep_coloured(island, sweep, threads, lanes);
        if (sweep.backward || !directions || i + 1 == effort.sweeps) continue;
        const double left = std::max(residual, directions->find());
        if (i + 1 >= kLeastSweeps && left <= effort.enough) break;
    }
    if (directions) directions->end();
    return residual;
}

/// The rows of all contacts, and the impulses that they start from.
template <class Threads>
void start_coloured(const ColouredIsland& island, const Threads& threads, LaneCount lanes) {
    const ColouredStage& stage = island.stage();
    threads.for_bodies(island.bodies(), [&](Range bodies) { begin_changes(stage, bodies); });
    island.for_colours(
        threads, lanes, false,
        [&](const ColourBatches& batches, const auto& at_work, LaneCount at_once) {
            at_work.for_batches(batches.round, 1,
                                [&](BatchRange piece) { start_round(stage, piece, at_once); });
            at_work.for_batches(batches.general, kManifoldPoints,
                                [&](BatchRange piece) { start_general(stage, piece, at_once); });
        });
}

/// What keep_round() and keep_general() keep of all contacts.
template <class Threads>
void keep_coloured(const ColouredIsland& island, const Threads& threads) {
    const ColouredStage& stage = island.stage();
    island.for_colours(threads, LaneCount::kOne, false,
                       [&](const ColourBatches& batches, const auto& at_work, LaneCount) {
                           at_work.for_batches(batches.round, 1,
                                               [&](BatchRange piece) { keep_round(stage, piece); });
                           at_work.for_batches(
                               batches.general, kManifoldPoints,
                               [&](BatchRange piece) { keep_general(stage, piece); });
                       });
}

/// The first part of a blow.
template <class Threads>
void compress_coloured(const ColouredIsland& island, const Effort& effort, const Threads& threads,
                       LaneCount lanes) {
    start_coloured(island, threads, lanes);
    iterate_coloured(island, Pass::kSolve, effort, threads, lanes);
}

/// solve_blow() of a coloured island.
template <class Threads>
void solve_coloured_blow(const Simulation& simulation, StepData& step, std::size_t island,
                         const Threads& threads, LaneCount lanes = LaneCount::kEight) {
    const Blow blow = blow_of_island(simulation, step, island);
    if (blow.fastest == 0) return;
    const ColouredIsland coloured(simulation, step, island, Cause::kBlow);
    const ColouredStage& stage = coloured.stage();
    const Effort effort = effort_of_large_blow(simulation, blow.fastest);
    const Range range = coloured.bodies();
    compress_coloured(coloured, effort, threads, lanes);
    step.has_rows[island] = 1;
    if (can_jam(simulation, blow) && has_jammed(stage, range))
        compress_coloured(ColouredIsland(simulation, step, island, Cause::kBlow, false), effort,
                          threads, lanes);
    const auto add = [&](Range some) { add_changes(stage, some); };
    if (blow.returned == 0) {
        threads.for_bodies(range, add);
        return keep_coloured(coloured, threads);
    }
    const std::span<const BodyId> bodies(&step.coloured.bodies[range.begin],
                                         range.end - range.begin);
    threads.for_bodies(range, [&](Range some) { keep_blow_motion(stage, some); });
    iterate_coloured(coloured, Pass::kRelax, effort, threads, lanes);
    threads.for_bodies(range, add);
    limit_restitution(simulation, step, bodies, blow);
    keep_coloured(coloured, threads);
}

/// solve_island() of a coloured island.
template <class Threads>
void solve_coloured_island(const Simulation& simulation, StepData& step, std::size_t island,
                           const Threads& threads, LaneCount lanes = LaneCount::kEight) {
    step.pushed[island] = is_pushed(simulation, step, island);
    const ColouredIsland coloured(simulation, step, island, Cause::kLoad);
    const ColouredStage& stage = coloured.stage();
    start_coloured(coloured, threads, lanes);
    const Effort effort = effort_of_load(simulation);
    step.residual[island] = has_conjugates(simulation)
                                ? iterate_along_conjugates(coloured, effort, threads, lanes)
                                : iterate_coloured(coloured, Pass::kSolve, effort, threads, lanes);
    if (simulation.settings.solver == Solver::kImpulse) keep_coloured(coloured, threads);
    if (step.pushed[island]) {
        threads.for_bodies(coloured.bodies(), [&](Range bodies) { begin_push(stage, bodies); });
        iterate_coloured(coloured, Pass::kRelax, effort_of_push(simulation), threads, lanes);
    }
    threads.for_bodies(coloured.bodies(), [&](Range bodies) { add_changes(stage, bodies); });
}

/// relax_island() of a coloured island.
template <class Threads>
void relax_coloured_island(const Simulation& simulation, StepData& step, std::size_t island,
                           const Threads& threads, LaneCount lanes = LaneCount::kEight) {
    const ColouredIsland coloured(simulation, step, island, Cause::kLoad);
    const ColouredStage& stage = coloured.stage();
    if (simulation.settings.solver == Solver::kSoft) {
        coloured.for_colours(threads, LaneCount::kOne, false,
                             [&](const ColourBatches& batches, const auto& at_work, LaneCount) {
                                 at_work.for_batches(batches.general, kManifoldPoints,
                                                     [&](BatchRange piece) {
                                                         leave_whirling_general(stage, piece);
                                                     });
                             });
        threads.for_bodies(coloured.bodies(),
                           [&](Range bodies) { take_changes_back(stage, bodies); });
        step.residual[island] =
            iterate_coloured(coloured, Pass::kRelax, effort_of_load(simulation), threads, lanes);
        threads.for_bodies(coloured.bodies(), [&](Range bodies) { add_changes(stage, bodies); });
        keep_coloured(coloured, threads);
    }
    if (step.pushed[island])
        threads.for_bodies(coloured.bodies(), [&](Range bodies) { take_push_back(stage, bodies); });
}

}  // namespace tesserae
