// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/contacts/clearances.hpp"

#include <algorithm>
#include <cmath>

#include "core/dynamics/step/room.hpp"

namespace tesserae {
namespace {

constexpr std::size_t kBodyGrain = 1024, kPairGrain = 8192;

/// More than a float's rounding, as a part of the number.
constexpr double kRounding = 1.2e-7;
/// Fits a float, and is as good as any larger distance.
constexpr double kFar = 1e30;

}  // namespace

double turned(const Rotor& from, const Rotor& to, double radius) {
    const double s = to.s - from.s, p = to.p - from.p;
    const Bivector b = to.b - from.b;
    return 2 * radius * std::sqrt(s * s + dot(b, b) + p * p);
}

void Clearances::begin(const Simulation& simulation, const StepData& step, Schedule& schedule) {
    resize_anew(next_, step.pairs.size());
    if (pairs_.empty()) return;
    const std::size_t count = simulation.bodies.size();
    way_.resize(count);
    schedule.for_each_range(count, kBodyGrain, [&](Range bodies) {
        for (std::size_t i = bodies.begin; i < bodies.end; ++i)
            way_[i] = way_of(simulation, step, static_cast<BodyId>(i));
    });
}

void Clearances::end(const StepData& step, Schedule& schedule) {
    const std::size_t count = step.position.size();
    position_.resize(count);
    rotor_.resize(count);
    schedule.for_each_range(count, kBodyGrain, [&](Range bodies) {
        for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
            position_[i] = step.position[i];
            rotor_[i] = step.rotor[i];
        }
    });
    resize_anew(pairs_, step.pairs.size());
    schedule.for_each_range(pairs_.size(), kPairGrain, [&](Range pairs) {
        for (std::size_t i = pairs.begin; i < pairs.end; ++i) pairs_[i] = step.pairs[i];
    });
    distance_.swap(next_);
}

Clearances::Way Clearances::way_of(const Simulation& simulation, const StepData& step,
                                   BodyId id) const {
    const TypeProperties& type = simulation.type_of(id);
    if (!type.bounded) return {};
    const Vec4 moved = step.position[id] - position_[id];
    Way way;
    if (!(moved.cwiseAbs().maxCoeff() < kFar)) {
        way.beyond = static_cast<float>(kFar);
        return way;
    }
    for (int axis = 0; axis < 4; ++axis)
        way.moved[static_cast<std::size_t>(axis)] = static_cast<float>(moved[axis]);
    // What a float leaves of the centre's way counts too.
    const double beyond =
        turned(rotor_[id], step.rotor[id], type.radius) + kRounding * moved.cwiseAbs().sum();
    way.beyond = static_cast<float>(std::min((1 + kRounding) * beyond, kFar));
    return way;
}

double Clearances::nearer(const BodyPair& pair) const {
    const Way &a = way_[pair.a], &b = way_[pair.b];
    double squares = 0;
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const double x = double{b.moved[axis]} - a.moved[axis];
        squares += x * x;
    }
    return std::sqrt(squares) + (double{a.beyond} + b.beyond);
}

void Clearances::set(std::size_t place, double distance) {
    // Rounded down: many small ways would else be lost in a float's last place.
    next_[place] = static_cast<float>((1 - kRounding) * std::clamp(distance, 0.0, kFar));
}

Clearances::Search::Search(const Clearances& all, const BodyPair& first)
    : all_(all),
      place_(static_cast<std::size_t>(
          std::lower_bound(all.pairs_.begin(), all.pairs_.end(), first) - all.pairs_.begin())) {}

double Clearances::Search::left(const BodyPair& pair) {
    while (place_ < all_.pairs_.size() && all_.pairs_[place_] < pair) ++place_;
    if (place_ == all_.pairs_.size() || all_.pairs_[place_] != pair) return 0;
    const double distance = all_.distance_[place_];
    if (!(distance > 0)) return 0;
    const double left = distance - all_.nearer(pair);
    return left > 0 ? left : 0;
}

}  // namespace tesserae
