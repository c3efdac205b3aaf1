// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/motion/free_path.hpp"

#include <algorithm>
#include <cmath>

#include "core/contact/find_contacts.hpp"
#include "core/dynamics/motion/free_rotation.hpp"

namespace tesserae {
namespace {

/// Advances of one search at most; a rod of 1 m by 1 mm that whirls beside a wall takes some 50.
constexpr int kAdvances = 1000;

/// Bodies that overlap by more than this part of what is left to the solver may come deeper by the
/// rest of it. More, and what whirls stops where it is; less, and it sinks in.
constexpr double kDeeper = 0.875;

/// How far two paths may come together.
struct GapBounds {
    double touch;    ///< apart by no more than this is touching [m]
    double deepest;  ///< overlap that is left to the solver [m]

    GapBounds(const FreePath& a, const FreePath& b) {
        // Twice the smaller one's: in a thick wall a ball would sink out of sight.
        const double both = 2 * std::min(a.half_size(), b.half_size());
        touch = kTouch * both;
        deepest = kDeepest * both;
    }
};

/// Where a body is seen, and how fast its surface gets farther along a direction.
struct Side {
    FreePath::State now;
    Mat4 rotation;
    const FreePath& path;
    bool moves;

    Side(const FreePath& body, double time)
        : now(body.at(time)), rotation(to_matrix(now.rotor)), path(body), moves(body.moves(time)) {}

    double extent_along(const Vec4& direction) const {
        const Vec4 local = rotation.transpose() * direction;
        return std::visit(
            [&](const auto& shape) { return direction.dot(rotation * support(shape, local)); },
            path.shape());
    }
    double farthest_along(const Vec4& direction) const {
        return direction.dot(now.position) + extent_along(direction);
    }
    Vec4 velocity() const { return moves ? path.velocity() : Vec4(Vec4::Zero()); }
    double spin() const { return moves ? path.spin() : 0; }
    double swing() const { return moves ? path.swing() : 0; }
    /// The largest speed along the direction that turning gives a point of it now [m/s].
    double spin_along(const Vec4& direction) const {
        if (spin() == 0) return 0;
        const Vec4 slope = -velocity_at(now.angular_velocity, direction);
        return slope.isZero(0) ? 0 : std::min(extent_along(slope), spin());
    }
};

/// Two bodies at one time of their paths.
struct Gap {
    double value = kNoImpact;  ///< [m]; kNoImpact if they cannot meet in the rest of the half
    double closing = 0;        ///< at most, at any later time [m/s]
    double closing_now = 0;    ///< at most, now [m/s]
    double swing = 0;          ///< at most, by which that can grow [m/s^2]

