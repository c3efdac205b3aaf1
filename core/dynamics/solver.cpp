#include "core/dynamics/solver.hpp"

#include <algorithm>
#include <cmath>

#include "core/dynamics/contact_row.hpp"

namespace tesserae {
namespace {

void apply_impulse(const Simulation& simulation, StepData& step, BodyId id, const Vec4& r,
                   const Vec4& impulse) {
    const TypeProperties& type = simulation.type_of(id);
    if (!type.movable) return;
    step.velocity[id] += type.inverse_mass * impulse;
    step.angular_velocity[id] += angular_response(simulation, step, id, wedge(r, impulse));
}

void apply_impulse(const Simulation& simulation, StepData& step, const ContactRow& row,
                   const Vec4& impulse) {
    apply_impulse(simulation, step, row.a, row.r_a, -impulse);
    apply_impulse(simulation, step, row.b, row.r_b, impulse);
}

/// The impulse that ends the slip, if friction allows it. Else the largest that it allows, against
/// the slip: clamping the former would be against what turns into the slip by the bodies'
/// responses, and a box that slides on its corners would push each aside instead of slowing down
/// (by 24 % too little). A step against the slip itself ends where both are parallel.
void solve_friction(const Simulation& simulation, StepData& step, ContactRow& row) {
    if (row.friction == 0) return;
    const Vec4 v = relative_velocity(step, row);
    const Vec4 slip = v - row.normal.dot(v) * row.normal;
    const double most = row.friction * row.normal_impulse;
    Vec4 impulse = row.tangent_impulse - row.tangent_mass * slip;
    if (impulse.squaredNorm() > most * most)
        impulse = clamped_to_ball(row.tangent_impulse - row.slide_mass * slip, most);
    apply_impulse(simulation, step, row, impulse - row.tangent_impulse);
    row.tangent_impulse = impulse;
}

/// @return the change of the normal impulse [N s]
double solve_normal(const Simulation& simulation, StepData& step, ContactRow& row,
                    const NormalPass& pass) {
    const double v = row.normal.dot(relative_velocity(step, row));
    const double impulse =
        std::max(0.0, pass.keep * row.normal_impulse + pass.mass * (pass.target - v));
    const double change = impulse - row.normal_impulse;
    if (change == 0) return 0;
    apply_impulse(simulation, step, row, change * row.normal);
    row.normal_impulse = impulse;
    return change;
}

/// Friction last, so that no contact ends with more of it than its normal impulse allows.
/// @return the change of the normal impulse [N s]
template <NormalPass ContactRow::*kPass>
double solve_row(const Simulation& simulation, StepData& step, ContactRow& row) {
    const double change = solve_normal(simulation, step, row, row.*kPass);
    // Apart, and friction is 0 too?
    if (change != 0 || row.normal_impulse > 0) solve_friction(simulation, step, row);
    return change;
}

template <NormalPass ContactRow::*kPass>
double sweep_rows(const Simulation& simulation, StepData& step, Range places, Sweep sweep) {
    double residual = 0;
    for (std::size_t i = places.begin; i < places.end; ++i) {
        ContactRow& row = step.rows[sweep.backward ? places.begin + (places.end - 1 - i) : i];
        const double change = solve_row<kPass>(simulation, step, row);
        if (sweep.last && change != 0)
            residual = std::max(residual, std::abs(change) / row.relax.mass);
    }
    return residual;
}

double iterate(const Simulation& simulation, StepData& step, Range places, Pass pass) {
    double residual = 0;
    for (int i = 0; i < simulation.settings.iterations; ++i)
        residual = sweep_contacts(simulation, step, places, sweep_of(simulation, pass, i));
    return residual;
}

}  // namespace

void recall_impulses(const Simulation& simulation, StepData& step, Range contacts) {
    if (contacts.begin == contacts.end) return;
    const std::vector<ContactImpulse>& last = last_impulses(simulation, step);
    auto old = std::lower_bound(
        last.begin(), last.end(), step.contacts[contacts.begin],
        [](const ContactImpulse& i, const Contact& c) { return key_of(i) < key_of(c); });
    for (std::size_t i = contacts.begin; i < contacts.end; ++i) {
        const Contact& c = step.contacts[i];
        while (old != last.end() && key_of(*old) < key_of(c)) ++old;
        if (old != last.end() && key_of(*old) == key_of(c))
            step.impulses[i] = *old;
        else
            step.impulses[i] = {c.a, c.b, c.feature, 0, Vec4::Zero()};
    }
}

void make_rows(const Simulation& simulation, StepData& step, Range places) {
    for (std::size_t i = places.begin; i < places.end; ++i) {
        const std::uint32_t contact = step.islands.contacts[i];
        step.rows[i] = make_row(simulation, step, step.contacts[contact], step.impulses[contact]);
    }
}

void warm_start(const Simulation& simulation, StepData& step, Range places) {
    for (std::size_t i = places.begin; i < places.end; ++i) {
        const ContactRow& row = step.rows[i];
        apply_impulse(simulation, step, row, row.normal_impulse * row.normal + row.tangent_impulse);
    }
}

double sweep_contacts(const Simulation& simulation, StepData& step, Range places, Sweep sweep) {
    return sweep.pass == Pass::kSolve
               ? sweep_rows<&ContactRow::solve>(simulation, step, places, sweep)
               : sweep_rows<&ContactRow::relax>(simulation, step, places, sweep);
}

void keep_impulses(StepData& step, Range places) {
    for (std::size_t i = places.begin; i < places.end; ++i) {
        ContactImpulse& impulse = step.impulses[step.islands.contacts[i]];
        impulse.normal = step.rows[i].normal_impulse;
        impulse.tangent = step.rows[i].tangent_impulse;
    }
}

void solve_island(const Simulation& simulation, StepData& step, std::size_t island) {
    const Range places = step.islands.places(island);
    make_rows(simulation, step, places);
    warm_start(simulation, step, places);
    step.residual[island] = iterate(simulation, step, places, Pass::kSolve);
}

void relax_island(const Simulation& simulation, StepData& step, std::size_t island) {
    const Range places = step.islands.places(island);
    if (simulation.settings.solver == Solver::kSoft)
        step.residual[island] = iterate(simulation, step, places, Pass::kRelax);
    keep_impulses(step, places);
}

}  // namespace tesserae
