// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/constraints/contact_targets.hpp"
#include "core/dynamics/solver/members.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// The kinds of passes over an island: a compression or a load; a compression without friction,
/// where friction jams; the restitution; the position correction after a load.
enum class Pass { kSolve, kFrictionless, kRestitution, kCorrection };
/// Returns whether a pass is by normal impulses alone.
constexpr bool is_by_normals(Pass pass) {
    return pass == Pass::kFrictionless || pass == Pass::kCorrection;
}
/// Returns whether a pass aims at ContactTargets::first, else at `second`.
constexpr bool aims_at_first(Pass pass) {
    return pass == Pass::kSolve || pass == Pass::kFrictionless;
}

/// How long a pass goes on: until a sweep's residual is at most `enough`, but at most `sweeps`
/// sweeps.
struct Effort {
    int sweeps = 0;
    double enough = -1;  ///< [m/s]; -1: all sweeps, and nothing is measured
    int every = 1;       ///< number of sweeps from one look at the residual to the next
    int further = 0;     ///< most sweeps, in pairs, while they go along conjugate directions
    int least = 0;       ///< fewest sweeps, unless hardly anything is left: see kLeastSweeps
    bool all = false;    ///< all sweeps are done, unless they lead away

    /// Returns whether `done` sweeps are enough, the last of which had this residual [m/s].
    bool is_done(int done, double residual) const {
        return !all && residual <= (done < least ? kHardlyAnything : 1) * enough;
    }
    /// Returns whether sweeps lead away from any solution, as where friction jams: see kLedAway.
    /// @param smallest   smallest residual so far, infinite at first [m/s]
    bool leads_away(double residual, double& smallest) const {
        if (enough < 0) return false;
        if (residual > kLedAway * smallest) return true;
        smallest = std::min(smallest, std::max(residual, enough));
        return false;
    }
};
/// How a pass has ended.
struct PassEnd {
    double residual = 0;  ///< of the last sweep [m/s]
    int sweeps = 0;       ///< that it has taken
};

/// Returns whether each solve takes all of its sweeps, which are then `iterations`.
inline bool takes_all(const PhysicsSettings& settings) { return settings.tolerance <= 0; }
/// Returns the tolerance [m/s]. Where all sweeps are taken, it only tells which of them lead away,
/// and is so large that those which come back do not count.
inline double tolerance_of(const PhysicsSettings& settings) {
    const double kWhereAllAreTaken = 1000 * PhysicsSettings{}.tolerance;
    return takes_all(settings) ? kWhereAllAreTaken : settings.tolerance;
}
/// Returns the most sweeps of a solve: `iterations` or less. More than by default give all solves
/// more, in proportion.
/// @param usual   the most of it at the default of `iterations`
inline int most_sweeps(const PhysicsSettings& settings, std::size_t usual) {
    if (takes_all(settings)) return settings.iterations;
    const auto most = static_cast<std::size_t>(settings.iterations);
    const auto by_default = static_cast<std::size_t>(PhysicsSettings{}.iterations);
    return static_cast<int>(std::min(most, usual * std::max(most, by_default) / by_default));
}
/// Returns the effort of a load. The next sub-step starts from its impulses and goes on with them.
/// An island of few contacts may take more sweeps, and one that nothing has hit in the sub-step,
/// which may be about to come to rest, goes further along conjugate directions.
inline Effort effort_of_load(const Simulation& simulation, const StepData& step,
                             std::size_t island) {
    const PhysicsSettings& settings = simulation.settings;
    int few = most_sweeps(settings, kSolveWork / step.islands.size_of(island));
    // An odd number begins with a sweep forward, before there are directions. They then start
    // nearer to the load, and fewer towers that start with gaps fall.
    if (step.islands.is_coloured(island) && !takes_all(settings)) few = (few - 1) | 1;
    const int sweeps = std::max(few, most_sweeps(settings, kManySweeps));
    const int further =
        step.was_hit[island] ? 0 : std::max(0, most_sweeps(settings, kFurtherSweeps) - sweeps);
    return {sweeps,       tolerance_of(settings), 2, sweeps + further / 2 * 2,
            kLeastSweeps, takes_all(settings)};
}
/// Returns the effort of a position correction, after the load. The next sub-step does not go on
/// with it.
inline Effort effort_of_correction(const PhysicsSettings& settings, std::size_t contacts) {
    const std::size_t usual = std::max<std::size_t>(kFewSweeps, kSolveWork / contacts);
    return {most_sweeps(settings, usual), kCorrectionTolerance * tolerance_of(settings), 2, 0, 0,
            takes_all(settings)};
}
/// Returns the effort of an impact. The next sub-step does not go on with it, and a heavy body that
/// hits light ones needs many sweeps. If nothing bounces, the load that follows takes what is left.
/// What bounces goes further along conjugate directions while they lead somewhere: no load makes up
/// for speed that bodies do not return.
/// @param part    residual at which it ends, as a part of the fastest approach
/// @param along   it goes along conjugate directions; the number of sweeps is then even, so that
///                there are directions from the first sweep on
inline Effort effort_of_impact(const PhysicsSettings& settings, std::size_t contacts,
                               const Impact& impact, double part, bool along) {
    const bool bounces = impact.returned > 0;
    const std::size_t usual =
        std::max<std::size_t>(bounces ? kManySweeps : kFewSweeps, kSolveWork / contacts);
    int sweeps = most_sweeps(settings, usual);
    if (along && sweeps > 1) sweeps -= sweeps % 2;
    const int further = along && bounces ? most_sweeps(settings, kFurtherSweeps) : 0;
    return {sweeps, part * impact.fastest, along ? 2 : 4, further, 0, takes_all(settings)};
}

