#pragma once

#include "core/dynamics/state/step_data.hpp"

namespace tesserae {

/// What impulses are for. Those of a blow end in the sub-step in which they act; those of a load
/// act again in the next one, which starts from them.
enum class Cause {
    kBlow,  ///< bodies hit each other; before gravity acts
    kLoad,  ///< they rest on each other; after it
};

/// What a row aims at, along the normal; see NormalPass. Of a blow, `solve` is the compression and
/// `relax` the restitution; of a load of Solver::kImpulse `relax` is the push, which takes overlap
/// away.
struct ContactTargets {
    double keep = 1;   ///< of the solve pass
    double solve = 0;  ///< [m/s]
    double relax = 0;  ///< [m/s]
};
/// @param normal_velocity   at which the bodies part, before the first impulse of the cause [m/s]
ContactTargets targets_of(const Simulation& simulation, const StepData& step,
                          const Contact& contact, double normal_velocity, Cause cause);

/// The velocity of body b relative to body a at the contact point [m/s].
/// @param turning   see Needs
inline Vec4 relative_velocity(const StepData& step, BodyId a, const Vec4& r_a, BodyId b,
                              const Vec4& r_b, bool turning) {
    if (!turning) return step.velocity[b] - step.velocity[a];
    return step.velocity[b] + velocity_at(step.angular_velocity[b], r_b) - step.velocity[a] -
           velocity_at(step.angular_velocity[a], r_a);
}

/// Whether any contact of the island overlaps by more than is left alone, and some body is held: a
/// push of Solver::kImpulse then follows the load, with which bodies move, and which is given back
/// afterwards. So it moves bodies without impulses, which changes the angular momentum of those
/// that move against each other: where nothing is held that is kept.
bool is_pushed(const Simulation& simulation, const StepData& step, std::size_t island);

/// How hard an island's bodies hit each other.
struct Blow {
    double fastest = 0;   ///< speed at which they meet [m/s]; 0: none does
    double returned = 0;  ///< the greatest part of such a speed that restitution gives back
    bool driven = false;  ///< some body moves at a velocity of its own; see is_driven()
};
/// Of one contact, but for `driven`. Needs the velocities before gravity.
Blow blow_of(const Simulation& simulation, const StepData& step, const Contact& contact);

/// Passes contacts that may be blows; quick where the points of a pair follow each other.
class BlowFilter {
  public:
    bool passes(const Simulation& simulation, const StepData& step, const Contact& c) {
        if (c.a != a_ || c.b != b_ || c.normal != normal_) see(simulation, step, c);
        // blow_of() rounds otherwise.
        return !(approach_ + turning_.dot(c.point - centre_) < 0.99 * slowest_);
    }

  private:
    void see(const Simulation& simulation, const StepData& step, const Contact& c);

    BodyId a_ = 0, b_ = 0;  ///< of no pair
    Vec4 normal_ = Vec4::Zero(), centre_ = Vec4::Zero(), turning_ = Vec4::Zero();
    double approach_ = 0, slowest_ = 0;
};

}  // namespace tesserae
