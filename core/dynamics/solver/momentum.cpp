#include "core/dynamics/solver/momentum.hpp"

#include <algorithm>
#include <span>

namespace tesserae {
namespace {

/// Calls visit(impulse, last) for all eights of impulses of a row of round bodies.
template <class Visit>
void visit_round(ColouredIslands& coloured, std::size_t row, const Visit& visit) {
    const std::size_t count = impulses_of_round(coloured);
    Eight* last = &coloured.last_round[row * count];
    visit(coloured.round_rows[row].along.impulse, *last++);
    if (!coloured.friction) return;
    for (Eight& impulse : coloured.round_friction[row].impulse) visit(impulse, *last++);
    if (!coloured.rolling) return;
    for (Eight& impulse : coloured.round_rolling[row].impulse) visit(impulse, *last++);
}
/// The same of a row of any bodies.
template <class Visit>
void visit_general(ColouredIslands& coloured, std::size_t row, const Visit& visit) {
    const std::size_t count = impulses_of_general(coloured);
    Eight* last = &coloured.last_general[row * count];
    visit(coloured.rows[row].along.impulse, *last++);
    if (!coloured.friction) return;
    for (Eight& impulse : coloured.general_friction[row].impulse) visit(impulse, *last++);
    if (!coloured.rolling) return;
    for (Eight& impulse : coloured.general_rolling[row].impulse) visit(impulse, *last++);
}

template <class Visit>
void visit_rows(const ColouredStage& stage, BatchRange batches, const Visit& visit) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.general[i];
        for (std::uint32_t row = batch.row; row < batch.row + batch.rows; ++row)
            visit_general(coloured, row, visit);
    }
}

const auto copy = [](Eight& impulse, Eight& last) { last = impulse; };

/// x goes on by a part of its way from `last`, which becomes x.
void carry_on(float& x, float& last, float part) {
    const float here = x;
    x += part * (here - last);
    last = here;
}
auto carry_on_by(float part) {
    return [part](Eight& impulse, Eight& last) {
        const lanes::Lane<lanes::Float8> all;
        const lanes::Float8 here = all.load(impulse);
        all.store(here + part * (here - all.load(last)), impulse);
        all.store(here, last);
    };
}

/// Calls visit(places in a record) for its velocity, and for what it turns by.
template <class Visit>
void visit_motion(BodyChange& change, BodyChange& other, const Visit& visit) {
    for (std::size_t i = 0; i < 4; ++i) visit(change.velocity[i], other.velocity[i]);
    for (std::size_t i = 0; i < 4; ++i) visit(change.first_planes[i], other.first_planes[i]);
    for (std::size_t i = 0; i < 2; ++i) visit(change.rest[i], other.rest[i]);
}

/// (first - now) . (now - last)
double turned_back(std::span<const float> first, std::span<const float> now,
                   std::span<const float> last) {
    double sum = 0;
    for (std::size_t i = 0; i < now.size(); ++i)
        sum += (double{first[i]} - now[i]) * (double{now[i]} - last[i]);
    return sum;
}

}  // namespace

bool bears_momentum(const Simulation& simulation) {
    return std::all_of(
        simulation.types.begin(), simulation.types.end(),
        [](const TypeProperties& type) { return type.friction <= kMostMomentumFriction; });
}

void begin_momentum(const ColouredStage& stage, Range bodies) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i)
        coloured.last_changes[i] = coloured.first_changes[i] = coloured.changes[i];
}

void begin_round_momentum(const ColouredStage& stage, BatchRange batches) {
    for (std::uint32_t i = batches.begin; i < batches.end; ++i)
        visit_round(stage.step.coloured, i, copy);
}

void begin_general_momentum(const ColouredStage& stage, BatchRange batches) {
    visit_rows(stage, batches, copy);
}

void measure_turning_back(const ColouredStage& stage, Range bodies) {
    // A ball's inertia, in parts of mass times radius squared: any near it will do.
    constexpr double kInertia = 1.0 / 3;
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const BodyChange &first = coloured.first_changes[i], &now = coloured.changes[i],
                         &last = coloured.last_changes[i];
        const TypeProperties& type = stage.simulation.type_of(coloured.bodies[i]);
        const std::span<const float> two(now.rest.data(), 2);
        coloured.turned_back[i] =
            type.mass * (turned_back(first.velocity, now.velocity, last.velocity) +
                         kInertia * type.radius * type.radius *
                             (turned_back(first.first_planes, now.first_planes, last.first_planes) +
                              turned_back({first.rest.data(), 2}, two, {last.rest.data(), 2})));
    }
}

void carry_on(const ColouredStage& stage, Range bodies, float part) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        visit_motion(coloured.changes[i], coloured.last_changes[i],
                     [part](float& x, float& last) { carry_on(x, last, part); });
        coloured.first_changes[i] = coloured.changes[i];
    }
}

void carry_on_round(const ColouredStage& stage, BatchRange batches, float part) {
    for (std::uint32_t i = batches.begin; i < batches.end; ++i)
        visit_round(stage.step.coloured, i, carry_on_by(part));
}

void carry_on_general(const ColouredStage& stage, BatchRange batches, float part) {
    visit_rows(stage, batches, carry_on_by(part));
}

}  // namespace tesserae
