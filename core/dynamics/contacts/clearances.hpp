#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/dynamics/step/schedule.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// How far any point of a body has turned away from where it was, at most: a rotor's difference is
/// half the root of the squares of both angles.
double turned(const Rotor& from, const Rotor& to, double radius);

/// How far apart bodies are at least that have no contacts, from search to search: until they have
/// come so much nearer to each other, no search would find any, and none is made. (Mirtich 1996
/// calls it conservative; here the way is the one that the bodies have gone, not one to come.)
///
/// They change no result, so that they are not state: a world that has none finds the same.
class Clearances {
  public:
    /// Before a search for the contacts of step.pairs, which may be made again.
    void begin(const Simulation& simulation, const StepData& step, Schedule& schedule);
    /// After it.
    void end(const StepData& step, Schedule& schedule);

    /// What is left of them, of pairs in ascending order.
    class Search {
      public:
        /// @param first   of the pairs
        Search(const Clearances& all, const BodyPair& first);
        /// How far apart the bodies are at least [m]; 0 if that is not known.
        double left(const BodyPair& pair);

      private:
        const Clearances& all_;
        std::size_t place_;
    };
    /// Of a pair by its place in step.pairs: no more than its bodies' distance [m], or 0.
    void set(std::size_t place, double distance);

  private:
    /// How a body has moved since the last search.
    struct Way {
        std::array<float, 4> moved = {};  ///< its centre, world [m]
        float beyond = 0;                 ///< any of its points moved so much more at most [m]
    };

    Way way_of(const Simulation& simulation, const StepData& step, BodyId id) const;
    double nearer(const BodyPair& pair) const;

    std::vector<BodyPair> pairs_;         ///< of the last search, ascending
    std::vector<float> distance_, next_;  ///< of each of them; of each of step.pairs
    std::vector<Vec4> position_;          ///< of every body at the last search
    std::vector<Rotor> rotor_;
    std::vector<Way> way_;  ///< of every body
};

}  // namespace tesserae
