// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "bench/bodies.hpp"
#include "bench/thread_time.hpp"
#include "core/dynamics/step/schedule.hpp"
#include "parallel/parallel_stepper.hpp"

namespace tesserae::bench {

/// 5^3 towers, 8 bodies high, of bodies that are 1 m high as they stand, on a floor, with
/// nothing asleep. Made and stepped inside run() of the same Threads.
class RestingTowers {
  public:
    static constexpr int kAcross = 5, kHigh = 8;
    static constexpr double kSpacing = 1.6;  ///< so that they don't touch [m]
    static constexpr int kBodies = kAcross * kAcross * kAcross * kHigh;

    RestingTowers(const Shape& shape, int settling_steps)
        : world_(towers_of(shape), PhysicsSettings{}), start_(world_.bodies().position) {
        for (int i = 0; i < settling_steps; ++i) world_.step(testing::kStep);
        settled_ = world_.bodies().position;
    }

    ~RestingTowers() { world_.observe(nullptr); }

    /// Processor time of a step [s], the mean of some.
    double step_time(int steps) {
        world_.observe(&clock_);
        const double begin = thread_time();
        for (int i = 0; i < steps; ++i) report_ = world_.step(testing::kStep);
        const double time = thread_time() - begin;
        steps_ += steps, all_ += time;
        return time / steps;
    }
    /// Of the last step.
    const StepReport& report() const { return report_; }
    /// Mean way of the bodies since the beginning [m].
    double way() const { return mean_way(start_); }
    /// The same in a second since they had settled, straight [m/s].
    double speed() const { return mean_way(settled_) / (steps_ * testing::kStep); }
    /// Share of a stage in the processor time since then.
    double share_of(Stage stage) { return clock_.seconds[stage] / all_; }

  private:
    struct StageClock : StageObserver {
        std::map<Stage, double> seconds;
        double begun = 0;
        void begin(Stage, std::size_t, const Simulation&, const StepData&) override {
            begun = thread_time();
        }
        void end(Stage stage) override { seconds[stage] += thread_time() - begun; }
    };

    static Bodies towers_of(const Shape& shape) {
        Bodies bodies;
        BodyType type;
        type.shape = shape;
        type.friction = 0.5;
        bodies.types.push_back(type);
        for (int i = 0; i < kBodies; ++i) {
            const auto along = [&](int number) {
                return kSpacing * (number % kAcross - 0.5 * (kAcross - 1));
            };
            const int tower = i / kHigh;
            add(bodies, 0u,
                {along(tower), i % kHigh + 0.5, along(tower / kAcross),
                 along(tower / kAcross / kAcross)});
        }
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5, 0), Vec4::Zero());
        return bodies;
    }
    double mean_way(const std::vector<Vec4>& from) const {
        double sum = 0;
        for (std::size_t i = 0; i < kBodies; ++i)
            sum += (world_.bodies().position[i] - from[i]).norm();
        return sum / kBodies;
    }

    parallel::ParallelStepper world_;
    std::vector<Vec4> start_, settled_;
    StageClock clock_;
    StepReport report_;
    int steps_ = 0;
    double all_ = 0;  ///< [s]
};

}  // namespace tesserae::bench
