// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/conjugate.hpp"

#include <algorithm>

#include "core/dynamics/bodies/type_properties.hpp"
#include "core/dynamics/constraints/contact_row.hpp"
#include "core/dynamics/constraints/rolling_row.hpp"
#include "core/dynamics/solver/kernels/place.hpp"

namespace tesserae {
namespace {

using lanes::Float8;
constexpr lanes::Lane<Float8> kAll;

/// Calls visit(impulse, last, direction) for all eights of impulses of rows of a batch.
template <std::size_t kTangents, class Visit>
[[gnu::always_inline]] inline void visit_rows(RowImpulses<kTangents>& impulses,
                                              RowImpulses<kTangents>& lasts,
                                              RowImpulses<kTangents>& directions,
                                              std::uint32_t first, std::uint32_t rows,
                                              const Visit& visit) {
    for (std::uint32_t row = first; row < first + rows; ++row)
        visit(impulses.normal[row], lasts.normal[row], directions.normal[row]);
    if (impulses.tangent.empty()) return;
    for (std::uint32_t row = first; row < first + rows; ++row)
        for (std::size_t i = 0; i < kTangents; ++i)
            visit(impulses.tangent[row][i], lasts.tangent[row][i], directions.tangent[row][i]);
}
/// Calls visit(impulse, last, direction) for all eights of impulses of a batch.
template <class Visit>
[[gnu::always_inline]] inline void visit_round(ColouredIslands& coloured, std::uint32_t batch,
                                               const Visit& visit) {
    visit_rows(coloured.round_impulses, coloured.last_round, coloured.round_direction, batch, 1,
               visit);
}
template <class Visit>
[[gnu::always_inline]] inline void visit_general(ColouredIslands& coloured, std::uint32_t batch,
                                                 const Visit& visit) {
    visit_rows(coloured.impulses, coloured.last_general, coloured.general_direction,
               coloured.general[batch].row, coloured.general[batch].rows, visit);
}

/// As if all of the impulses of some islands had come since, without a direction.
auto begin_at_none(const Batch& batch, Members some) {
    const Float8 begins = kAll.load(lanes_of(batch, some));
    return [=](const Eight&, Eight& last, Eight& direction) {
        const Float8 none{};
        kAll.store(begins > none ? none : kAll.load(last), last);
        kAll.store(begins > none ? none : kAll.load(direction), direction);
    };
}
/// Impulses stay where they are, without a direction.
constexpr auto stay = [](const Eight& impulse, Eight& last, Eight& direction) {
    last = impulse;
    direction = {};
};
/// Impulses go from where they were along the new direction, or stay where they are.
auto go_or_stay(const Batch& batch, const DirectionSteps& steps) {
    const Float8 carried = kAll.load(of_lanes(batch, steps.carried));
    const Float8 length = kAll.load(of_lanes(batch, steps.length));
    const Float8 goes = kAll.load(lanes_of(batch, steps.along));
    return [=](Eight& impulse, Eight& last, Eight& direction) {
        const Float8 now = kAll.load(impulse), from = kAll.load(last), none{};
        const Float8 along = (now - from) + carried * kAll.load(direction);
        const Float8 here = goes > none ? from + length * along : now;
        kAll.store(goes > none ? along : none, direction);
        kAll.store(here, impulse);
        kAll.store(here, last);
    };
}

using simd::Double4, simd::Float4;
[[gnu::always_inline]] inline Double4 in_double(const Float4& x) {
    return __builtin_convertvector(x, Double4);
}
[[gnu::always_inline]] inline double total_of(const Double4& x) {
    return (x[0] + x[1]) + (x[2] + x[3]);
}

/// What sums over a batch's rows add up: changes of impulses and impulses times the velocities of
/// the load's start less the targets.
class Work {
  public:
    [[gnu::always_inline]] void add(const Eight& impulse, const Eight& last, Float8 velocity) {
        const Float8 now = kAll.load(impulse);
        of_step_ = simd::fused(kAll.load(last) - now, velocity, of_step_);
        of_all_ = simd::fused(now, velocity, of_all_);
    }
    std::array<double, 2> sums() const { return {sum_of(of_step_), sum_of(of_all_)}; }
    std::array<Eight, 2> of_lanes() const {
        std::array<Eight, 2> sums;
        kAll.store(of_step_, sums[0]);
        kAll.store(of_all_, sums[1]);
        return sums;
    }

