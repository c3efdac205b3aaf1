#include "core/dynamics/solver/conjugate.hpp"

#include <algorithm>

#include "core/dynamics/solver/coloured_place.hpp"
#include "core/dynamics/state/type_properties.hpp"

namespace tesserae {
namespace {

using lanes::Float8;
constexpr lanes::Lane<Float8> kAll;

/// Calls visit(impulse, place in the lists of last impulses and directions) for all eights of
/// impulses of a row of round bodies, the normal one first.
template <class Visit>
void visit_round(ColouredIslands& coloured, std::size_t row, const Visit& visit) {
    std::size_t place = row * impulses_of_round(coloured);
    visit(coloured.round_rows[row].along.impulse, place++);
    if (!coloured.friction) return;
    for (Eight& impulse : coloured.round_friction[row].impulse) visit(impulse, place++);
}
/// The same of the rows of batches of any bodies.
template <class Visit>
void visit_general(ColouredIslands& coloured, BatchRange batches, const Visit& visit) {
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.general[i];
        for (std::uint32_t row = batch.row; row < batch.row + batch.rows; ++row) {
            std::size_t place = row * impulses_of_general(coloured);
            visit(coloured.rows[row].along.impulse, place++);
            if (!coloured.friction) continue;
            for (Eight& impulse : coloured.general_friction[row].impulse) visit(impulse, place++);
        }
    }
}

/// Keeps impulses where they are, without a direction.
auto begin(std::vector<Eight>& lasts, std::vector<Eight>& directions) {
    return [last = lasts.data(), direction = directions.data()](const Eight& impulse,
                                                                std::size_t place) {
        last[place] = impulse;
        direction[place] = {};
    };
}
/// Eight impulses go from where they were along the new direction.
auto go(std::vector<Eight>& lasts, std::vector<Eight>& directions, float carried, float length) {
    return [last = lasts.data(), direction = directions.data(), carried, length](
               Eight& impulse, std::size_t place) {
        const Float8 from = kAll.load(last[place]);
        const Float8 along = (kAll.load(impulse) - from) + carried * kAll.load(direction[place]);
        const Float8 here = from + length * along;
        kAll.store(along, direction[place]);
        kAll.store(here, impulse);
        kAll.store(here, last[place]);
    };
}

/// What sums over a batch's rows add up: changes of impulses, directions and impulses times the
/// velocities of the load's start less the targets.
class Work {
  public:
    Work(const std::vector<Eight>& last, const std::vector<Eight>& direction, std::size_t place)
        : last_(&last[place]), direction_(&direction[place]) {}
    /// Of the next eight impulses.
    void add(const Eight& impulse, Float8 velocity) {
        const Float8 now = kAll.load(impulse);
        of_step_ = simd::fused(kAll.load(*last_++) - now, velocity, of_step_);
        of_direction_ = simd::fused(-kAll.load(*direction_++), velocity, of_direction_);
        of_all_ = simd::fused(now, velocity, of_all_);
    }
    void store(std::array<Eight, 3>& to) const {
        kAll.store(of_step_, to[0]);
        kAll.store(of_direction_, to[1]);
        kAll.store(of_all_, to[2]);
    }

