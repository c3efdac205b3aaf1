#include "core/dynamics/solver/contact_row.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace tesserae {
namespace {

constexpr double kNoResponse = 1e-9;

/// Change of velocity at an offset r of a body by an impulse there.
Vec4 response(const Simulation& simulation, const StepData& step, BodyId id, const Vec4& r,
              const Vec4& impulse) {
    const Vec4 moved = simulation.type_of(id).inverse_mass * impulse;
    if (!simulation.needs.turning) return moved;
    return moved + velocity_at(angular_response(simulation, step, id, wedge(r, impulse)), r);
}

double greatest_response(const TypeProperties& type) {
    const Bivector& i = type.inverse_inertia;
    const double turn = std::max({i.xy, i.xz, i.xw, i.yz, i.yw, i.zw});
    return type.inverse_mass + turn * type.radius * type.radius;
}

/// The inverses of the responses of both bodies together, along the normal and across it.
void set_masses(const Simulation& simulation, const StepData& step, ContactRow& row) {
    const auto both = [&](const Vec4& impulse) -> Vec4 {
        return response(simulation, step, row.a, row.r_a, impulse) +
               response(simulation, step, row.b, row.r_b, impulse);
    };
    const Vec4& n = row.normal;
    const double rounding = least_response(simulation, row.a, row.b);
    row.normal_response = both(n);
    const double along = n.dot(row.normal_response);
    row.relax.mass = along > rounding ? 1 / along : 0;

    row.tangent_mass.setZero();
    if (row.friction == 0) return;
    // The tangent block, filled up along the normal so that it can be inverted in world axes.
    const Mat4 P = Mat4::Identity() - n * n.transpose();
    Mat4 K;
    for (int i = 0; i < 4; ++i) K.col(i) = both(P.col(i));
    const Mat4 tangent = P * K;
    const double scale = tangent.trace() / 3;
    if (!(scale > rounding)) return;
    row.tangent_mass = (tangent + scale * n * n.transpose()).inverse();
    row.slide_mass = 1 / tangent.norm();
}

/// The velocity along the normal that leaves the surface at e times the speed v with which the
/// bodies meet there, v^2 = v0^2 + 2 g s0, when they accelerate towards each other at g, approached
/// at v0 with the gap s0 at the start of the sub-step, and are s apart in its middle. The velocity
/// w and the gap s + h w/2 at the end of the sub-step then have the energy of that rebound:
/// w^2 + 2 g (s + h w/2) = e^2 v^2.
double rebound_velocity(double e, double v0, double g, double s, double h) {
    const double s0 = s + 0.5 * h * v0;
    const double at_surface = std::max(0.0, v0 * v0 + 2 * g * s0);
    const double half = 0.5 * g * h;
    return std::sqrt(std::max(0.0, half * half + e * e * at_surface - 2 * g * s)) - half;
}

/// What keeps bodies apart or takes them apart when they are s from touching.
ContactTargets targets_of_overlap(const Simulation& simulation, double h, const Contact& contact) {
    const double s = contact.separation;
    const double slop =
        std::min(simulation.type_of(contact.a).slop, simulation.type_of(contact.b).slop);
    ContactTargets targets;
    if (s > -slop) {
        targets.solve = targets.relax = s > 0 ? -s / h : 0;
        return targets;
    }
    const double depth = -(s + slop);
    const double fastest = kLargestPush / kSlop * slop + h * simulation.settings.gravity.norm();
    if (simulation.settings.solver == Solver::kImpulse) {
        targets.solve = std::min(fastest, kBiasPart / h * depth);
        return targets;
    }
    // A spring of angular frequency w, integrated implicitly. Its velocity acts on the second half
    // of the sub-step only, so that it has to be twice as large.
    constexpr double kAngle = 2 * std::numbers::pi * kSpringCycles;  // w h
    constexpr double kSum = 2 * kSpringDamping + kAngle, kStiff = kAngle * kSum;
    targets.solve = std::min(fastest, 2 * kAngle / kSum / h * depth);
    targets.keep = kStiff / (1 + kStiff);
    return targets;
}

/// Restitution, where the bodies meet fast enough: the larger of the two targets, rigid.
void add_rebound(const Simulation& simulation, double h, const Contact& contact,
                 double normal_velocity, ContactTargets& targets) {
    const TypeProperties& a = simulation.type_of(contact.a);
    const TypeProperties& b = simulation.type_of(contact.b);
    const double e = std::max(a.restitution, b.restitution);
    if (e == 0) return;
    const Vec4& gravity = simulation.settings.gravity;
    const double slowest = a.falls || b.falls ? kRestitutionKicks * h * gravity.norm() : 0;
    const double g = (a.falls - b.falls) * contact.normal.dot(gravity);
    const double s = contact.separation, v1 = -normal_velocity, v0 = v1 - h * g;
    if (s > h * v1) {
        // Do not meet in this sub-step unless another contact drives them together. Stopping them
        // at each other's surface would lose that energy: they may overlap, by half of the smaller
        // one at most, and bounce in the next sub-step.
        const double half_size = std::min(a.slop, b.slop) / kSlop;
        targets.solve = targets.relax = -(s + 0.5 * half_size) / h;
        return;
    }
    if (!(v0 > slowest)) return;
    const double rebound = rebound_velocity(e, v0, g, s, h);
    targets.relax = std::max(targets.relax, rebound);
    if (rebound > targets.solve) targets.solve = targets.relax, targets.keep = 1;
}

}  // namespace

ContactTargets targets_of(const Simulation& simulation, const StepData& step,
                          const Contact& contact, double normal_velocity) {
    ContactTargets targets = targets_of_overlap(simulation, step.h, contact);
    if (simulation.needs.restitution)
        add_rebound(simulation, step.h, contact, normal_velocity, targets);
    return targets;
}

double friction_of(const Simulation& simulation, BodyId a, BodyId b) {
    return std::sqrt(simulation.type_of(a).friction * simulation.type_of(b).friction);
}

double least_response(const Simulation& simulation, BodyId a, BodyId b) {
    return kNoResponse *
           (greatest_response(simulation.type_of(a)) + greatest_response(simulation.type_of(b)));
}

ContactRow make_row(const Simulation& simulation, const StepData& step, const Contact& contact,
                    const ContactImpulse& impulse) {
    ContactRow row;
    row.a = contact.a;
    row.b = contact.b;
    row.normal = contact.normal;
    row.r_a = contact.point - step.position[row.a];
    row.r_b = contact.point - step.position[row.b];
    row.friction = friction_of(simulation, row.a, row.b);
    set_masses(simulation, step, row);
    const Vec4 v =
        relative_velocity(step, row.a, row.r_a, row.b, row.r_b, simulation.needs.turning);
    const ContactTargets targets = targets_of(simulation, step, contact, row.normal.dot(v));
    row.relax.target = targets.relax;
    row.solve = {targets.keep * row.relax.mass, targets.keep, targets.solve};

    // The normal may have turned since the impulse was.
    row.normal_impulse = impulse.normal;
    const Vec4 tangent = impulse.tangent - row.normal.dot(impulse.tangent) * row.normal;
    row.tangent_impulse = clamped_to_ball(tangent, row.friction * row.normal_impulse);
    return row;
}

}  // namespace tesserae
