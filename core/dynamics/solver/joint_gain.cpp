// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/joint_gain.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/dynamics/solver/impact.hpp"

namespace tesserae {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;

Vec6 six_of(const Bivector& b) {
    Vec6 six;
    six << b.xy, b.xz, b.xw, b.yz, b.yw, b.zw;
    return six;
}

Bivector bivector_of(const Vec6& six) { return {six[0], six[1], six[2], six[3], six[4], six[5]}; }

}  // namespace

struct JointGain::Frame {
    Vec4 centre = Vec4::Zero();
    BodyMotion motion;

    BodyMotion at(const Vec4& place) const {
        return {motion.velocity + velocity_at(motion.angular_velocity, place - centre),
                motion.angular_velocity};
    }
};

void JointGain::begin(const Simulation& simulation, const StepData& step,
                      std::span<const BodyId> bodies, Cause cause) {
    has_given_ = false;
    moved_.clear();
    groups_.clear();
    for (const BodyId id : bodies) {
        const double part = cause == Cause::kLoad ? simulation.type_of(id).gravity_scale : 0;
        const BodyMotion by_gravity = {part * step.h * simulation.settings.gravity, {}};
        moved_.push_back(
            {simulation.joints.group[id], id, motion_of(step, id) - by_gravity, by_gravity, {}});
        groups_.push_back(moved_.back().group);
    }
    std::sort(groups_.begin(), groups_.end());
    groups_.erase(std::unique(groups_.begin(), groups_.end()), groups_.end());
}

void JointGain::add(std::size_t place, const BodyMotion& motion) {
    has_given_ = true;
    moved_[place].given = moved_[place].given + motion;
}

template <class Visit>
void JointGain::for_all_in(BodyId group, const Visit& visit) const {
    for (const Moved& moved : moved_)
        if (moved.group == group) visit(moved);
}

/// The mean of its motions before the load and now.
BodyMotion JointGain::mean_of(const StepData& step, BodyId id) const {
    if (id == kWorld) return {};
    const auto moved = std::lower_bound(moved_.begin(), moved_.end(), id,
                                        [](const Moved& m, BodyId body) { return m.body < body; });
    const BodyMotion now = motion_of(step, id);
    return moved == moved_.end() || moved->body != id ? now : 0.5 * (moved->before + now);
}

/// The work of what holds the bodies of a group, but no more than what they have gained beside the
/// frame's centre: contacts against which joints press take it away [J]. What an impulse does is
/// itself times the mean velocity of its row.
double JointGain::gain_of(const Simulation& simulation, const StepData& step,
                          std::span<const std::uint32_t> constraints, BodyId group,
                          const Frame& frame) const {
    double work = 0, gained = 0;
    for (const std::uint32_t i : constraints) {
        const Constraint& c = step.constraints[i];
        const BodyId movable = simulation.is_movable(c.b) ? c.b : c.a;
        if (!c.is_firm() || simulation.joints.group[movable] != group) continue;
        work += c.impulse.dot(row_velocities(c, mean_of(step, c.a), mean_of(step, c.b)));
    }
    for_all_in(group, [&](const Moved& m) {
        const BodyMotion mean = mean_of(step, m.body);
        const BodyMotion change = motion_of(step, m.body) - m.before - m.by_gravity;
        work += motion_product(simulation, step, m.body, m.given, mean);
        const BodyMotion relative = {mean.velocity - frame.motion.velocity, mean.angular_velocity};
        gained += motion_product(simulation, step, m.body, change, relative);
    });
    return std::min(work, gained);
}

/// Of the first fixed body that holds some of the group; none if nothing does.
std::optional<JointGain::Frame> JointGain::frame_of_holder(
    const Simulation& simulation, const StepData& step, std::span<const std::uint32_t> constraints,
    BodyId group) const {
    for (const std::uint32_t i : constraints) {
        const Constraint& c = step.constraints[i];
        const bool a_moves = simulation.is_movable(c.a), b_moves = simulation.is_movable(c.b);
        if ((a_moves && b_moves) || simulation.joints.group[a_moves ? c.a : c.b] != group) continue;
        const BodyId holder = a_moves ? c.b : c.a;
        return holder == kWorld ? Frame() : Frame{step.position[holder], motion_of(step, holder)};
    }
    bool is_held = false;
    for_all_in(group, [&](const Moved& m) { is_held |= simulation.type_of(m.body).fixed; });
    return is_held ? std::optional(Frame()) : std::nullopt;
}

