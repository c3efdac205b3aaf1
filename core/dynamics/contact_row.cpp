#include "core/dynamics/contact_row.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace tesserae {
namespace {

/// Below this part of what the bodies' inverse masses allow, a response is rounding: nothing there
/// can move (a sphere whose position is fixed, pushed through its centre).
constexpr double kNoResponse = 1e-9;

/// Change of velocity at an offset r of a body by an impulse there.
Vec4 response(const Simulation& simulation, const StepData& step, BodyId id, const Vec4& r,
              const Vec4& impulse) {
    return simulation.type_of(id).inverse_mass * impulse +
           velocity_at(angular_response(simulation, step, id, wedge(r, impulse)), r);
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
    const double rounding = kNoResponse * (greatest_response(simulation.type_of(row.a)) +
                                           greatest_response(simulation.type_of(row.b)));
    row.normal_response = both(n);
    const double along = n.dot(row.normal_response);
    row.solve.mass = row.relax.mass = along > rounding ? 1 / along : 0;

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
void set_targets(const Simulation& simulation, double h, double s, ContactRow& row) {
    const double slop = std::min(simulation.type_of(row.a).slop, simulation.type_of(row.b).slop);
    if (s > -slop) {
        row.solve.target = row.relax.target = s > 0 ? -s / h : 0;
        return;
    }
    const double depth = -(s + slop);
    const double fastest = kLargestPush / kSlop * slop + h * simulation.settings.gravity.norm();
    if (simulation.settings.solver == Solver::kImpulse) {
        row.solve.target = std::min(fastest, kBiasPart / h * depth);
        return;
    }
    // A spring of angular frequency w, integrated implicitly. Its velocity acts on the second half
    // of the sub-step only, so that it has to be twice as large.
    constexpr double kAngle = 2 * std::numbers::pi * kSpringCycles;  // w h
    constexpr double kSum = 2 * kSpringDamping + kAngle, kStiff = kAngle * kSum;
    row.solve.target = std::min(fastest, 2 * kAngle / kSum / h * depth);
    row.solve.mass *= kStiff / (1 + kStiff);
    row.solve.keep = kStiff / (1 + kStiff);
}

/// Restitution, where the bodies meet fast enough: the larger of the two targets, rigid.
void add_rebound(const Simulation& simulation, const StepData& step, double s, ContactRow& row) {
    const TypeProperties& a = simulation.type_of(row.a);
    const TypeProperties& b = simulation.type_of(row.b);
    const double e = std::max(a.restitution, b.restitution), h = step.h;
    if (e == 0) return;
    const Vec4& gravity = simulation.settings.gravity;
    const double slowest = a.falls || b.falls ? kRestitutionKicks * h * gravity.norm() : 0;
    const double g = (a.falls - b.falls) * row.normal.dot(gravity);
    const double v1 = -row.normal.dot(relative_velocity(step, row)), v0 = v1 - h * g;
    if (s > h * v1) {
        // Do not meet in this sub-step unless another contact drives them together. Stopping them
        // at each other's surface would lose that energy: they may overlap, by half of the smaller
        // one at most, and bounce in the next sub-step.
        const double half_size = std::min(a.slop, b.slop) / kSlop;
        row.solve.target = row.relax.target = -(s + 0.5 * half_size) / h;
        return;
    }
    if (!(v0 > slowest)) return;
    const double rebound = rebound_velocity(e, v0, g, s, h);
    row.relax.target = std::max(row.relax.target, rebound);
    if (rebound > row.solve.target) row.solve = row.relax;
}

}  // namespace

ContactRow make_row(const Simulation& simulation, const StepData& step, const Contact& contact,
                    const ContactImpulse& impulse) {
    ContactRow row;
    row.a = contact.a;
    row.b = contact.b;
    row.normal = contact.normal;
    row.r_a = contact.point - step.position[row.a];
    row.r_b = contact.point - step.position[row.b];
    row.friction =
        std::sqrt(simulation.type_of(row.a).friction * simulation.type_of(row.b).friction);
    set_masses(simulation, step, row);
    set_targets(simulation, step.h, contact.separation, row);
    add_rebound(simulation, step, contact.separation, row);

    // The normal may have turned since the impulse was.
    row.normal_impulse = impulse.normal;
    const Vec4 tangent = impulse.tangent - row.normal.dot(impulse.tangent) * row.normal;
    row.tangent_impulse = clamped_to_ball(tangent, row.friction * row.normal_impulse);
    return row;
}

}  // namespace tesserae