  private:
    const Eight *last_, *direction_;
    Float8 of_step_{}, of_direction_{}, of_all_{};
};

/// Of a row of any bodies.
void add_row(const ColouredIslands& coloured, std::uint32_t index, std::uint32_t row, Work& work) {
    const NormalRow& along = coloured.rows[row].along;
    const lanes::Place<Float8> at = lanes::place_of(kAll, coloured.rows[row]);
    const std::array<Float8, 4> start = lanes::load_all(kAll, coloured.frames[index].motion);
    work.add(along.impulse, lanes::along_at(at, start) - kAll.load(along.target));
    if (!coloured.friction) return;
    const std::array<Float8, 6> across =
        lanes::load_all(kAll, coloured.pair_friction[index].motion);
    const lanes::LaneVec4<Float8> slip = lanes::across_at(at, across);
    const auto& tangent = coloured.general_friction[row].impulse;
    for (std::size_t i = 0; i < 3; ++i) work.add(tangent[i], slip[i]);
}

using simd::Float4;
/// A body's record as three vectors of four.
using Twelve = std::array<Float4, 3>;

template <class Record>
[[gnu::always_inline]] inline Twelve load(const Record& record) {
    return {simd::same_bits<Float4>(record.velocity), simd::same_bits<Float4>(record.first_planes),
            simd::same_bits<Float4>(record.rest)};
}
template <class Record>
[[gnu::always_inline]] inline void store(const Twelve& x, Record& record) {
    using Four = std::array<float, 4>;
    record.velocity = simd::same_bits<Four>(x[0]);
    record.first_planes = simd::same_bits<Four>(x[1]);
    record.rest = simd::same_bits<Four>(x[2]);
}
[[gnu::always_inline]] inline Twelve operator+(const Twelve& a, const Twelve& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
[[gnu::always_inline]] inline Twelve operator-(const Twelve& a, const Twelve& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[gnu::always_inline]] inline Twelve operator*(float k, const Twelve& a) {
    return {k * a[0], k * a[1], k * a[2]};
}
[[gnu::always_inline]] inline double product(const Twelve& a, const Twelve& b) {
    const Float4 sums = a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]);
    return (double{sums[0]} + sums[1]) + (double{sums[2]} + sums[3]);
}

/// A symmetric 6x6 matrix times the turning part of x.
[[gnu::always_inline]] inline void turn(const BodyInertia& inertia, const Twelve& x, Twelve& to) {
    const auto& e = inertia.entry;
    const Float4 &w = x[1], &v = x[2];
    const auto row = [&](float e0, float e1, float e2, float e3, float e4, float e5) {
        return ((e0 * w[0] + e1 * w[1]) + (e2 * w[2] + e3 * w[3])) + (e4 * v[0] + e5 * v[1]);
    };
    to[1] = Float4{row(e[0][0], e[0][1], e[0][2], e[0][3], e[1][0], e[1][1]),
                   row(e[0][1], e[1][2], e[1][3], e[2][0], e[2][1], e[2][2]),
                   row(e[0][2], e[1][3], e[2][3], e[3][0], e[3][1], e[3][2]),
                   row(e[0][3], e[2][0], e[3][0], e[3][3], e[4][0], e[4][1])};
    to[2] = Float4{row(e[1][0], e[2][1], e[3][1], e[4][0], e[4][2], e[4][3]),
                   row(e[1][1], e[2][2], e[3][2], e[4][1], e[4][3], e[5][0]), 0, 0};
}

/// The momentum of a change of the motion of a body in `bodies`.
[[gnu::always_inline]] inline Twelve momentum_of(const ColouredIslands& coloured, std::size_t body,
                                                 const Twelve& change) {
    const std::array<float, 4>& rest = coloured.changes[body].rest;
    const auto inverse_of = [](float inverse) { return inverse > 0 ? 1 / inverse : 0; };
    const float inertia = inverse_of(rest[3]);
    Twelve momentum = {inverse_of(rest[2]) * change[0], inertia * change[1], inertia * change[2]};
    if (coloured.turns_unevenly && rest[3] == 0) turn(coloured.inertias[body], change, momentum);
    return momentum;
}

/// Without the masses in a record of changes.
[[gnu::always_inline]] inline Twelve change_of(const BodyChange& record) {
    Twelve change = load(record);
    change[2][2] = change[2][3] = 0;
    return change;
}

}  // namespace

bool has_conjugates(const Simulation& simulation) {
    return simulation.settings.solver == Solver::kImpulse &&
           std::all_of(
               simulation.types.begin(), simulation.types.end(), [](const TypeProperties& type) {
                   return type.friction <= kMostConjugateFriction && type.rolling_friction == 0;
               });
}

void take_recalled(const ColouredStage& stage, Range bodies) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const BodyId id = coloured.bodies[i];
        const TypeProperties& type = stage.simulation.type_of(id);
        if (coloured.turns_unevenly)
            coloured.inertias[i] = type.isotropic
                                       ? BodyInertia{}
                                       : packed(world_map(type.inertia, type, stage.step.rotor[id]),
                                                1 / stage.mass_unit);
        BodyChange& change = coloured.changes[i];
        const Twelve recalled = change_of(change);
        coloured.recalled[i] = change;
        coloured.momentum[i] = {};
        coloured.body_sums[i] = {0.5 * product(recalled, momentum_of(coloured, i, recalled)), 0, 0};
        change.velocity = change.first_planes = {};
        change.rest[0] = change.rest[1] = 0;
    }
}

