// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/first_loads.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/dynamics/constraints/contact_targets.hpp"
#include "core/dynamics/step/room.hpp"

namespace tesserae {
namespace {

/// Runs of a range at least.
constexpr std::size_t kRunGrain = 1024;

/// The least upward part of a normal along which anything stands: on steeper faces it slides.
constexpr double kUpward = 0.1;

/// What is known of a body: it stands on something; what carries it has a warm start; what it
/// stands on stands fast.
constexpr std::uint8_t kStands = 1, kIsCarried = 2, kStandsFast = 4;

Vec4 up_of(const Simulation& simulation) { return stable_normalized(-simulation.settings.gravity); }

}  // namespace

void FirstLoads::guess(const Simulation& simulation, StepData& step, Schedule& schedule) {
    if (simulation.settings.gravity.isZero(0) || !look(simulation, step, schedule)) return;
    list_supports(simulation, step);
    if (!supports_.empty()) share_out(simulation, step);
    // Most steps have few.
    release(supports_), release(above_);
}

/// Whether there is any body that stands on something and that has no warm start.
bool FirstLoads::look(const Simulation& simulation, const StepData& step, Schedule& schedule) {
    const Vec4 up = up_of(simulation);
    known_.assign(simulation.bodies.size(), 0);
    schedule.for_each_range(step.contacts.run_count(), kRunGrain, [&](Range runs) {
        for (std::size_t r = runs.begin; r < runs.end; ++r) {
            const ContactList::Run run = step.contacts.nth_run(r);
            const double part = up.dot(step.contacts.normal(run.begin));
            if (!(std::abs(part) > kUpward)) continue;
            const double touches = resting_gap(simulation, run.a, run.b);
            std::uint8_t seen = 0;
            for (std::size_t i = run.begin; i < run.end; ++i) {
                if (step.contacts.separation(i) <= touches) seen |= kStands;
                if (step.impulses[i].normal > 0) seen |= kIsCarried;
            }
            std::atomic_ref(known_[part > 0 ? run.b : run.a]).fetch_or(seen);
        }
    });
    const auto is_new = [&](Range bodies) {
        return std::any_of(known_.begin() + static_cast<std::ptrdiff_t>(bodies.begin),
                           known_.begin() + static_cast<std::ptrdiff_t>(bodies.end),
                           [](std::uint8_t known) { return known == kStands; });
    };
    return schedule.any_range(known_.size(), kRunGrain, is_new);
}

void FirstLoads::list_supports(const Simulation& simulation, const StepData& step) {
    const Vec4 up = up_of(simulation);
    supports_.clear();
    for (std::size_t r = 0; r < step.contacts.run_count(); ++r) {
        const ContactList::Run run = step.contacts.nth_run(r);
        const double part = up.dot(step.contacts.normal(run.begin));
        if (!(std::abs(part) > kUpward)) continue;
        const BodyId upper = part > 0 ? run.b : run.a, lower = part > 0 ? run.a : run.b;
        if (known_[upper] != kStands || !(simulation.type_of(upper).gravity_scale > 0)) continue;
        supports_.push_back({up.dot(step.position[upper]), upper, lower,
                             static_cast<std::uint32_t>(r), std::abs(part)});
    }
    std::sort(supports_.begin(), supports_.end(), [](const Support& s, const Support& t) {
        return std::tie(s.height, s.upper, s.run) < std::tie(t.height, t.upper, t.run);
    });
    // From the ground up. Those on what does not stand fast are left out.
    std::erase_if(supports_, [&](const Support& s) {
        const bool can_give_way = simulation.type_of(s.lower).inverse_mass > 0;
        if (can_give_way && (known_[s.lower] & kStandsFast) == 0) return true;
        known_[s.upper] |= kStandsFast;
        return false;
    });
}

void FirstLoads::number_loads(const Simulation& simulation) {
    const auto of_others = std::numeric_limits<std::uint32_t>::max();
    load_.assign(simulation.bodies.size(), of_others);
    std::uint32_t count = 0;
    for (const Support& s : supports_)
        if (load_[s.upper] == of_others) load_[s.upper] = count++;
    std::replace(load_.begin(), load_.end(), of_others, count);
    above_.assign(count + std::size_t{1}, {});
}

void FirstLoads::list_places(const Simulation& simulation, const StepData& step,
                             const Support* begin, const Support* end) {
    const Vec4 up = up_of(simulation);
    places_.clear();
    for (const Support* s = begin; s != end; ++s) {
        const ContactList::Run run = step.contacts.nth_run(s->run);
        const double touches = resting_gap(simulation, run.a, run.b);
        for (std::size_t i = run.begin; i < run.end; ++i) {
            if (!(step.contacts.separation(i) <= touches)) continue;
            const Vec4 r = step.contacts.point(i) - step.position[s->upper];
            places_.push_back({s, i, r - up.dot(r) * up});
        }
    }
}

/// From the top down. Impulses are an affine function of the place, the least one that bears the
/// load where it acts; where that pulls at a point it has none.
void FirstLoads::share_out(const Simulation& simulation, StepData& step) {
    using Vec5 = Eigen::Matrix<double, 5, 1>;
    number_loads(simulation);
    const Vec4 up = up_of(simulation);
    for (std::size_t end = supports_.size(); end > 0;) {
        std::size_t begin = end - 1;
        const BodyId body = supports_[begin].upper;
        while (begin > 0 && supports_[begin - 1].upper == body) --begin;
        list_places(simulation, step, &supports_[begin], &supports_[begin] + (end - begin));
        end = begin;

        const TypeProperties& type = simulation.type_of(body);
        const double load =
            step.kick * type.mass * type.gravity_scale + above_[load_[body]].impulse;
        // In radii of the body, so that sizes are alike.
        const double unit = 1 / type.radius;
        Eigen::Matrix<double, 5, 5> squares = Eigen::Matrix<double, 5, 5>::Zero();
        const auto seen = [&](const Place& place) {
            Vec5 x;
            x << 1, unit * place.from_centre;
            return Vec5(place.support->part * x);
        };
        for (const Place& place : places_) squares += seen(place) * seen(place).transpose();
        Vec5 all;
        all << load, unit * above_[load_[body]].moment;
        const Vec5 slope = squares.completeOrthogonalDecomposition().solve(all);
        double carried = 0;
        for (const Place& place : places_)
            carried += place.support->part * std::max(0.0, seen(place).dot(slope));
        if (!(carried > 0)) continue;
        for (const Place& place : places_) {
            const double impulse = load / carried * std::max(0.0, seen(place).dot(slope));
            step.impulses[place.contact].normal = impulse;
            const BodyId lower = place.support->lower;
            const double down = impulse * place.support->part;
            const Vec4 between = step.position[body] - step.position[lower];
            Load& above = above_[load_[lower]];
            above.impulse += down;
            above.moment += down * (place.from_centre + (between - up.dot(between) * up));
        }
    }
}

}  // namespace tesserae
