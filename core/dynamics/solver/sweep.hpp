#pragma once

#include <algorithm>
#include <limits>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// An impact's compression or a load, an impact's restitution, and what takes overlap away after a
/// load, by normal impulses alone.
enum class Pass { kSolve, kRestitution, kCorrection };

/// How long a pass goes on: until a sweep's residual is at most `enough`, at most so many.
struct Effort {
    int sweeps = 0;
    double enough = -1;  ///< [m/s]; -1: all sweeps
    int every = 1;       ///< how many sweeps there are for a look at the residual
    int further = 0;     ///< of sweeps at most, in pairs, while they go along conjugate directions
    int least = 0;       ///< of sweeps, unless hardly anything is left: see kLeastSweeps

    /// Whether so many sweeps are enough, the last of which had this residual [m/s].
    bool is_done(int done, double residual) const {
        return residual <= (done < least ? kHardlyAnything : 1) * enough;
    }
    /// Whether sweeps lead away from any solution, as where friction jams: see kLedAway.
    /// @param smallest   residual so far, infinite at first [m/s]
    bool leads_away(double residual, double& smallest) const {
        if (enough < 0) return false;
        if (residual > kLedAway * smallest) return true;
        smallest = std::min(smallest, std::max(residual, enough));
        return false;
    }
};
/// Whether as many sweeps as by default are asked for: then there may be more where they help.
inline bool may_take_more(const PhysicsSettings& settings) {
    return settings.tolerance > 0 && settings.iterations >= PhysicsSettings{}.iterations;
}
/// How many an island of so many contacts may take, as few cost little.
inline int sweeps_of_few(std::size_t work, std::size_t contacts, std::size_t most) {
    return static_cast<int>(std::min(work / contacts, most));
}
/// Of what rests: its impulses are started from in the next sub-step, which goes on with them.
/// Unless fewer sweeps than by default are asked for, what nothing has hit in the sub-step, and so
/// may be about to come to rest, goes further along conjugate directions, and an island of few
/// contacts may take more anyway.
inline Effort effort_of_load(const Simulation& simulation, const StepData& step,
                             std::size_t island) {
    const PhysicsSettings& settings = simulation.settings;
    Effort effort{settings.iterations, -1, 2, 0, kLeastSweeps};
    if (settings.tolerance > 0) effort.enough = settings.tolerance;
    if (!may_take_more(settings)) return effort;
    int most = sweeps_of_few(kLoadWork, step.islands.contacts[island], kMostLoadSweeps);
    // An odd number begins with a sweep forward, before there are directions: what these then go on
    // from is nearer to the load (7 of 160 towers that start with gaps fall with an even one, 1 of
    // 220 with an odd one).
    if (step.islands.is_coloured(island)) most = (most - 1) | 1;
    effort.sweeps = std::max(effort.sweeps, most);
    if (!step.was_hit[island])
        effort.further =
            effort.sweeps + std::max(0, kFurther * settings.iterations - effort.sweeps) / 2 * 2;
    return effort;
}
/// Of what takes overlap away, after the load: nothing goes on with it.
inline Effort effort_of_correction(const Simulation& simulation, std::size_t contacts) {
    const PhysicsSettings& settings = simulation.settings;
    Effort effort{std::min(settings.iterations, kCorrectionSweeps)};
    if (!may_take_more(settings)) return effort;
    effort.sweeps =
        std::max(effort.sweeps, sweeps_of_few(kCorrectionWork, contacts, kMostCorrectionSweeps));
    effort.enough = settings.tolerance, effort.every = 2;
    return effort;
}
/// Of an impact: nothing goes on with it, and a heavy body that hits light ones needs many sweeps.
/// @param fastest   see Impact
inline Effort effort_of_impact(const Simulation& simulation, std::size_t contacts, double fastest) {
    const auto sweeps = static_cast<int>(kImpactWork / contacts);
    return {std::max(simulation.settings.iterations, sweeps), kImpactResidual * fastest, 4};
}
/// A fourth of the iterations where there are many contacts: the load takes what is left (with 2 to
/// 5 of 10 the bodies of a wall of 1000 that a ball has hit are alike as fast as 1500 make them, to
/// 0.05 m/s rms while it breaks; Bullet's 10 are to 0.11).
inline Effort effort_of_large_impact(const Simulation& simulation, std::size_t contacts,
                                     double fastest) {
    const auto sweeps = static_cast<int>(kImpactWork / contacts);
    return {std::max((simulation.settings.iterations + 2) / 4, sweeps),
            kLargeImpactResidual * fastest, 4};
}
/// Of one from which bodies bounce: what they return by less no load makes up for. The compression
/// is an even number of sweeps, so that conjugate directions are there from the first one on, and
/// goes further while they lead somewhere.
inline Effort effort_of_bounce(const Simulation& simulation, std::size_t contacts, double fastest) {
    const auto sweeps = static_cast<int>(kImpactWork / contacts);
    return {std::max({simulation.settings.iterations, sweeps, 2}) & ~1,
            kLargeImpactResidual * fastest, 2, kBounceSweeps};
}