void begin_directions(const ColouredStage& stage, Range bodies) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        coloured.last_changes[i] = coloured.changes[i];
        coloured.direction[i] = {};
        coloured.direction_momentum[i] = {};
    }
}

void begin_round_directions(const ColouredStage& stage, BatchRange batches) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i)
        visit_round(coloured, i, begin(coloured.last_round, coloured.round_direction));
}

void begin_general_directions(const ColouredStage& stage, BatchRange batches) {
    ColouredIslands& coloured = stage.step.coloured;
    visit_general(coloured, batches, begin(coloured.last_general, coloured.general_direction));
}

void weigh_step(const ColouredStage& stage, Range bodies) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const Twelve end = load(coloured.changes[i]);
        const Twelve step = end - load(coloured.last_changes[i]);
        const Twelve of_step = momentum_of(coloured, i, step), of_all = load(coloured.momentum[i]);
        store(of_step, coloured.step_momentum[i]);
        coloured.body_sums[i] = {-product(step, of_all),
                                 -product(load(coloured.direction[i]), of_all),
                                 0.5 * product(end, of_all + of_step)};
    }
}

void weigh_round_step(const ColouredStage& stage, BatchRange batches) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        Work work(coloured.last_round, coloured.round_direction, i * impulses_of_round(coloured));
        const NormalRow& along = coloured.round_rows[i].along;
        work.add(along.impulse, -kAll.load(along.target));
        if (coloured.friction)
            for (std::size_t k = 0; k < 4; ++k)
                work.add(coloured.round_friction[i].impulse[k],
                         kAll.load(coloured.round_friction[i].slip[k]));
        work.store(coloured.round_work[i]);
    }
}

void weigh_general_step(const ColouredStage& stage, BatchRange batches) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.general[i];
        Work work(coloured.last_general, coloured.general_direction,
                  batch.row * impulses_of_general(coloured));
        for (std::uint32_t row = batch.row; row < batch.row + batch.rows; ++row)
            add_row(coloured, i, row, work);
        work.store(coloured.general_work[i]);
    }
}

void find_direction(const ColouredStage& stage, Range bodies, float carried) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const Twelve step = load(coloured.changes[i]) - load(coloured.last_changes[i]);
        const Twelve along = step + carried * load(coloured.direction[i]);
        const Twelve of_along =
            load(coloured.step_momentum[i]) + carried * load(coloured.direction_momentum[i]);
        store(along, coloured.direction[i]);
        store(of_along, coloured.direction_momentum[i]);
        const Twelve velocity = {along[0], Float4{}, Float4{}};
        coloured.body_sums[i] = {product(along, of_along), product(velocity, velocity), 0};
    }
}

void go_along(const ColouredStage& stage, Range bodies, float length) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const Twelve here = load(coloured.last_changes[i]) + length * load(coloured.direction[i]);
        store(here, coloured.changes[i]);
        store(here, coloured.last_changes[i]);
        store(load(coloured.momentum[i]) + length * load(coloured.direction_momentum[i]),
              coloured.momentum[i]);
    }
}

void go_along_round(const ColouredStage& stage, BatchRange batches, float carried, float length) {
    ColouredIslands& coloured = stage.step.coloured;
    const auto move = go(coloured.last_round, coloured.round_direction, carried, length);
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) visit_round(coloured, i, move);
}

void go_along_general(const ColouredStage& stage, BatchRange batches, float carried, float length) {
    ColouredIslands& coloured = stage.step.coloured;
    visit_general(coloured, batches,
                  go(coloured.last_general, coloured.general_direction, carried, length));
}

void go_from_end(const ColouredStage& stage, Range bodies) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i)
        store(load(coloured.momentum[i]) + load(coloured.step_momentum[i]), coloured.momentum[i]);
    begin_directions(stage, bodies);
}

}  // namespace tesserae
