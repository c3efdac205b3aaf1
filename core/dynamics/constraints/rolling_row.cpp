// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/rolling_row.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "core/dynamics/constraints/contact_row.hpp"

namespace tesserae {
namespace {

/// A bivector B has the part n ^ t that contains the unit normal n and the part dual(n ^ s) that
/// does not. Both are as long as their tangents t and s.
struct Rolling {
    static Vec4 tangent(const Bivector& b, const Vec4& n) { return velocity_at(b, n); }
    static Bivector bivector(const Vec4& t, const Vec4& n) { return wedge(n, t); }
};
struct Twisting {
    static Vec4 tangent(const Bivector& b, const Vec4& n) { return velocity_at(dual(b), n); }
    static Bivector bivector(const Vec4& s, const Vec4& n) { return dual(wedge(n, s)); }
};

template <class Part>
void set_part_masses(const Simulation& simulation, const StepData& step, const ContactRow& contact,
                     RollingPart& part) {
    const Vec4& n = contact.normal;
    const Mat4 P = Mat4::Identity() - n * n.transpose();
    Mat4 K;
    for (int i = 0; i < 4; ++i) {
        const Bivector impulse = Part::bivector(P.col(i), n);
        K.col(i) = Part::tangent(angular_response(simulation, step, contact.a, impulse) +
                                     angular_response(simulation, step, contact.b, impulse),
                                 n);
    }
    // Bodies whose rotations are fixed have no response at all, all others a full one.
    const double scale = K.trace() / 3;
    part.mass.setZero();
    part.step_mass = 0;
    if (!(scale > 0)) return;
    part.mass = P * (K + scale * n * n.transpose()).inverse();
    part.step_mass = 1 / K.norm();
}

template <class Part>
void solve_part(const Simulation& simulation, StepData& step, const ContactRow& contact,
                double most, RollingPart& part) {
    const Vec4 turning = Part::tangent(
        step.angular_velocity[contact.b] - step.angular_velocity[contact.a], contact.normal);
    Vec4 impulse = part.impulse - part.mass * turning;
    if (impulse.squaredNorm() > most * most)
        impulse = clamped_to_ball(part.impulse - part.step_mass * turning, most);
    const Vec4 change = impulse - part.impulse;
    part.impulse = impulse;
    apply_angular_impulse(simulation, step, contact.a, contact.b,
                          Part::bivector(change, contact.normal));
}

}  // namespace

double rolling_arm_of(const Simulation& simulation, BodyId a, BodyId b) {
    const TypeProperties &type_a = simulation.type_of(a), &type_b = simulation.type_of(b);
    if (type_a.friction == 0 || type_b.friction == 0) return 0;
    return std::max(type_a.rolling_friction, type_b.rolling_friction);
}

RollingRow make_rolling_row(const Simulation& simulation, const StepData& step,
                            const ContactRow& contact) {
    RollingRow row;
    row.arm = rolling_arm_of(simulation, contact.a, contact.b);
    if (row.arm == 0) return row;
    set_part_masses<Rolling>(simulation, step, contact, row.rolling);
    set_part_masses<Twisting>(simulation, step, contact, row.twisting);
    return row;
}

void start_rolling_row(const ContactRow& contact, const Bivector& impulse, RollingRow& row) {
    const double most = row.arm * contact.normal_impulse;
    row.rolling.impulse = clamped_to_ball(Rolling::tangent(impulse, contact.normal), most);
    row.twisting.impulse = clamped_to_ball(Twisting::tangent(impulse, contact.normal), most);
}

void solve_rolling_row(const Simulation& simulation, StepData& step, const ContactRow& contact,
                       RollingRow& row) {
    if (row.arm == 0) return;
    const double most = row.arm * contact.normal_impulse;
    solve_part<Rolling>(simulation, step, contact, most, row.rolling);
    solve_part<Twisting>(simulation, step, contact, most, row.twisting);
}

void apply_angular_impulse(const Simulation& simulation, StepData& step, BodyId a, BodyId b,
                           const Bivector& impulse) {
    if (simulation.type_of(a).movable)
        step.angular_velocity[a] += angular_response(simulation, step, a, -impulse);
    if (simulation.type_of(b).movable)
        step.angular_velocity[b] += angular_response(simulation, step, b, impulse);
}

Bivector angular_impulse_of(const ContactRow& contact, const RollingRow& row) {
    return Rolling::bivector(row.rolling.impulse, contact.normal) +
           Twisting::bivector(row.twisting.impulse, contact.normal);
}

}  // namespace tesserae
