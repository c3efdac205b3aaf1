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

void solve_friction(const Simulation& simulation, StepData& step, ContactRow& row) {
    if (row.friction == 0) return;
    const Vec4 v = relative_velocity(step, row);
    const Vec4 slip = v - row.normal.dot(v) * row.normal;
    const Vec4 impulse = clamped_to_ball(row.tangent_impulse - row.tangent_mass * slip,
                                         row.friction * row.normal_impulse);
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

/// Friction last, so that no contact ends with more of it than its normal impulse allows. Every
/// other iteration goes through the island backward: a load at one end of it then reaches the
/// other in one iteration (a tower of ten leans 10 times less). The last one of solve_island() goes
/// forward and that of relax_island() backward, which is best for towers listed from the ground.
/// @return the largest change of a normal velocity in the last iteration [m/s]
template <NormalPass ContactRow::*kPass>
double iterate(const Simulation& simulation, StepData& step, std::uint32_t begin,
               std::uint32_t end) {
    constexpr int kBackward = kPass == &ContactRow::solve ? 1 : 0;
    const int last = simulation.settings.iterations - 1;
    double residual = 0;
    for (int iteration = 0; iteration <= last; ++iteration)
        for (std::uint32_t i = begin; i < end; ++i) {
            const bool backward = (last - iteration) % 2 == kBackward;
            ContactRow& row = step.rows[backward ? begin + (end - 1 - i) : i];
            const double change = solve_normal(simulation, step, row, row.*kPass);
            if (change == 0 && row.normal_impulse == 0) continue;  // apart, and friction is 0 too
            if (iteration == last) residual = std::max(residual, std::abs(change) / row.relax.mass);
            solve_friction(simulation, step, row);
        }
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
    step.residual[island] = iterate<&ContactRow::solve>(simulation, step, begin, end);
}

void relax_island(const Simulation& simulation, StepData& step, std::size_t island) {
    const Islands& islands = step.islands;
    const std::uint32_t begin = islands.first[island], end = islands.first[island + 1];
    if (simulation.settings.solver == Solver::kSoft)
        step.residual[island] = iterate<&ContactRow::relax>(simulation, step, begin, end);
    for (std::uint32_t i = begin; i < end; ++i) {
        ContactImpulse& impulse = step.impulses[islands.contacts[i]];
        impulse.normal = step.rows[i].normal_impulse;
        impulse.tangent = step.rows[i].tangent_impulse;
    }
}

}  // namespace tesserae