/// The motion as one rigid body that has the momentum and the angular momentum of some motions of
/// the group's bodies.
template <class MotionOf>
JointGain::Frame JointGain::frame_of(const Simulation& simulation, const StepData& step,
                                     BodyId group, const MotionOf& motion_of_one) const {
    double mass = 0;
    Frame frame;
    for_all_in(group, [&](const Moved& m) {
        const double own = simulation.type_of(m.body).mass;
        mass += own;
        frame.centre += own * step.position[m.body];
        frame.motion.velocity += own * motion_of_one(m).velocity;
    });
    frame.centre /= mass;
    frame.motion.velocity /= mass;
    Vec6 momentum = Vec6::Zero();
    Eigen::Matrix<double, 6, 6> inertia = Eigen::Matrix<double, 6, 6>::Zero();
    for_all_in(group, [&](const Moved& m) {
        const TypeProperties& type = simulation.type_of(m.body);
        const Vec4 r = step.position[m.body] - frame.centre;
        const auto momentum_of = [&](const Vec4& velocity, const Bivector& omega) {
            return six_of(wedge(r, type.mass * velocity) +
                          angular_momentum(type, step.rotor[m.body], omega));
        };
        const BodyMotion motion = motion_of_one(m);
        momentum += momentum_of(motion.velocity, motion.angular_velocity);
        for (int plane = 0; plane < 6; ++plane) {
            const Bivector unit = bivector_of(Vec6::Unit(plane));
            inertia.col(plane) += momentum_of(velocity_at(unit, r), unit);
        }
    });
    frame.motion.angular_velocity = bivector_of(inertia.ldlt().solve(momentum));
    return frame;
}

/// From what add() counted, and counts it.
void JointGain::turn_back(const Simulation& simulation, StepData& step, BodyId group) {
    const auto given = [](const Moved& m) { return m.given; };
    const Frame frame = frame_of(simulation, step, group, given);
    for (Moved& moved : moved_) {
        if (moved.group != group) continue;
        const BodyMotion turning = frame.at(step.position[moved.body]);
        step.velocity[moved.body] -= turning.velocity;
        step.angular_velocity[moved.body] += -turning.angular_velocity;
        moved.given = moved.given - turning;
    }
}

/// Relative to the frame.
void JointGain::slow_down(const Simulation& simulation, StepData& step, BodyId group,
                          const Frame& frame, double gain) const {
    const auto relative = [&](BodyId id) {
        return motion_of(step, id) - frame.at(step.position[id]);
    };
    double energy = 0;
    for_all_in(group, [&](const Moved& m) {
        energy += 0.5 * twice_kinetic_energy(simulation, step, m.body, relative(m.body));
    });
    const double left = energy > gain ? std::sqrt(1 - gain / energy) : 0;
    for_all_in(group, [&](const Moved& m) {
        const BodyMotion change = (left - 1) * relative(m.body);
        step.velocity[m.body] += change.velocity;
        step.angular_velocity[m.body] += change.angular_velocity;
    });
}

void JointGain::give_momentum_back(const Simulation& simulation, StepData& step,
                                   std::span<const std::uint32_t> constraints) {
    if (!has_given_) return;
    for (const BodyId group : groups_)
        if (!frame_of_holder(simulation, step, constraints, group))
            turn_back(simulation, step, group);
}

void JointGain::give_energy_back(const Simulation& simulation, StepData& step,
                                 std::span<const std::uint32_t> constraints) const {
    for (const BodyId group : groups_) {
        const std::optional<Frame> holder = frame_of_holder(simulation, step, constraints, group);
        const auto now = [&](const Moved& m) { return motion_of(step, m.body); };
        const Frame frame = holder ? *holder : frame_of(simulation, step, group, now);
        const double gain = gain_of(simulation, step, constraints, group, frame);
        if (gain > 0) slow_down(simulation, step, group, frame, gain);
    }
}

}  // namespace tesserae
