// SPDX-License-Identifier: Apache-2.0
// A step that is ended amid its work has done nothing.
#include <gtest/gtest.h>

#include <random>

#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

constexpr double kStep = 1.0 / 120;

/// Ends one loop of a step when half of it is done.
class EndsAmid : public Schedule {
  public:
    explicit EndsAmid(int loop) : loop_(loop) {}

    void for_each_range(std::size_t count, std::size_t grain,
                        FunctionRef<void(Range)> work) override {
        if (loop_-- == 0) {
            if (count > 1) work({0, count / 2});
            throw Stopped();
        }
        Schedule::for_each_range(count, grain, work);
    }

  private:
    int loop_;
};

/// Boxes, capsules and spheres that return what hits them, a few of them very fast.
Bodies shaken_heap(std::mt19937_64& random) {
    Bodies bodies = mixed_heap(40, 2);
    for (BodyType& type : bodies.types) type.restitution = 0.5;
    for (BodyId id = 0; id < bodies.size(); ++id)
        if (is_bounded(bodies.type_of(id).shape))
            bodies.velocity[id] = random_vector(random, id % 10 == 0 ? 300 : 20);
    return bodies;
}

/// Whatever loop it was, and where bodies are moved before the next step: what is kept from step to
/// step is of the last whole one.
TEST(Stop, AStepThatEndsAmidAnyLoopHasDoneNothing) {
    std::mt19937_64 random(5);
    PhysicsSettings settings;
    settings.substeps = 2;
    settings.sleeping = true;
    const Bodies heap = shaken_heap(random);
    Stepper world(heap, settings), straight(heap, settings);
    int stopped = 0;
    for (int loop = 0;; ++loop) {
        const Bodies before = world.bodies();
        const StepMemory memory = world.memory();
        EndsAmid ends(loop);
        try {
            world.step(kStep, ends);
        } catch (const Stopped&) {
            ++stopped;
            ASSERT_TRUE(same_bits(world.bodies(), before)) << loop;
            ASSERT_TRUE(same_values(world.memory(), memory)) << loop;
            const std::vector<Vec4> velocity = shaken_heap(random).velocity;
            for (Stepper* one : {&world, &straight}) {
                if (loop % 2 == 0) one->simulation().bodies.velocity = velocity;
                one->step(kStep);
            }
            ASSERT_TRUE(same_bits(world.bodies(), straight.bodies())) << loop;
            ASSERT_TRUE(same_values(world.memory(), straight.memory())) << loop;
            continue;
        }
        break;
    }
    EXPECT_GT(stopped, 40);
}

TEST(Stop, ASerialStepAsksBeforeEveryPiece) {
    std::mt19937_64 random(5);
    Stepper world(shaken_heap(random), {});
    Schedule serial;
    int questions = 0;
    const auto ask = [&] { return ++questions < 0; };
    const StopQuestion stop = ask;
    world.step(kStep, serial, &stop);
    EXPECT_GT(questions, 20);
    const Bodies before = world.bodies();
    const auto yes = [] { return true; };
    const StopQuestion now = yes;
    EXPECT_THROW(world.step(kStep, serial, &now), Stopped);
    EXPECT_TRUE(same_bits(world.bodies(), before));
    world.step(kStep, serial);
    EXPECT_FALSE(same_bits(world.bodies(), before)) << "it asks no more";
}

}  // namespace
}  // namespace tesserae