/// The work and the energy of a load's impulses on an island.
struct LoadWork {
    double work = 0;    ///< impulses times the velocities before them, less their targets [J]
    double energy = 0;  ///< twice the kinetic energy of the changes by them [J]

    /// Returns whether the load gains energy; sweeps that converge only take it.
    bool is_gain() const { return work + 0.5 * energy > 0; }
    /// Returns the part of the impulses that takes the most energy; it gains none.
    double best_part() const { return std::clamp(-work / energy, 0.0, 1.0); }
};

/// One iteration of a pass. Every other sweep goes through the island backward: a load at one end
/// then reaches the other end in one iteration, and towers lean less. The last sweep of kSolve goes
/// forward and those of the other passes backward, which is best for towers listed from the ground.
/// A pass that ends early ends in the same direction, or what the other one leaves shakes resting
/// bodies.
struct Sweep {
    Pass pass;
    bool backward, measured;  ///< measured: the residual is wanted
    /// True if the parts of a pair in a coloured island are solved from the last to the first: a
    /// backward sweep is then the adjoint of a forward one, as conjugate directions need. Other
    /// sweeps end with friction, so that no contact has more of it than its normal impulse allows.
    bool adjoint = false;
};
/// Returns the sweep of a pass that has this number, from 0 on.
inline Sweep sweep_of(Pass pass, const Effort& effort, int iteration) {
    const int left = effort.sweeps - 1 - iteration;
    const bool asks = effort.enough >= 0 && left % effort.every == 0;
    return {pass, (left % 2 != 0) == aims_at_first(pass), left == 0 || asks};
}

/// A turn of the sweeps over islands that are solved side by side. All sweeps of a turn go the same
/// way; islands whose first sweep goes forward take no part in the first turn.
class Turn {
  public:
    /// @param islands   those that are not done yet
    Turn(Pass pass, const PerMember<Effort>& efforts, Members islands, int number)
        : sweep_{pass, number % 2 == 0, false} {
        swept_ = islands.where([&](int member) {
            const Sweep first = sweep_of(pass, efforts[member], 0);
            done_[member] = number - !first.backward;
            return done_[member] >= 0;
        });
        measured_ = swept_.where(
            [&](int member) { return sweep_of(pass, efforts[member], done_[member]++).measured; });
        sweep_.measured = measured_.any();
    }

    Members swept() const { return swept_; }
    Members measured() const { return measured_; }
    const Sweep& sweep() const { return sweep_; }
    /// Returns the number of an island's sweeps, with that of this turn.
    int done(int member) const { return done_[member]; }

  private:
    Sweep sweep_;
    Members swept_, measured_;
    PerMember<int> done_;
};

/// Sweeps islands side by side, each until its effort's end.
/// @param sweep_all   does a Sweep over some of them and returns its residuals [m/s]
template <class SweepAll>
PerMember<PassEnd> iterate(Pass pass, const PerMember<Effort>& efforts, Members islands,
                           const SweepAll& sweep_all) {
    PerMember<PassEnd> result;
    PerMember<double> smallest;
    smallest.fill(std::numeric_limits<double>::infinity());
    islands = islands.where([&](int member) { return efforts[member].sweeps > 0; });
    for (int number = 0; islands.any(); ++number) {
        const Turn turn(pass, efforts, islands, number);
        if (!turn.swept().any()) continue;
        const PerMember<double> left = sweep_all(turn.sweep(), turn.swept());
        for (const int member : turn.swept()) {
            const Effort& effort = efforts[member];
            const int done = turn.done(member);
            result[member].sweeps = done;
            bool ends = done == effort.sweeps;
            if (turn.measured().has(member)) {
                result[member].residual = left[member];
                ends = ends || effort.is_done(done, left[member]) ||
                       effort.leads_away(left[member], smallest[member]);
            }
            if (ends) islands = islands - Members::only(member);
        }
    }
    return result;
}

}  // namespace tesserae
