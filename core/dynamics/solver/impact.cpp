// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/impact.hpp"

#include <algorithm>
#include <cmath>

namespace tesserae {
namespace {

/// Rounding of a sum of energies, as a part of them; what a compression may add that has not
/// converged or is in float.
constexpr double kEnergyRounding = 1e-12, kNotJammed = 1e-6;

}  // namespace

void list_impacts(const Simulation& simulation, const StepData& step, Range contacts,
                  std::vector<std::uint32_t>& impacts) {
    for (std::size_t begin = contacts.begin; begin < contacts.end;) {
        const ContactList::Run run = step.contacts.run(begin, contacts.end);
        const ImpactFilter filter(simulation, step, step.contacts[begin]);
        for (std::size_t i = run.begin; i < run.end; ++i)
            if (filter.passes(step.contacts.point(i)) && impact_of(simulation, step, i).fastest > 0)
                impacts.push_back(static_cast<std::uint32_t>(i));
        begin = run.end;
    }
}

Impact larger_of(const Impact& a, const Impact& b) {
    return {std::max(a.fastest, b.fastest), std::max(a.returned, b.returned), a.driven || b.driven};
}

Impact impact_of_runs(const Simulation& simulation, const StepData& step,
                      std::span<const std::uint32_t> runs) {
    Impact all;
    for (const std::uint32_t n : runs) {
        const ContactList::Run run = step.contacts.nth_run(n);
        const ImpactFilter filter(simulation, step, step.contacts[run.begin]);
        for (std::size_t i = run.begin; i < run.end; ++i)
            if (filter.passes(step.contacts.point(i)))
                all = larger_of(all, impact_of(simulation, step, i));
        all.driven |= is_driven(simulation, run.a) || is_driven(simulation, run.b);
    }
    return all;
}

double motion_product(const Simulation& simulation, const StepData& step, BodyId id,
                      const BodyMotion& a, const BodyMotion& b) {
    const TypeProperties& type = simulation.type_of(id);
    double sum = type.inverse_mass > 0 ? type.mass * a.velocity.dot(b.velocity) : 0;
    if (simulation.needs.turning && !(type.inverse_inertia == Bivector{}))
        sum += dot(angular_momentum(type, step.rotor[id], a.angular_velocity), b.angular_velocity);
    return sum;
}

double twice_kinetic_energy(const Simulation& simulation, const StepData& step, BodyId id,
                            const BodyMotion& motion) {
    return motion_product(simulation, step, id, motion, motion);
}

bool can_jam(const Simulation& simulation, const Impact& impact) {
    return simulation.needs.friction && simulation.needs.turning && !impact.driven;
}

bool has_jammed(const std::array<double, 2>& energies) {
    return !(energies[1] <= (1 + kNotJammed) * energies[0]);
}

RestitutionSums& RestitutionSums::operator+=(const RestitutionSums& sums) {
    taken_squared += sums.taken_squared, given_squared += sums.given_squared;
    lost += sums.lost, cross += sums.cross, all += sums.all;
    work_taken += sums.work_taken, work_given += sums.work_given;
    return *this;
}

RestitutionSums restitution_of(const Simulation& simulation, const StepData& step,
                               std::span<const BodyId> bodies) {
    RestitutionSums sums;
    const Vec4 kick = step.h * simulation.settings.gravity;
    for (const BodyId id : bodies) {
        const ImpactMotion& m = step.impact_motion[id];
        const BodyMotion taken = m.before - m.compressed;
        const BodyMotion given = motion_of(step, id) - m.compressed;
        sums.taken_squared += motion_product(simulation, step, id, taken, taken);
        sums.given_squared += motion_product(simulation, step, id, given, given);
        sums.lost += motion_product(simulation, step, id, taken, m.before + m.compressed);
        sums.cross += motion_product(simulation, step, id, m.compressed, given);
        sums.all += motion_product(simulation, step, id, m.before, m.before);
        const TypeProperties& type = simulation.type_of(id);
        const double weight = type.mass * type.gravity_scale;
        sums.work_taken += weight * kick.dot(taken.velocity);
        sums.work_given += weight * kick.dot(given.velocity);
    }
    return sums;
}

double part_of_restitution(const RestitutionSums& sums, const Impact& impact) {
    const double slope = sums.cross + 0.5 * sums.work_given, least = sums.lost + sums.work_taken;
    // The part x of what is given: x^2 given^2 + 2 x cross <= returned^2 taken^2, twice energies.
    const double cross = impact.driven ? 0 : std::max(0.0, sums.cross);
    const double taken =
        impact.driven ? sums.taken_squared : std::clamp(sums.lost, 0.0, sums.taken_squared);
    const double most = impact.returned * impact.returned * taken;
    double part = 1;
    if (sums.given_squared + 2 * cross > most) {
        const double root = std::sqrt(cross * cross + sums.given_squared * most);
        part = most > 0 ? most / (cross + root) : 0;
    }
    // Nor more than the energy that there was, with gravity's work: part^2 given^2 + 2 part slope
    // <= least, where an impact that is not central rebounds before the bodies touch.
    if (!impact.driven &&
        part * part * sums.given_squared + 2 * part * slope > least + kEnergyRounding * sums.all) {
        const double root = std::sqrt(std::max(0.0, slope * slope + sums.given_squared * least));
        part =
            sums.given_squared > 0 ? std::clamp((root - slope) / sums.given_squared, 0.0, part) : 0;
    }
    return part;
}

void leave_part_of_restitution(const Simulation& simulation, StepData& step,
                               std::span<const BodyId> bodies, double part) {
    if (part == 1) return;
    for (const BodyId id : bodies) {
        const BodyMotion& compressed = step.impact_motion[id].compressed;
        const BodyMotion motion = compressed + part * (motion_of(step, id) - compressed);
        step.velocity[id] = motion.velocity;
        if (simulation.needs.turning) step.angular_velocity[id] = motion.angular_velocity;
    }
}

}  // namespace tesserae
