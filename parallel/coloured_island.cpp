#include "parallel/coloured_island.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>

#include "parallel/chunks.hpp"

namespace tesserae::parallel {
namespace {

/// Contacts of one task: some 5 us of a sweep.
constexpr std::size_t kGrain = 128;

/// The island's colours in order, and what is left over as the last.
struct Colours {
    const Islands& islands;
    std::size_t island;

    std::size_t size() const {
        return islands.first_colour[island + 1] - islands.first_colour[island] + 1;
    }
    bool is_leftover(std::size_t colour) const { return colour + 1 == size(); }
    Range operator[](std::size_t colour) const {
        const std::uint32_t* const ends = islands.colours.data() + islands.first_colour[island];
        return {colour == 0 ? islands.first[island] : ends[colour - 1],
                is_leftover(colour) ? islands.first[island + 1] : ends[colour]};
    }
};

Range moved(Range range, std::size_t by) { return {range.begin + by, range.end + by}; }

/// Calls work(Range) for pieces of the colour at once.
template <class Work>
void for_places(Range places, const Work& work) {
    for_each_range(places.end - places.begin, kGrain,
                   [&](Range piece) { work(moved(piece, places.begin)); });
}

double sweep_colour(const Simulation& simulation, StepData& step, Range places, Sweep sweep) {
    const std::size_t count = places.end - places.begin, chunks = (count + kGrain - 1) / kGrain;
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, chunks, 1), 0.0,
        [&](const tbb::blocked_range<std::size_t>& range, double largest) {
            const Range piece{places.begin + range.begin() * kGrain,
                              places.begin + std::min(count, range.end() * kGrain)};
            return std::max(largest, sweep_contacts(simulation, step, piece, sweep));
        },
        [](double a, double b) { return std::max(a, b); });
}

void iterate(const Simulation& simulation, StepData& step, std::size_t island, Pass pass) {
    const Colours colours{step.islands, island};
    double residual = 0;
    for (int i = 0; i < simulation.settings.iterations; ++i) {
        const Sweep sweep = sweep_of(simulation, pass, i);
        for (std::size_t k = 0; k < colours.size(); ++k) {
            const std::size_t colour = sweep.backward ? colours.size() - 1 - k : k;
            const double change = colours.is_leftover(colour)
                                      ? sweep_contacts(simulation, step, colours[colour], sweep)
                                      : sweep_colour(simulation, step, colours[colour], sweep);
            residual = std::max(residual, change);
        }
    }
    step.residual[island] = residual;
}

}  // namespace

void solve_coloured_island(const Simulation& simulation, StepData& step, std::size_t island) {
    const Colours colours{step.islands, island};
    for_places(step.islands.places(island),
               [&](Range places) { make_rows(simulation, step, places); });
    for (std::size_t colour = 0; colour + 1 < colours.size(); ++colour)
        for_places(colours[colour], [&](Range places) { warm_start(simulation, step, places); });
    warm_start(simulation, step, colours[colours.size() - 1]);
    iterate(simulation, step, island, Pass::kSolve);
}

void relax_coloured_island(const Simulation& simulation, StepData& step, std::size_t island) {
    if (simulation.settings.solver == Solver::kSoft)
        iterate(simulation, step, island, Pass::kRelax);
    for_places(step.islands.places(island), [&](Range places) { keep_impulses(step, places); });
}

}  // namespace tesserae::parallel