/// Of an impact among the contacts near it, see ImpactPatches.
inline Effort effort_of_patch(const Simulation& simulation, std::size_t contacts, double fastest) {
    Effort effort = effort_of_impact(simulation, contacts, fastest);
    effort.enough = kLargeImpactResidual * fastest;
    return effort;
}

/// What a load's impulses have done to an island.
struct LoadWork {
    double work = 0;    ///< times the velocities before them, less their targets [J]
    double energy = 0;  ///< twice the kinetic energy of what they have changed [J]

    /// Of energy. Sweeps only lessen it.
    bool is_gain() const { return work + 0.5 * energy > 0; }
    /// Whether a load does not start from so much: see kWarmStartWeight.
    /// @param energy_of_fall, stopped   energy_of_fall(), is_stopped()
    bool is_too_much(double energy_of_fall, bool stopped) const {
        return 0.5 * energy > kWarmStartWeight * energy_of_fall || (stopped && is_gain());
    }
    /// What the energy is at least where is_stopped().
    static double least_of_stop(double energy_of_fall) {
        return kWarmStartStop * kWarmStartStop * energy_of_fall;
    }
    /// The part of the impulses that leaves least to do, which is no gain.
    double best_part() const { return std::clamp(-work / energy, 0.0, 1.0); }
};

/// One iteration of a pass. Every other one goes through the island backward: a load at one end of
/// it then reaches the other in one iteration (a tower of ten leans 10 times less). The last one of
/// kSolve goes forward and those of the others backward, which is best for towers listed from the
/// ground; a pass that ends early ends so too, or what the other direction leaves shakes what rests
/// (a pyramid of 78 boxes by 1.7 mm/s instead of 0.01).
struct Sweep {
    Pass pass;
    bool backward, measured;  ///< measured: the residual is wanted
    /// Pairs of coloured islands are gone through from their last part to their first, so that a
    /// backward sweep is the adjoint of a forward one, which conjugate directions need. Others end
    /// sooner and with friction, so that no contact has more of it than its normal impulse allows.
    bool adjoint = false;
};
inline Sweep sweep_of(Pass pass, const Effort& effort, int iteration) {
    const int left = effort.sweeps - 1 - iteration;
    const bool asks = effort.enough >= 0 && left % effort.every == 0;
    return {pass, (left % 2 != 0) == (pass == Pass::kSolve), left == 0 || asks};
}

/// @param sweep_all   does a Sweep and returns its residual [m/s]
/// @return the residual of the last iteration [m/s]
template <class SweepAll>
double iterate(Pass pass, const Effort& effort, const SweepAll& sweep_all) {
    double residual = 0, smallest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < effort.sweeps; ++i) {
        const Sweep sweep = sweep_of(pass, effort, i);
        residual = sweep_all(sweep);
        if (!sweep.measured) continue;
        if (effort.is_done(i + 1, residual) || effort.leads_away(residual, smallest)) break;
    }
    return residual;
}

}  // namespace tesserae