  private:
    static double sum_of(const Float8& lanes) {
        return total_of(in_double(__builtin_shufflevector(lanes, lanes, 0, 1, 2, 3)) +
                        in_double(__builtin_shufflevector(lanes, lanes, 4, 5, 6, 7)));
    }
    Float8 of_step_{}, of_all_{};
};

/// Of a batch of any bodies.
[[gnu::always_inline]] inline Work work_of_general(const ColouredIslands& coloured,
                                                   std::uint32_t index) {
    const auto& [normal, tangent] = coloured.impulses;
    const RowImpulses<3>& last = coloured.last_general;
    const Batch& batch = coloured.general[index];
    const std::array<Float8, 4> along = lanes::load_all(kAll, coloured.frames[index].motion);
    std::array<Float8, 6> across{};
    if (coloured.friction) across = lanes::load_all(kAll, coloured.pair_friction[index].motion);
    Work work;
    for (std::uint32_t row = batch.row; row < batch.row + batch.rows; ++row) {
        const lanes::Place<Float8> at = lanes::place_of(kAll, coloured.rows[row]);
        work.add(normal[row], last.normal[row],
                 lanes::along_at(at, along) - kAll.load(coloured.rows[row].along.target));
        if (!coloured.friction) continue;
        const lanes::LaneVec4<Float8> slip = lanes::across_at(at, across);
        for (std::size_t i = 0; i < 3; ++i)
            work.add(tangent[row][i], last.tangent[row][i], slip[i]);
    }
    return work;
}

/// A body's record as three vectors of four.
using Twelve = std::array<Float4, 3>;

/// Without the masses.
template <class Record>
[[gnu::always_inline]] inline Twelve load(const Record& record) {
    return {simd::same_bits<Float4>(record.velocity), simd::same_bits<Float4>(record.first_planes),
            Float4{record.rest[0], record.rest[1]}};
}
template <class Record>
[[gnu::always_inline]] inline void store(const Twelve& x, Record& record) {
    using Four = std::array<float, 4>;
    record.velocity = simd::same_bits<Four>(x[0]);
    record.first_planes = simd::same_bits<Four>(x[1]);
    record.rest[0] = x[2][0], record.rest[1] = x[2][1];
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
/// Four numbers whose total is the product: those of many bodies are added up first.
[[gnu::always_inline]] inline Double4 product(const Twelve& a, const Twelve& b) {
    return in_double(a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]));
}

/// An inertia times the turning part of x.
[[gnu::always_inline]] inline void turn(const BodyInertia& inertia, const Twelve& x, Twelve& to) {
    const auto column = [&](std::size_t i) { return simd::same_bits<Float8>(inertia.column[i]); };
    const Float4 &w = x[1], &v = x[2];
    const Float8 sum = (w[0] * column(0) + w[1] * column(1)) +
                       (w[2] * column(2) + w[3] * column(3)) +
                       (v[0] * column(4) + v[1] * column(5));
    to[1] = __builtin_shufflevector(sum, sum, 0, 1, 2, 3);
    to[2] = __builtin_shufflevector(sum, sum, 4, 5, 6, 7);
}
void put_columns(const BivectorMap& map, double factor, BodyInertia& to) {
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
            to.column[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
                static_cast<float>(map(j, i) * factor);
}

/// The momentum of a change of the motion of a body in `bodies`.
[[gnu::always_inline]] inline Twelve momentum_of(const ColouredIslands& coloured, std::size_t body,
                                                 const Twelve& change) {
    // Of its last two, the inverse mass and inertia.
    const Float4 rest = simd::same_bits<Float4>(coloured.changes[body].rest);
    const Float4 inverse = rest > 0 ? 1 / rest : Float4{};
    const Float4 mass = __builtin_shufflevector(inverse, inverse, 2, 2, 2, 2);
    const Float4 inertia = __builtin_shufflevector(inverse, inverse, 3, 3, 3, 3);
    Twelve momentum = {mass * change[0], inertia * change[1], inertia * change[2]};
    if (coloured.turns_unevenly && rest[3] == 0) turn(coloured.inertias[body], change, momentum);
    return momentum;
}

[[gnu::always_inline]] inline Double4 twice_energy_of(const ColouredIslands& coloured,
                                                      std::size_t body, const Twelve& change) {
    return product(change, momentum_of(coloured, body, change));
}

template <class Visit>
void visit_others(const ColouredStage& stage, BatchRange some, const Visit& visit) {
    for (std::uint32_t i = some.begin; i < some.end; ++i)
        visit(stage.step.constraints[stage.step.coloured.others[i]], i);
}

}  // namespace

bool has_conjugates(const Simulation& simulation, BodyId a, BodyId b) {
    const Needs& needs = simulation.needs;
    if (needs.very_rough && friction_of(simulation, a, b) > kMostConjugateFriction) return false;
    return !needs.rolling || rolling_arm_of(simulation, a, b) == 0;
}

BodySums weigh_warm_start(const ColouredStage& stage, Range bodies, double mass_unit) {
    ColouredIslands& coloured = stage.step.coloured;
    Double4 twice_energy{};
    double fallen = 0;
    const double kick_squared = (stage.step.h * stage.simulation.settings.gravity).squaredNorm();
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const BodyId id = coloured.bodies[i];
        const TypeProperties& type = stage.simulation.type_of(id);
        if (coloured.turns_unevenly) {
            if (type.isotropic)
                coloured.inertias[i] = {};
            else
                put_columns(without_specks(world_map(type.inertia, type, stage.step.rotor[id])),
                            1 / mass_unit, coloured.inertias[i]);
        }
        twice_energy += twice_energy_of(coloured, i, load(coloured.changes[i]));
        fallen += 0.5 * std::abs(type.gravity_scale) * type.mass / mass_unit * kick_squared;
    }
    return {0.5 * total_of(twice_energy), fallen};
}

