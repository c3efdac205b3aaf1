// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/contact_row.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/dynamics/constants.hpp"

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

/// Change of the velocity of a point by turning, by a unit impulse there, at most [1/kg].
double greatest_turn(const TypeProperties& type) {
    const Bivector& i = type.inverse_inertia;
    return std::max({i.xy, i.xz, i.xw, i.yz, i.yw, i.zw}) * type.radius * type.radius;
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
    row.normal_mass = along > rounding ? 1 / along : 0;

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

}  // namespace

double friction_of(const Simulation& simulation, BodyId a, BodyId b) {
    return std::sqrt(simulation.type_of(a).friction * simulation.type_of(b).friction);
}

double least_response(const Simulation& simulation, BodyId a, BodyId b) {
    const TypeProperties &type_a = simulation.type_of(a), &type_b = simulation.type_of(b);
    const double moves = type_a.inverse_mass + type_b.inverse_mass;
    return kNoResponse * (moves > 0 ? moves : greatest_turn(type_a) + greatest_turn(type_b));
}

ContactRow make_row(const Simulation& simulation, const StepData& step, const Contact& contact) {
    ContactRow row;
    row.a = contact.a;
    row.b = contact.b;
    row.normal = contact.normal;
    row.r_a = contact.point - step.position[row.a];
    row.r_b = contact.point - step.position[row.b];
    row.friction = friction_of(simulation, row.a, row.b);
    set_masses(simulation, step, row);
    return row;
}

void start_row(const Simulation& simulation, const StepData& step, const Contact& contact,
               std::size_t place, const ContactImpulse& impulse, Cause cause,
               const Parting& parting, ContactRow& row) {
    const Vec4 v =
        relative_velocity(step, row.a, row.r_a, row.b, row.r_b, simulation.needs.turning);
    row.targets = PairTargets(simulation, step, contact, cause, parting)
                      .at(contact.separation, row.normal.dot(v), rise_of(step, place));

    row.slip_by_turning.setZero();
    if (row.friction > 0)
        row.slip_by_turning = slip_by_turning(simulation, step, contact, cause) +
                              slip_on_rim(step, {place, place + 1}, row.normal, v, cause);

    // The normal may have turned since the impulse was.
    row.normal_impulse = impulse.normal;
    const Vec4 last = impulse.tangent();
    const Vec4 tangent = last - row.normal.dot(last) * row.normal;
    row.tangent_impulse = clamped_to_ball(tangent, row.friction * row.normal_impulse);
}

}  // namespace tesserae
