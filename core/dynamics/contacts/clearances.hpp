// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/dynamics/step/schedule.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Returns the greatest distance by which turning has moved any point of a body within `radius`:
/// the difference of the rotors is half the root of the sum of the squares of both angles.
double turned(const Rotor& from, const Rotor& to, double radius);

/// Lower bounds of the distance between bodies without contacts, kept from search to search. No
/// search is made until two bodies have come so much nearer to each other, as it would find
/// nothing. (This is Mirtich's conservative bound, 1996, but for the motion that was, not for the
/// motion to come.)
///
/// Clearances change no result and are not state: a world without them finds the same contacts.
class Clearances {
  public:
    /// Is called before a search for the contacts of step.pairs; the search may be repeated.
    void begin(const Simulation& simulation, const StepData& step, Schedule& schedule);
    /// Is called after the search.
    void end(const StepData& step, Schedule& schedule);

    /// Looks up the remaining clearances of pairs in ascending order.
    class Search {
      public:
        /// @param first   first of the pairs
        Search(const Clearances& all, const BodyPair& first);
        /// Returns the least distance of a pair's bodies [m], or 0 if it is not known.
        double left(const BodyPair& pair);

      private:
        const Clearances& all_;
        std::size_t place_;
    };
    /// Sets the clearance of the pair at a place in step.pairs: at most its bodies' distance [m],
    /// or 0.
    void set(std::size_t place, double distance);

  private:
    /// The motion of a body since the last search.
    struct Way {
        std::array<float, 4> moved = {};  ///< its centre, world [m]
        float beyond = 0;                 ///< greatest further motion of any of its points [m]
    };

    Way way_of(const Simulation& simulation, const StepData& step, BodyId id) const;
    double nearer(const BodyPair& pair) const;

    std::vector<BodyPair> pairs_;         ///< of the last search, ascending
    std::vector<float> distance_, next_;  ///< for each of pairs_; for each of step.pairs
    std::vector<Vec4> position_;          ///< of every body at the last search
    std::vector<Rotor> rotor_;
    std::vector<Way> way_;  ///< of every body
};

}  // namespace tesserae
