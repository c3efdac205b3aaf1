#include "core/dynamics/solver.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>

namespace tesserae {
namespace {

/// Below this part of what the bodies' inverse masses allow, a response is rounding: nothing there
/// can move (a sphere whose position is fixed, pushed through its centre).
constexpr double kNoResponse = 1e-9;

/// A body of a row, as the solver reads it.
struct Side {
    const TypeProperties& type;
    const Rotor& rotor;
    const Vec4& r;  ///< from the centre to the contact point

    /// Change of velocity at the contact point by an impulse there.
    Vec4 response(const Vec4& impulse) const {
        return type.inverse_mass * impulse +
               velocity_at(angular_response(type, rotor, wedge(r, impulse)), r);
    }
    double greatest_response() const {
        const Bivector& i = type.inverse_inertia;
        const double turn = std::max({i.xy, i.xz, i.xw, i.yz, i.yw, i.zw});
        return type.inverse_mass + turn * type.radius * type.radius;
    }
};

Vec4 relative_velocity(const ContactRow& row, const std::vector<Vec4>& v,
                       const std::vector<Bivector>& omega) {
    return v[row.b] + velocity_at(omega[row.b], row.r_b) - v[row.a] -
           velocity_at(omega[row.a], row.r_a);
}

void apply_impulse(const Simulation& simulation, StepData& step, BodyId id, const Vec4& r,
                   const Vec4& impulse) {
    const TypeProperties& type = simulation.type_of(id);
    if (!type.movable) return;
    step.velocity[id] += type.inverse_mass * impulse;
    step.angular_velocity[id] += angular_response(type, step.rotor[id], wedge(r, impulse));
}

void apply_impulse(const Simulation& simulation, StepData& step, const ContactRow& row,
                   const Vec4& impulse) {
    apply_impulse(simulation, step, row.a, row.r_a, -impulse);
    apply_impulse(simulation, step, row.b, row.r_b, impulse);
}

/// The nearest impulse that friction allows.
Vec4 clamped_to_ball(const Vec4& impulse, double radius) {
    const double length = impulse.norm();
    return length > radius ? Vec4(radius / length * impulse) : impulse;
}

/// The responses of the two bodies at a contact and their inverses.
void set_masses(const Simulation& simulation, const StepData& step, ContactRow& row) {
    const Side a{simulation.type_of(row.a), step.rotor[row.a], row.r_a};
    const Side b{simulation.type_of(row.b), step.rotor[row.b], row.r_b};
    Mat4 K;
    for (int i = 0; i < 4; ++i) K.col(i) = a.response(Vec4::Unit(i)) + b.response(Vec4::Unit(i));
    const double rounding = kNoResponse * (a.greatest_response() + b.greatest_response());

    const Vec4& n = row.normal;
    const double along = n.dot(K * n);
    row.normal_mass = along > rounding ? 1 / along : 0;

    // The tangent block, filled up along the normal so that it can be inverted in world axes.
    const Mat4 P = Mat4::Identity() - n * n.transpose();
    const Mat4 tangent = P * K * P;
    const double scale = tangent.trace() / 3;
    row.tangent_mass.setZero();
    if (scale > rounding) row.tangent_mass = (tangent + scale * n * n.transpose()).inverse();
}

/// The velocity along the normal that leaves the surface at e times the speed v with which the
/// bodies meet there, v^2 = v0^2 + 2 g s0, when they accelerate towards each other at g, approached
/// at v0 with the gap s0 at the start of the step, and are s apart in its middle. The velocity w
/// and the gap s + h w/2 at the end of the step then have the energy of that rebound:
/// w^2 + 2 g (s + h w/2) = e^2 v^2.
double rebound_velocity(double e, double v0, double g, double s, double h) {
    const double s0 = s + 0.5 * h * v0;
    const double at_surface = std::max(0.0, v0 * v0 + 2 * g * s0);
    const double half = 0.5 * g * h;
    return std::sqrt(std::max(0.0, half * half + e * e * at_surface - 2 * g * s)) - half;
}

/// The larger of what keeps or takes the bodies apart and what restitution asks for.
double target_velocity(const Simulation& simulation, const StepData& step, const ContactRow& row,
                       double separation) {
    const TypeProperties& a = simulation.type_of(row.a);
    const TypeProperties& b = simulation.type_of(row.b);
    const double h = step.dt;
    const double s = separation;
    const double target =
        s > 0 ? -s / h : -kBiasPart / h * std::min(0.0, s + std::min(a.slop, b.slop));

    const double e = std::max(a.restitution, b.restitution);
    if (e == 0) return target;
    const Vec4& n = row.normal;
    const Bodies& start = simulation.bodies;
    const double v0 = -n.dot(relative_velocity(row, start.velocity, start.angular_velocity));
    const double v1 = -n.dot(relative_velocity(row, step.velocity, step.angular_velocity));
    if (v0 <= kRestitutionThreshold || s > h * v1) return target;
    const double g = (a.falls - b.falls) * n.dot(simulation.settings.gravity);
    return std::max(target, rebound_velocity(e, v0, g, s, h));
}

/// Needs the velocities before any impulse of this step.
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
    row.target = target_velocity(simulation, step, row, contact.separation);

