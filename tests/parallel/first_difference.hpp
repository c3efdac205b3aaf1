// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "core/dynamics/stepper.hpp"
#include "parallel/parallel_stepper.hpp"
#include "parallel/threads.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae::testing {

inline std::string text_of(const Vec4& v) {
    return fmt::format("({:.17g}, {:.17g}, {:.17g}, {:.17g})", v[0], v[1], v[2], v[3]);
}

inline std::string text_of(const Bivector& b) {
    return fmt::format("({:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g})", b.xy, b.xz, b.xw,
                       b.yz, b.yw, b.zw);
}

/// The first body whose state differs in any bit, and in what; "" if none does.
inline std::string difference_of(const Bodies& a, const Bodies& b) {
    if (a.size() != b.size()) return fmt::format("{} and {} bodies", a.size(), b.size());
    const auto differ = [](const auto& x, const auto& y) {
        return std::memcmp(static_cast<const void*>(&x), static_cast<const void*>(&y), sizeof x) !=
               0;
    };
    for (BodyId i = 0; i < a.size(); ++i) {
        const auto report = [&](const char* what, const auto& x, const auto& y) {
            return fmt::format("body {}: {} {} and {}", i, what, text_of(x), text_of(y));
        };
        if (differ(a.position[i], b.position[i]))
            return report("position", a.position[i], b.position[i]);
        if (differ(a.velocity[i], b.velocity[i]))
            return report("velocity", a.velocity[i], b.velocity[i]);
        if (differ(a.angular_velocity[i], b.angular_velocity[i]))
            return report("angular velocity", a.angular_velocity[i], b.angular_velocity[i]);
        if (differ(a.rotor[i], b.rotor[i]))
            return report("bivector of the rotor", a.rotor[i].b, b.rotor[i].b);
    }
    return "";
}

/// The first contact whose impulse differs, or that only one has; "" if there is none.
inline std::string difference_of(const StepMemory& a, const StepMemory& b) {
    if (same_values(a, b)) return "";
    const std::size_t count = std::max(a.impulses.size(), b.impulses.size());
    for (std::size_t i = 0; i < count; ++i) {
        const auto text = [&](const StepMemory& memory) -> std::string {
            if (i >= memory.impulses.size()) return "no more contacts";
            const KeptImpulse p = memory.impulses[i];
            return fmt::format("bodies {} and {}, feature {}, normal {:.17g}, tangent {}", p.a, p.b,
                               p.feature, p.normal, text_of(p.tangent()));
        };
        const std::string of_a = text(a), of_b = text(b);
        if (of_a != of_b) return fmt::format("contact {}: {}; {}", i, of_a, of_b);
    }
    return "sleeping bodies or the time";
}

/// Both together, contacts first: a wrong one moves bodies.
template <class SomeWorld, class OtherWorld>
std::string difference_of(const SomeWorld& a, const OtherWorld& b) {
    const std::string of_contacts = difference_of(a.memory(), b.memory());
    return of_contacts.empty() ? difference_of(a.bodies(), b.bodies()) : of_contacts;
}

/// To be streamed after a comparison of the ends of two runs, which is cheap where they agree:
/// steps both worlds side by side and tells the first step, and there the first contact or body, in
/// which they differ.
inline std::string first_difference(const Bodies& bodies, const PhysicsSettings& settings,
                                    double dt, int steps, parallel::Threads& threads) {
    Stepper serial(bodies, settings);
    parallel::ParallelStepper world(bodies, settings);
    for (int i = 0; i < steps; ++i) {
        serial.step(dt);
        threads.run([&] { world.step(dt); });
        const std::string found = difference_of(serial, world);
        if (!found.empty())
            return fmt::format("Stepper and ParallelStepper, step {}: {}", i, found);
    }
    return "Stepper and ParallelStepper run again do not differ";
}

}  // namespace tesserae::testing
