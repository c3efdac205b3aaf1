// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/diagnostics/momentum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "tests/scenes/properties/properties.hpp"

namespace tesserae::scenes::properties {
namespace {

/// What acts on all bodies together in a step, but for impacts of what contacts do not move.
struct Acting {
    Vec4 impulse = Vec4::Zero();     ///< [N s]
    Bivector angular;                ///< of gravity about the origin [N m s]
    double by_gravity = 0;           ///< sum of the lengths of what gravity gives [N s]
    double most = 0;                 ///< sum of the lengths of what contacts give [N s]
    Vec4 of_impacts = Vec4::Zero();  ///< with those of bodies that regain lost time
    Vec4 of_stops = Vec4::Zero();    ///< of fast bodies, which gravity has then for less long
    bool held = false;               ///< something touches what contacts do not move
};

/// Contacts do not change its velocity, or not its angular velocity.
bool holds(const Simulation& simulation, BodyId id) {
    const TypeProperties& type = simulation.type_of(id);
    return !(type.inverse_mass > 0) || type.fixed;
}

/// Adds up what acts in the sub-steps of a step.
class ActingObserver : public StageObserver {
  public:
    void begin(Stage stage, std::size_t, const Simulation& simulation,
               const StepData& step) override {
        if (last_ == Stage::kStopFastBodies)
            acting_.of_stops += momentum(simulation, step) - before_;
        if (last_ == Stage::kRegainLostTime)
            (acting_.held ? acting_.of_impacts : acting_.of_stops) +=
                momentum(simulation, step) - before_;
        last_ = stage;
        switch (stage) {
            case Stage::kRegainLostTime:
                // Its contacts are not told.
                for (BodyId id = 0; id < step.velocity.size(); ++id)
                    acting_.held |= holds(simulation, id);
                [[fallthrough]];
            case Stage::kStopFastBodies:
                before_ = momentum(simulation, step);
                break;
            case Stage::kSolveImpacts:
                before_ = momentum(simulation, step);
                add_gravity(simulation, step);
                break;
            case Stage::kIntegrateVelocities:
                acting_.of_impacts += momentum(simulation, step) - before_;
                break;
            case Stage::kAdvanceSecondHalf:
                add_loads(simulation, step);
                break;
            default:
                break;
        }
    }
    void end(Stage) override {}

    Acting take() { return std::exchange(acting_, {}); }

  private:
    static Vec4 momentum(const Simulation& simulation, const StepData& step) {
        Vec4 sum = Vec4::Zero();
        for (BodyId id = 0; id < step.velocity.size(); ++id)
            if (simulation.type_of(id).inverse_mass > 0)
                sum += simulation.type_of(id).mass * step.velocity[id];
        return sum;
    }
    void add_gravity(const Simulation& simulation, const StepData& step) {
        for (BodyId id = 0; id < step.position.size(); ++id) {
            const bool asleep = !step.asleep.empty() && step.asleep[id] != kAwake;
            const TypeProperties& type = simulation.type_of(id);
            if (type.gravity_scale == 0 || asleep) continue;
            const Vec4 impulse =
                type.mass * step.h * type.gravity_scale * simulation.settings.gravity;
            acting_.impulse += impulse;
            acting_.by_gravity += impulse.norm();
            acting_.angular += wedge(step.position[id], impulse);
        }
    }
    void add_loads(const Simulation& simulation, const StepData& step) {
        for (std::size_t i = 0; i < step.contacts.size(); ++i) {
            const Contact contact = step.contacts[i];
            acting_.held |= holds(simulation, contact.a) || holds(simulation, contact.b);
            const Vec4 on_b = step.impulses[i].normal * contact.normal + step.impulses[i].tangent();
            acting_.most += on_b.norm();
            if (simulation.type_of(contact.b).inverse_mass > 0) acting_.impulse += on_b;
            if (simulation.type_of(contact.a).inverse_mass > 0) acting_.impulse -= on_b;
        }
    }

    Acting acting_;
    Vec4 before_ = Vec4::Zero();  ///< the stage
    Stage last_ = Stage::kFinishStep;
};

/// Sums of the sizes of what momenta are sums of.
struct Amounts {
    double linear = 0, angular = 0;
};
Amounts amounts_of(const Bodies& bodies) {
    Amounts sums;
    for (BodyId id = 0; id < bodies.size(); ++id) {
        const BodyType& type = bodies.type_of(id);
        if (!is_bounded(type.shape)) continue;
        const double radius = bounding_radius(type.shape);
        const double linear =
            type.mass * (bodies.velocity[id].norm() + radius * norm(bodies.angular_velocity[id]));
        sums.linear += linear;
        sums.angular += linear * (bodies.position[id].norm() + radius);
    }
    return sums;
}

/// Where nothing is held contacts are solved in double: an impact's impulses, of at most 10^4
/// contacts and sweeps, each round by 2^-53.
constexpr double kInDouble = 1e4 * 0x1p-53;
/// Else they may be solved in float: of up to 80 sweeps each rounds by 2^-24.
constexpr double kInFloat = 80 * 0x1p-24;

}  // namespace

std::string fault_of_momentum(const SmallScene& scene, const Change& defect) {
    const Start start = start_of(scene);
    Motion motion(start, defect);
    for (int i = 1; i <= scene.steps; ++i) {
        const Bodies before = motion.bodies();
        ActingObserver observer;
        motion.step(&observer);
        const Bodies& after = motion.bodies();
        const Acting acting = observer.take();
        const Amounts had = amounts_of(before), has = amounts_of(after);
        const double linear = had.linear + has.linear + acting.impulse.norm() + acting.most;
        const Vec4 left =
            total_momentum(after) - total_momentum(before) - acting.impulse - acting.of_stops;
        // With the rounding of the impacts of what goes on.
        if (acting.of_stops.norm() >
            1.0001 * acting.by_gravity + (acting.held ? kInFloat : kInDouble) * linear)
            return fmt::format("step {}: bodies are stopped by {} kg m/s, gravity gives them {}", i,
                               acting.of_stops.norm(), acting.by_gravity);
        if (acting.held) {
            if (const double off = (left - acting.of_impacts).norm(); off > kInFloat * linear)
                return fmt::format("step {}: {} kg m/s of {} come from nothing", i, off, linear);
            continue;
        }
        if (const double off = left.norm(); off > kInDouble * linear)
            return fmt::format("step {}: {} kg m/s of {} come from nothing", i, off, linear);
        if (acting.of_stops != Vec4::Zero()) continue;
        const Bivector turned =
            total_angular_momentum(after) - total_angular_momentum(before) - acting.angular;
        const double angular = had.angular + has.angular + norm(acting.angular);
        if (const double off = norm(turned); off > kInDouble * angular)
            return fmt::format("step {}: {} kg m^2/s of {} come from nothing", i, off, angular);
    }
    return {};
}

}  // namespace tesserae::scenes::properties