    /// How long it takes at least until the gap is so small [s].
    double time_to(double smaller) const {
        const double way = value - smaller;
        if (!(way > 0)) return 0;
        const double slowly = closing > 0 ? way / closing : kNoImpact;
        const double root = std::sqrt(closing_now * closing_now + 2 * swing * way);
        const double now = closing_now > 0 ? 2 * way / (closing_now + root)
                           : swing > 0     ? (root - closing_now) / swing
                                           : kNoImpact;
        return std::max(slowly, now);
    }
};

Gap gap_at(const FreePath& a, const FreePath& b, double time, double margin,
           std::vector<Contact>& scratch) {
    const Side first(a, time), second(b, time);
    const Vec4 relative = first.velocity() - second.velocity();
    const double turning = first.spin() + second.spin();
    const double way = (a.duration() - time) * (relative.norm() + turning);
    scratch.clear();
    find_contacts(a.id(), a.shape(), {first.now.position, first.now.rotor}, b.id(), b.shape(),
                  {second.now.position, second.now.rotor}, way + margin, scratch);
    Gap gap;
    if (scratch.empty()) return gap;
    const Vec4 normal =
        std::min_element(scratch.begin(), scratch.end(), [](const Contact& c, const Contact& d) {
            return c.separation < d.separation;
        })->normal;
    gap.value = -second.farthest_along(-normal) - first.farthest_along(normal);
    const double towards = normal.dot(relative);
    gap.closing = towards + turning;
    gap.closing_now = towards + first.spin_along(normal) + second.spin_along(-normal);
    gap.swing = first.swing() + second.swing();
    return gap;
}

}  // namespace

FreePath::FreePath(const Simulation& simulation, const StepData& step, BodyId id)
    : id_(id),
      shape_(&simulation.bodies.type_of(id).shape),
      type_(&simulation.type_of(id)),
      integrator_(simulation.settings.integrator),
      duration_(0.5 * step.h),
      velocity_(type_->bounded ? step.velocity[id] : Vec4(Vec4::Zero())),
      start_{step.position[id] - duration_ * velocity_, step.rotor[id], {}} {
    if (!type_->bounded || !simulation.needs.turning) return;
    Bivector reversed = -step.angular_velocity[id];
    turn_freely(*type_, integrator_, duration_, start_.rotor, reversed);
    start_.angular_velocity = -reversed;
    bound_turning();
}

/// Where the angular velocity wanders, its energy bounds each of its components along principal
/// axes, |omega_ij| <= sqrt(2E/I_ij), and with them the speed of a point at r, v_i = sum omega_ij
/// r_j.
void FreePath::bound_turning() {
    const Bivector& omega = start_.angular_velocity;
    if (type_->arm == 0 || omega == Bivector{}) return;
    if (type_->isotropic) {
        spin_ = type_->arm * norm(omega);
        swing_ = norm(omega) * spin_;
        return;
    }
    const Bivector& I = type_->inertia;
    const double root =
        std::sqrt(std::max(0.0, dot(omega, angular_momentum(*type_, start_.rotor, omega))));
    const Bivector most{root / std::sqrt(I.xy), root / std::sqrt(I.xz), root / std::sqrt(I.xw),
                        root / std::sqrt(I.yz), root / std::sqrt(I.yw), root / std::sqrt(I.zw)};
    const Mat4 to_principal = to_matrix(reverse(type_->axes));
    const Vec4 r =
        std::visit([&](const auto& shape) { return half_extents(shape, to_principal); }, *shape_);
    const Vec4 v{most.xy * r[1] + most.xz * r[2] + most.xw * r[3],
                 most.xy * r[0] + most.yz * r[2] + most.yw * r[3],
                 most.xz * r[0] + most.yz * r[1] + most.zw * r[3],
                 most.xw * r[0] + most.yw * r[1] + most.zw * r[2]};
    const double fastest = std::max({most.xy, most.xz, most.xw, most.yz, most.yw, most.zw});
    spin_ = std::min(v.norm(), type_->arm * fastest);
    // omega x v, and the turning of omega itself, which is no faster in either of its two planes.
    swing_ = 3 * fastest * spin_;
}

FreePath::State FreePath::at(double time) const {
    State state = start_;
    const double moved = std::min(time, stop_);
    state.position += moved * velocity_;
    turn_freely(*type_, integrator_, moved, state.rotor, state.angular_velocity);
    return state;
}

double impact_time(const FreePath& a, const FreePath& b, double from,
                   std::vector<Contact>& scratch) {
    const GapBounds bounds(a, b);
    const double end = a.duration();
    const auto is_moving = [&](const FreePath& path) { return path.moves(from); };
    if (!is_moving(a) && !is_moving(b)) return kNoImpact;
    const Vec4 relative = (is_moving(a) ? a.velocity() : Vec4(Vec4::Zero())) -
                          (is_moving(b) ? b.velocity() : Vec4(Vec4::Zero()));
    const double speed =
        relative.norm() + (is_moving(a) ? a.spin() : 0) + (is_moving(b) ? b.spin() : 0);
    if (!((end - from) * speed > bounds.deepest)) return kNoImpact;

    // Would they overlap too much, and when were they surely not yet touching?
    Gap gap = gap_at(a, b, from, bounds.touch, scratch);
    if (gap.value == kNoImpact) return kNoImpact;
    const double touching = gap.value > bounds.touch ? bounds.touch : gap.value - bounds.touch;
    const double deep = std::min(0.0, gap.value + kDeeper * bounds.deepest) - bounds.deepest;
    double time = from, clear = from;
    for (int i = 0; i < kAdvances && gap.value > deep + bounds.touch; ++i) {
        if (gap.value > touching) clear = time;
        time += gap.time_to(deep);
        if (!(time < end)) return kNoImpact;
        gap = gap_at(a, b, time, bounds.touch, scratch);
        if (gap.value == kNoImpact) return kNoImpact;
    }

    // Then where they first touch.
    const double too_late = time;
    time = clear;
    for (int i = 0; i < kAdvances; ++i) {
        gap = gap_at(a, b, time, bounds.touch, scratch);
        if (gap.value <= touching) break;
        time += gap.time_to(touching - 0.5 * bounds.touch);
        if (!(time < too_late)) return clear;
    }
    return time;
}

}  // namespace tesserae
