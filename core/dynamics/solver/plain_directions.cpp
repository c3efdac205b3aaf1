// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/plain_directions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dynamics/bodies/type_properties.hpp"

namespace tesserae {
namespace {

/// The relative change that counts as rounding: directions would grow from it.
constexpr double kDoubleStep = 16 * std::numeric_limits<double>::epsilon();

/// The velocity at a row of those of its bodies that do not move, b's relative to a's.
Vec4 velocity_of_fixed(const Simulation& simulation, const StepData& step, const ContactRow& row) {
    const auto velocity = [&](BodyId id, const Vec4& r) -> Vec4 {
        if (simulation.is_movable(id)) return Vec4::Zero();
        return step.velocity[id] + velocity_at(step.angular_velocity[id], r);
    };
    return velocity(row.b, row.r_b) - velocity(row.a, row.r_a);
}

double product(const BodyMotion& a, const BodyMotion& b) {
    return a.velocity.dot(b.velocity) + dot(a.angular_velocity, b.angular_velocity);
}

}  // namespace

PlainDirections::Room& PlainDirections::room() {
    thread_local Room room;
    return room;
}

PlainDirections::PlainDirections(const Simulation& simulation, StepData& step,
                                 std::span<ContactRow> rows, std::span<const BodyId> bodies,
                                 Pass pass)
    : simulation_(simulation),
      step_(step),
      rows_(rows),
      bodies_(bodies),
      room_(room()),
      pass_(pass) {
    room_.rows.resize(rows.size());
    room_.bodies.resize(bodies.size());
}

BodyMotion PlainDirections::momentum_of(BodyId id, const BodyMotion& motion) const {
    const TypeProperties& type = simulation_.type_of(id);
    BodyMotion momentum;
    if (type.inverse_mass > 0) momentum.velocity = type.mass * motion.velocity;
    if (simulation_.needs.turning && !(type.inverse_inertia == Bivector{}))
        momentum.angular_velocity =
            angular_momentum(type, step_.rotor[id], motion.angular_velocity);
    return momentum;
}

void PlainDirections::begin(Members some) {
    if (!some.any()) return;
    begun_ = begun_ | some;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const ContactRow& row = rows_[i];
        const ContactTargets& targets = row.targets;
        const Vec4 fixed = velocity_of_fixed(simulation_, step_, row);
        room_.rows[i].normal_aim =
            (pass_ == Pass::kRestitution ? targets.second : targets.first) - row.normal.dot(fixed);
        room_.rows[i].tangent_aim = -(row.slip_by_turning + fixed);
    }
    start_anew();
    double energy = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        BodyState& state = room_.bodies[i];
        state.of_last = momentum_of(bodies_[i], state.last);
        energy += 0.5 * product(state.last, state.of_last);
    }
    of_ = IslandDirections(energy, kDoubleStep);
}

/// Starts the next pair of sweeps where the last one ended, without a direction.
void PlainDirections::start_anew() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        RowState& state = room_.rows[i];
        state.last_normal = rows_[i].normal_impulse, state.last_tangent = rows_[i].tangent_impulse;
        state.normal_direction = 0, state.tangent_direction.setZero();
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        BodyState& state = room_.bodies[i];
        state.last = motion_of(step_, bodies_[i]);
        state.direction = state.of_direction = {};
    }
}

/// Weighs a pair of sweeps, as weigh_general_step() does.
IslandDirections::RowSums PlainDirections::weigh_rows() const {
    IslandDirections::RowSums sums;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const ContactRow& row = rows_[i];
        const RowState& state = room_.rows[i];
        sums.of_step += (row.normal_impulse - state.last_normal) * state.normal_aim +
                        (row.tangent_impulse - state.last_tangent).dot(state.tangent_aim);
        sums.of_all -=
            row.normal_impulse * state.normal_aim + row.tangent_impulse.dot(state.tangent_aim);
    }
    return sums;
}

/// The same as weigh_step().
BodySums PlainDirections::weigh_bodies() {
    BodySums sums = {};
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        BodyState& state = room_.bodies[i];
        const BodyMotion now = motion_of(step_, bodies_[i]);
        state.step = now - state.last, state.of_step = momentum_of(bodies_[i], state.step);
        sums[0] -= product(state.step, state.of_last);
        sums[1] -= product(state.direction, state.of_last);
        sums[2] += 0.5 * product(now, state.of_last + state.of_step);
    }
    return sums;
}

/// Returns how long the next step may be, along directions that carry so much of the last ones. It
/// ends where the first contact opens: beyond, the energy is no longer that of the impulses that
/// contacts may have. It is 0 if some contact has all the friction that its normal impulse allows.
double PlainDirections::longest_step(double carried) const {
    constexpr double kNearly = 1 - 1e-12, kRoundedDown = 1 - 1e-7;  // to a float
    double longest = kLongestStep;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const ContactRow& row = rows_[i];
        const RowState& state = room_.rows[i];
        const double most = row.friction * row.normal_impulse;
        if (most > 0 && row.tangent_impulse.squaredNorm() > kNearly * most * most) return 0;
        const double direction =
            row.normal_impulse - state.last_normal + carried * state.normal_direction;
        if (direction < 0) longest = std::min(longest, state.last_normal / -direction);
    }
    return kRoundedDown * longest;
}

PerMember<double> PlainDirections::find(Members some) {
    PerMember<double> largest;
    if (!some.any()) return largest;
    of_.weigh(weigh_bodies(), weigh_rows());
    const double carried = of_.carried();
    double twice_energy = 0, fastest = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        BodyState& state = room_.bodies[i];
        state.direction = state.step + carried * state.direction;
        state.of_direction = state.of_step + carried * state.of_direction;
        twice_energy += product(state.direction, state.of_direction);
        fastest = std::max(fastest, state.direction.velocity.squaredNorm());
    }
    of_.find_length(twice_energy, longest_step(carried));
    largest[0] = of_.length() * std::sqrt(fastest);
    return largest;
}

void PlainDirections::go_on(Members some) {
    if (!some.any()) return;
    if (!of_.holds()) {
        start_anew();
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            BodyState& state = room_.bodies[i];
            state.of_last = state.of_last + state.of_step;
        }
        return of_.go_on();
    }
    const double carried = of_.carried(), length = of_.length();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        RowState& state = room_.rows[i];
        ContactRow& row = rows_[i];
        state.normal_direction =
            row.normal_impulse - state.last_normal + carried * state.normal_direction;
        state.tangent_direction =
            row.tangent_impulse - state.last_tangent + carried * state.tangent_direction;
        row.normal_impulse = state.last_normal += length * state.normal_direction;
        row.tangent_impulse = state.last_tangent += length * state.tangent_direction;
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        BodyState& state = room_.bodies[i];
        state.last = state.last + length * state.direction;
        state.of_last = state.of_last + length * state.of_direction;
        step_.velocity[bodies_[i]] = state.last.velocity;
        step_.angular_velocity[bodies_[i]] = state.last.angular_velocity;
    }
    of_.go_on();
}

}  // namespace tesserae
