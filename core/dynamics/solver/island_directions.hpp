// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/solver/sweep.hpp"

namespace tesserae {

/// The directions of one island's load or impact, see conjugate.hpp.
class IslandDirections {
  public:
    /// The rows' part of r.z, r.p and the energy.
    struct RowSums {
        double of_step = 0, of_all = 0;
    };

    IslandDirections() = default;
    /// @param warm_start   energy of the warm start, see weigh_warm_start()
    /// @param rounding     relative rounding of the changes of bodies' motion
    IslandDirections(double warm_start, double rounding)
        : warm_start_(warm_start),
          relative_(rounding * rounding),
          rounding_(relative_ * warm_start) {}

    /// Weighs a pair of sweeps, by which what the next direction carries of the last is known.
    /// @param sums   the bodies' part of r.z, r.p_last and the energy
    void weigh(const BodySums& sums, const RowSums& rows) {
        rounding_ = std::max(rounding_, relative_ * sums[2]);
        slope_ = sums[0] + rows.of_step;
        of_last_ = sums[1] + of_direction_;
        const double ratio = last_slope_ > 0 ? slope_ / last_slope_ : 0;
        look_for_rise(ratio, slope_, sums[2] + rows.of_all);
        carried_ = ratio > 0 && plain_ == 0 ? static_cast<float>(ratio) : 0;
        of_direction_ = rows.of_step + carried_ * of_direction_;
    }
    /// Finds the length of the step along the new direction.
    /// @param twice_energy   p.Ap
    /// @param most           longest step along it
    void find_length(double twice_energy, double most = kLongestStep) {
        const double length = std::min(most, (slope_ + carried_ * of_last_) / twice_energy);
        holds_ = plain_ == 0 && length > 1 && slope_ > rounding_;
        length_ = holds_ ? static_cast<float>(length) : 1;
    }
    /// Begins the next pair of sweeps.
    void go_on() {
        last_slope_ = holds_ ? slope_ : 0;
        if (holds_) return;
        plain_ = std::max(0, plain_ - 1);
        of_direction_ = 0;
        least_slope_ = std::numeric_limits<double>::infinity();
    }

    /// Returns whether the next pair of sweeps begins with a step along the direction.
    bool holds() const { return holds_; }
    float carried() const { return carried_; }
    float length() const { return length_; }
    double warm_start() const { return warm_start_; }

  private:
    /// The growth of the slope over the least since directions began, at which they are given up
    /// for a while, as a factor. Usual 16. More: where float resolves no more, directions are
    /// rounding, grow from step to step, and lead impulses and velocities apart. Less: useful
    /// directions are given up.
    static constexpr double kMostRisen = 16;

    /// Gives directions up for a while after a step that led away from the solution.
    /// @param ratio   r.z divided by r.z before the step
    void look_for_rise(double ratio, double slope, double energy) {
        const bool rises = ratio > kMostCarried || slope > kMostRisen * least_slope_;
        if (last_slope_ > 0 && !(energy <= last_energy_ && !rises)) {
            plain_ = pause_;
            pause_ = 2 * pause_;
        }
        last_energy_ = energy;
        least_slope_ = std::min(least_slope_, slope);
    }

    double warm_start_ = 0;
    double relative_ = 0, rounding_ = 0;                            ///< rounding of a slope
    double slope_ = 0, last_slope_ = 0;                             ///< r.z
    double least_slope_ = std::numeric_limits<double>::infinity();  ///< since a first direction
    double of_last_ = 0;                                            ///< r.p_last
    double of_direction_ = 0;                                       ///< rows' part of r.p
    double last_energy_ = 0;                                        ///< at the end of the last pair
    int plain_ = 0, pause_ = 1;  ///< pairs without a direction, now and the next time
    float carried_ = 0, length_ = 1;
    bool holds_ = false;
};

/// Sweeps islands along conjugate directions until neither a row's velocity, nor a body's by the
/// next step along the direction, changes by more than the tolerance, or than the rounding of the
/// loads. The second condition is for motions of a whole wall, which no row sees.
template <class Rows, class Directions>
class AlongDirections {
  public:
    AlongDirections(Rows& rows, Directions& directions, Pass pass, const PerMember<Effort>& efforts)
        : rows_(rows), directions_(directions), pass_(pass), efforts_(efforts) {
        smallest_.fill(std::numeric_limits<double>::infinity());
    }

    /// @param instead   is called for islands whose directions end with a gain of energy
    template <class Instead>
    PerMember<PassEnd> solve(Members some, const Instead& instead) {
        Members gains;
        for (int number = 0; some.any(); ++number) {
            const Turn turn(Pass::kSolve, efforts_, some, number);
            if (!turn.swept().any()) continue;
            sweep(turn);
            const Members ends = ends_of(turn);
            gains = gains | (ends & directions_.begun()).where([&](int member) {
                return result_[member].residual > efforts_[member].enough &&
                       directions_.is_gain(member);
            });
            some = some - ends;
        }
        if (gains.any()) {
            directions_.take_back(gains);
            instead(gains);
        }
        return result_;
    }

  private:
    void sweep(const Turn& turn) {
        Sweep one = turn.sweep();
        one.pass = pass_, one.adjoint = one.backward;
        if (one.backward) {
            directions_.go_on(turn.swept() & directions_.begun());
            directions_.begin(turn.swept() - directions_.begun());
        }
        const PerMember<double> left = directions_.begun().any()
                                           ? rows_.sweep(one, turn.swept(), directions_)
                                           : rows_.sweep(one, turn.swept());
        for (const int member : turn.swept())
            result_[member] = {turn.measured().has(member) ? left[member] : 0, turn.done(member)};
    }
    /// Returns the islands that end with this turn.
    Members ends_of(const Turn& turn) {
        Members ends = turn.measured().where([&](int member) {
            return efforts_[member].leads_away(result_[member].residual, smallest_[member]);
        });
        const auto most = [&](int member) {
            return std::max(efforts_[member].sweeps, efforts_[member].further);
        };
        if (!turn.sweep().backward) {
            const Members goes =
                ((turn.swept() - ends) & directions_.begun()).where([&](int member) {
                    return turn.done(member) != most(member);
                });
            const PerMember<double> moves = directions_.find(goes);
            ends = ends | goes.where([&](int member) {
                return is_solved(member, turn.done(member), moves[member]);
            });
        }
        return ends | turn.swept().where([&](int member) {
            const int done = turn.done(member);
            return done >= efforts_[member].sweeps &&
                   (done >= efforts_[member].further || !directions_.holds(member));
        });
    }
    /// @param moves   the largest change of a body's velocity in the next step [m/s]
    bool is_solved(int member, int done, double moves) {
        const double left = std::max(result_[member].residual, moves);
        if (efforts_[member].is_done(done, left)) return true;
        if (efforts_[member].all || efforts_[member].enough < 0 || done < efforts_[member].least)
            return false;
        if (!weighed_.has(member)) {
            weighed_ = weighed_ | Members::only(member);
            rounding_[member] = rows_.rounding_of_loads(member);
        }
        return left <= rounding_[member];
    }

    Rows& rows_;
    Directions& directions_;
    Pass pass_;
    const PerMember<Effort>& efforts_;
    PerMember<PassEnd> result_;
    PerMember<double> smallest_;  ///< residual so far [m/s]
    Members weighed_;             ///< islands whose rounding_of_loads() is known
    PerMember<double> rounding_;  ///< [m/s]
};

}  // namespace tesserae