void begin_warm_start_round(const ColouredStage& stage, BatchRange batches, Members some) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i)
        visit_round(coloured, i, begin_at_none(coloured.round[i], some));
}

void begin_warm_start_general(const ColouredStage& stage, BatchRange batches, Members some) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i)
        visit_general(coloured, i, begin_at_none(coloured.general[i], some));
}

void begin_warm_start_others(const ColouredStage& stage, BatchRange some) {
    visit_others(stage, some, [](Constraint& c, std::uint32_t) {
        c.last_impulse.setZero(c.size);
        c.direction.setZero(c.size);
    });
}

void take_warm_start(const ColouredStage& stage, Range bodies) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        store(load(coloured.changes[i]), coloured.warm_start[i]);
        store(Twelve{}, coloured.changes[i]);
    }
}

void begin_directions(const ColouredStage& stage, Range bodies) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        store(load(coloured.changes[i]), coloured.last_changes[i]);
        coloured.direction[i] = {};
    }
}

BodySums weigh_step(const ColouredStage& stage, Range bodies) {
    const ColouredIslands& coloured = stage.step.coloured;
    Double4 of_step{}, of_direction{}, twice_energy{};
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const Twelve start = load(coloured.last_changes[i]), end = load(coloured.changes[i]);
        const Twelve of_start = momentum_of(coloured, i, start);
        of_step += product(end - start, of_start);
        of_direction += product(load(coloured.direction[i]), of_start);
        twice_energy += twice_energy_of(coloured, i, end);
    }
    return {-total_of(of_step), -total_of(of_direction), 0.5 * total_of(twice_energy)};
}

void weigh_round_step(const ColouredStage& stage, BatchRange batches) {
    ColouredIslands& coloured = stage.step.coloured;
    const auto& [normal, tangent] = coloured.round_impulses;
    const RowImpulses<4>& last = coloured.last_round;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        Work work;
        work.add(normal[i], last.normal[i], -kAll.load(coloured.round_rows[i].along.target));
        if (coloured.friction)
            for (std::size_t k = 0; k < 4; ++k)
                work.add(tangent[i][k], last.tangent[i][k],
                         kAll.load(coloured.round_friction[i].slip[k]));
        if (stage.shares_batches)
            coloured.round_lane_work[i] = work.of_lanes();
        else
            coloured.round_work[i] = work.sums();
    }
}

void weigh_general_step(const ColouredStage& stage, BatchRange batches) {
    ColouredIslands& coloured = stage.step.coloured;
    if (stage.shares_batches)
        for (std::uint32_t i = batches.begin; i < batches.end; ++i)
            coloured.general_lane_work[i] = work_of_general(coloured, i).of_lanes();
    else
        for (std::uint32_t i = batches.begin; i < batches.end; ++i)
            coloured.general_work[i] = work_of_general(coloured, i).sums();
}

void weigh_others_step(const ColouredStage& stage, BatchRange some) {
    visit_others(stage, some, [&](const Constraint& c, std::uint32_t i) {
        const double unit = 1 / stage.mass_unit(0);
        stage.step.coloured.others_work[i] = {unit * (c.impulse - c.last_impulse).dot(c.aim),
                                              -unit * c.impulse.dot(c.aim)};
    });
}

BodySums find_direction(const ColouredStage& stage, Range bodies, float carried) {
    ColouredIslands& coloured = stage.step.coloured;
    Double4 twice_energy{};
    double fastest = 0;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const Twelve step = load(coloured.changes[i]) - load(coloured.last_changes[i]);
        const Twelve along = step + carried * load(coloured.direction[i]);
        store(along, coloured.direction[i]);
        twice_energy += twice_energy_of(coloured, i, along);
        fastest = std::max(fastest, total_of(in_double(along[0] * along[0])));
    }
    return {total_of(twice_energy), fastest};
}

void go_along(const ColouredStage& stage, Range bodies, float length) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const Twelve here = load(coloured.last_changes[i]) + length * load(coloured.direction[i]);
        store(here, coloured.changes[i]);
        store(here, coloured.last_changes[i]);
    }
}

void go_along_round(const ColouredStage& stage, BatchRange batches, const DirectionSteps& steps) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i)
        if ((coloured.round[i].members & steps.along).any())
            visit_round(coloured, i, go_or_stay(coloured.round[i], steps));
        else
            visit_round(coloured, i, stay);
}

void go_along_general(const ColouredStage& stage, BatchRange batches, const DirectionSteps& steps) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i)
        if ((coloured.general[i].members & steps.along).any())
            visit_general(coloured, i, go_or_stay(coloured.general[i], steps));
        else
            visit_general(coloured, i, stay);
}

void go_along_others(const ColouredStage& stage, BatchRange some, const DirectionSteps& steps) {
    visit_others(stage, some, [&](Constraint& c, std::uint32_t) {
        if (steps.along.any()) {
            c.direction = (c.impulse - c.last_impulse) + steps.carried[0] * c.direction;
            c.impulse = c.last_impulse + steps.length[0] * c.direction;
        } else {
            c.direction.setZero(c.size);
        }
        c.last_impulse = c.impulse;
    });
}

}  // namespace tesserae
