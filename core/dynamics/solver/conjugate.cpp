#include "core/dynamics/solver/conjugate.hpp"

#include <algorithm>
#include <cmath>

#include "core/dynamics/solver/coloured_place.hpp"

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
auto begin(std::vector<Eight>& last, std::vector<Eight>& direction) {
    return [&](const Eight& impulse, std::size_t place) {
        last[place] = impulse;
        direction[place] = {};
    };
}
/// Eight impulses go from where they were along the new direction.
auto go(std::vector<Eight>& last, std::vector<Eight>& direction, float carried, float length) {
    return [&, carried, length](Eight& impulse, std::size_t place) {
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

/// What contacts change of a body's motion, so weighted that products are of energies.
WeightedMotion weighted(const ColouredStage& stage, BodyId id, const BodyMotion& motion) {
    const TypeProperties& type = stage.simulation.type_of(id);
    const double per_mass_unit = 1 / stage.mass_unit;
    const auto root = [&](double inverse) {
        return inverse > 0 ? std::sqrt(per_mass_unit / inverse) : 0;
    };
    WeightedMotion all{};
    for (int i = 0; i < 4; ++i)
        all[static_cast<std::size_t>(i)] =
            static_cast<float>(root(type.inverse_mass) * motion.velocity[i]);
    if (!stage.simulation.needs.turning) return all;
    Bivector w = motion.angular_velocity;
    if (!type.isotropic) w = rotate(reverse(principal_rotor(type, stage.step.rotor[id])), w);
    const Bivector& inverse = type.inverse_inertia;
    all[4] = static_cast<float>(root(inverse.xy) * w.xy);
    all[5] = static_cast<float>(root(inverse.xz) * w.xz);
    all[6] = static_cast<float>(root(inverse.xw) * w.xw);
    all[7] = static_cast<float>(root(inverse.yz) * w.yz);
    all[8] = static_cast<float>(root(inverse.yw) * w.yw);
    all[9] = static_cast<float>(root(inverse.zw) * w.zw);
    return all;
}

double product(const WeightedMotion& a, const WeightedMotion& b) {
    float sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

/// Calls visit(float of each record...) for a body's velocity and for what it turns by.
template <class Visit, class... Record>
void visit_motion(const Visit& visit, Record&... records) {
    for (std::size_t i = 0; i < 4; ++i) visit(records.velocity[i]...);
    for (std::size_t i = 0; i < 4; ++i) visit(records.first_planes[i]...);
    for (std::size_t i = 0; i < 2; ++i) visit(records.rest[i]...);
}

BodyMotion difference(const BodyChange& a, const BodyChange& b) {
    const auto part = [](const auto& x, const auto& y, std::size_t i) {
        return double{x[i] - y[i]};
    };
    const auto &v = a.velocity, &u = b.velocity, &w = a.first_planes, &t = b.first_planes;
    return {assembled(part(v, u, 0), part(v, u, 1), part(v, u, 2), part(v, u, 3)),
            {part(w, t, 0), part(w, t, 1), part(w, t, 2), part(w, t, 3), part(a.rest, b.rest, 0),
             part(a.rest, b.rest, 1)}};
}

}  // namespace

bool has_conjugates(const Simulation& simulation) {
    return simulation.settings.solver == Solver::kImpulse &&
           std::all_of(
               simulation.types.begin(), simulation.types.end(), [](const TypeProperties& type) {
                   return type.friction <= kMostConjugateFriction && type.rolling_friction == 0;
               });
}

void begin_weights(const ColouredStage& stage, Range bodies) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i)
        coloured.weighted_motion[i] =
            weighted(stage, coloured.bodies[i], difference(coloured.changes[i], BodyChange{}));
}

void begin_directions(const ColouredStage& stage, Range bodies) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        coloured.last_changes[i] = coloured.changes[i];
        coloured.direction[i] = {};
        coloured.weighted_direction[i] = {};
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
        const WeightedMotion& motion = coloured.weighted_motion[i];
        coloured.weighted_step[i] = weighted(
            stage, coloured.bodies[i], difference(coloured.changes[i], coloured.last_changes[i]));
        WeightedMotion end;
        for (std::size_t k = 0; k < end.size(); ++k)
            end[k] = motion[k] + coloured.weighted_step[i][k];
        coloured.body_sums[i] = {-product(coloured.weighted_step[i], motion),
                                 -product(coloured.weighted_direction[i], motion),
                                 0.5 * product(end, end)};
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
        BodyChange& direction = coloured.direction[i];
        visit_motion([carried](float& along, float now,
                               float from) { along = (now - from) + carried * along; },
                     direction, coloured.changes[i], coloured.last_changes[i]);
        WeightedMotion& weighted = coloured.weighted_direction[i];
        for (std::size_t k = 0; k < weighted.size(); ++k)
            weighted[k] = coloured.weighted_step[i][k] + carried * weighted[k];
        double squared_speed = 0;
        for (const float v : direction.velocity) squared_speed += double{v} * v;
        coloured.body_sums[i] = {product(weighted, weighted), squared_speed, 0};
    }
}

void go_along(const ColouredStage& stage, Range bodies, float length) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        visit_motion(
            [length](float& now, float& from, float along) { now = from = from + length * along; },
            coloured.changes[i], coloured.last_changes[i], coloured.direction[i]);
        for (std::size_t k = 0; k < coloured.weighted_motion[i].size(); ++k)
            coloured.weighted_motion[i][k] += length * coloured.weighted_direction[i][k];
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
        for (std::size_t k = 0; k < coloured.weighted_motion[i].size(); ++k)
            coloured.weighted_motion[i][k] += coloured.weighted_step[i][k];
    begin_directions(stage, bodies);
}

}  // namespace tesserae