    // The normal may have turned since the last step.
    row.normal_impulse = impulse.normal;
    const Vec4 tangent = impulse.tangent - row.normal.dot(impulse.tangent) * row.normal;
    row.tangent_impulse = clamped_to_ball(tangent, row.friction * row.normal_impulse);
    return row;
}

void solve_friction(const Simulation& simulation, StepData& step, ContactRow& row) {
    if (row.friction == 0) return;
    const Vec4 v = relative_velocity(row, step.velocity, step.angular_velocity);
    const Vec4 slip = v - row.normal.dot(v) * row.normal;
    const Vec4 impulse = clamped_to_ball(row.tangent_impulse - row.tangent_mass * slip,
                                         row.friction * row.normal_impulse);
    apply_impulse(simulation, step, row, impulse - row.tangent_impulse);
    row.tangent_impulse = impulse;
}

void solve_normal(const Simulation& simulation, StepData& step, ContactRow& row) {
    const double v = row.normal.dot(relative_velocity(row, step.velocity, step.angular_velocity));
    const double impulse = std::max(0.0, row.normal_impulse + row.normal_mass * (row.target - v));
    apply_impulse(simulation, step, row, (impulse - row.normal_impulse) * row.normal);
    row.normal_impulse = impulse;
}

}  // namespace

void recall_impulses(const Simulation& simulation, StepData& step, Range contacts) {
    if (contacts.begin == contacts.end) return;
    const auto key = [](const auto& c) { return std::tie(c.a, c.b, c.feature); };
    const auto& last = simulation.memory.impulses;
    auto old = std::lower_bound(
        last.begin(), last.end(), step.contacts[contacts.begin],
        [&](const ContactImpulse& i, const Contact& c) { return key(i) < key(c); });
    for (std::size_t i = contacts.begin; i < contacts.end; ++i) {
        const Contact& c = step.contacts[i];
        while (old != last.end() && key(*old) < key(c)) ++old;
        if (old != last.end() && key(*old) == key(c))
            step.impulses[i] = *old;
        else
            step.impulses[i] = {c.a, c.b, c.feature, 0, Vec4::Zero()};
    }
}

void solve_island(const Simulation& simulation, StepData& step, std::size_t island) {
    const Islands& islands = step.islands;
    const std::uint32_t begin = islands.first[island], end = islands.first[island + 1];

    // Set all rows up before the first impulse changes a velocity.
    for (std::uint32_t i = begin; i < end; ++i) {
        const std::uint32_t contact = islands.contacts[i];
        step.rows[i] = make_row(simulation, step, step.contacts[contact], step.impulses[contact]);
    }

    // Warm start.
    for (std::uint32_t i = begin; i < end; ++i) {
        const ContactRow& row = step.rows[i];
        apply_impulse(simulation, step, row, row.normal_impulse * row.normal + row.tangent_impulse);
    }

    // Friction last, so that no contact ends with more of it than its normal impulse allows.
    for (int iteration = 0; iteration < simulation.settings.iterations; ++iteration)
        for (std::uint32_t i = begin; i < end; ++i) {
            solve_normal(simulation, step, step.rows[i]);
            solve_friction(simulation, step, step.rows[i]);
        }

    for (std::uint32_t i = begin; i < end; ++i) {
        ContactImpulse& impulse = step.impulses[islands.contacts[i]];
        impulse.normal = step.rows[i].normal_impulse;
        impulse.tangent = step.rows[i].tangent_impulse;
    }
}

}  // namespace tesserae
