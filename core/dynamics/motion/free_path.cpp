// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/motion/free_path.hpp"

#include <algorithm>
#include <cmath>

#include "core/contact/find_contacts.hpp"
#include "core/dynamics/motion/free_rotation.hpp"

namespace tesserae {
namespace {

/// The angle between waypoints of a body that turns by more in a half [rad].
constexpr double kBetweenWaypoints = 2;

/// Bodies that overlap by more than this part of what is left to the solver may come deeper by the
/// rest of it. More, and what whirls stops where it is; less, and it sinks in.
constexpr double kDeeper = 0.875;

/// More than rounding adds to places along a path, as a part of its length.
constexpr double kFarRounding = 1e-14;

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
    double turns_for;  ///< [s]

    Side(const FreePath& body, double time)
        : now(body.at(time)),
          rotation(to_matrix(now.rotor)),
          path(body),
          moves(body.moves(time)),
          turns_for(body.turns_for(time)) {}

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
    double spin() const { return turns_for > 0 ? path.spin() : 0; }
    double swing() const { return turns_for > 0 ? path.swing() : 0; }
    /// How far turning moves a point of it within a time, at most [m].
    double swept(double time) const { return std::min(time, turns_for) * path.spin(); }
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

Gap gap_at(const FreePath& a, const FreePath& b, double time, double margin, ImpactSearch& search) {
    ++search.gaps;
    std::vector<Contact>& scratch = search.contacts;
    const Side first(a, time), second(b, time);
    const Vec4 relative = first.velocity() - second.velocity();
    const double turning = first.spin() + second.spin();
    const double left = a.duration() - time;
    const double way = left * relative.norm() + first.swept(left) + second.swept(left);
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

/// Whether the balls about two bodies touch from a time on.
/// @param relative   velocity of a against b, which stays
bool do_balls_meet(const FreePath& a, const FreePath& b, const Vec4& relative, double from,
                   double touch) {
    const double both = a.radius() + b.radius();
    if (!(both < kNoImpact)) return true;
    const Vec4 x = a.position_at(from), y = b.position_at(from), now = x - y;
    const double left = a.duration() - from, squared = relative.squaredNorm();
    const double nearest = squared > 0 ? std::clamp(-now.dot(relative) / squared, 0.0, left) : 0;
    // Positions far away are rounded.
    const double slack = touch + kFarRounding * (x.norm() + y.norm() + left * relative.norm());
    return !((now + nearest * relative).norm() > both + slack);
}

}  // namespace

FreePath::FreePath(const Simulation& simulation, const StepData& step, BodyId id, double moved,
                   double duration)
    : id_(id),
      shape_(&simulation.bodies.type_of(id).shape),
      type_(&simulation.type_of(id)),
      integrator_(simulation.settings.integrator),
      duration_(duration),
      stop_(moved < duration ? moved : kNever),
      velocity_(type_->bounded ? step.velocity[id] : Vec4(Vec4::Zero())),
      start_{step.position[id] - moved * velocity_, step.rotor[id], {}} {
    if (!type_->bounded || !simulation.needs.turning) return;
    Bivector reversed = -step.angular_velocity[id];
    const double turns_for = turning_time(reversed, moved);
    if (turns_for < duration_) turning_ = turns_for;
    turn_on(*type_, integrator_, turns_for, start_.rotor, reversed);
    start_.angular_velocity = -reversed;
    bound_turning();
    put_waypoints();
}

/// Else the way to each later time would be longer than to the one before.
void FreePath::put_waypoints() {
    const Bivector& omega = start_.angular_velocity;
    const double turns_for = std::min(duration_, turning_), speed = norm(omega);
    if (!(turns_for * speed > kBetweenWaypoints)) return;
    between_ = kBetweenWaypoints / speed;
    State state = start_;
    for (double time = between_; time < turns_for; time += between_) {
        turn_on(*type_, integrator_, between_, state.rotor, state.angular_velocity);
        waypoints_.push_back(state);
    }
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
    const double turned = std::min({time, stop_, turning_});
    const auto passed = std::min(static_cast<std::size_t>(turned / between_), waypoints_.size());
    State state = passed > 0 ? waypoints_[passed - 1] : start_;
    state.position = position_at(time);
    const double since = passed > 0 ? turned - static_cast<double>(passed) * between_ : turned;
    turn_on(*type_, integrator_, since, state.rotor, state.angular_velocity);
    return state;
}

bool may_pass(const FreePath& a, const FreePath& b, double from) {
    const GapBounds bounds(a, b);
    const auto is_moving = [&](const FreePath& path) { return path.moves(from); };
    if (!is_moving(a) && !is_moving(b)) return false;
    const Vec4 relative = (is_moving(a) ? a.velocity() : Vec4(Vec4::Zero())) -
                          (is_moving(b) ? b.velocity() : Vec4(Vec4::Zero()));
    const double speed =
        relative.norm() + (is_moving(a) ? a.spin() : 0) + (is_moving(b) ? b.spin() : 0);
    if (!((a.duration() - from) * speed > bounds.deepest)) return false;
    return do_balls_meet(a, b, relative, from, bounds.touch);
}

double impact_time(const FreePath& a, const FreePath& b, double from, ImpactSearch& search) {
    if (!may_pass(a, b, from)) return kNoImpact;
    if (search.most == 0) return from;
    const GapBounds bounds(a, b);
    const double end = a.duration();

    // Would they overlap too much, and when were they surely not yet touching?
    Gap gap = gap_at(a, b, from, bounds.touch, search);
    if (gap.value == kNoImpact) return kNoImpact;
    const double touching = gap.value > bounds.touch ? bounds.touch : gap.value - bounds.touch;
    const double deep = std::min(0.0, gap.value + kDeeper * bounds.deepest) - bounds.deepest;
    double time = from, clear = from;
    for (std::size_t i = 0; i < search.most && gap.value > deep + bounds.touch; ++i) {
        if (gap.value > touching) clear = time;
        time += gap.time_to(deep);
        if (!(time < end)) return kNoImpact;
        gap = gap_at(a, b, time, bounds.touch, search);
        if (gap.value == kNoImpact) return kNoImpact;
    }

    // Then where they first touch.
    const double too_late = time;
    time = clear;
    for (std::size_t i = 0; i < search.most; ++i) {
        gap = gap_at(a, b, time, bounds.touch, search);
        if (gap.value <= touching) break;
        time += gap.time_to(touching - 0.5 * bounds.touch);
        if (!(time < too_late)) return clear;
    }
    return time;
}

}  // namespace tesserae
