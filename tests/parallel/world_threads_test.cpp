// SPDX-License-Identifier: Apache-2.0
#include "parallel/world_threads.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "core/error.hpp"
#include "tests/core/world/random_world.hpp"

namespace tesserae {
namespace {

using namespace testing;

/// Steps a world through changes of all kinds, and returns its bytes.
std::string lived(World world) {
    std::mt19937_64 random(7);
    for (int round = 0; round < 12; ++round) {
        for (int i = 0; i < 20; ++i) world.step();
        const std::vector<BodyId> ids(world.ids().begin(), world.ids().end());
        world.remove(ids[1 + static_cast<std::size_t>(round) % (ids.size() - 1)]);
        for (int i = 0; i < 3; ++i)
            world.add(
                sphere_type(0.3, 1, 0.5),
                {{uniform(random, -1, 1), 4, uniform(random, -1, 1), 0}, {}, Vec4::Zero(), {}});
        world.apply_force(world.ids().back(), {0, 20, 0, 3}, Vec4::Zero());
        if (round == 6) world.remove_joint(world.joint_ids()[0]);
        if (round == 9) world.set_gravity({1, -10, 0, 0});
    }
    return world.save();
}

TEST(WorldThreads, AWorldHasTheSameBitsOnAnyNumberOfThreads) {
    const std::string serial = lived(busy_world());
    for (const int count : {1, 2, 4}) {
        World world = busy_world();
        world.set_workers(threads(count));
        EXPECT_EQ(lived(world), serial) << count;
    }
}

TEST(WorldThreads, AreCounted) {
    EXPECT_EQ(threads(3)->count(), 3);
    EXPECT_GE(threads()->count(), 1);
    EXPECT_THROW(threads(-1), InputError);
    EXPECT_THROW(threads(1025), InputError);
}

TEST(WorldThreads, SeveralWorldsShareThem) {
    const std::string alone = lived(busy_world());
    const std::shared_ptr<Workers> shared = threads(2);
    std::string bytes[2];
    std::thread other([&] {
        World world = busy_world();
        world.set_workers(shared);
        bytes[0] = lived(std::move(world));
    });
    World world = busy_world();
    world.set_workers(shared);
    bytes[1] = lived(std::move(world));
    other.join();
    EXPECT_EQ(bytes[0], alone);
    EXPECT_EQ(bytes[1], alone);
}

/// A heap that is one large island, into which two bodies fly that are fast.
World hit_world() {
    World world;
    world.add(plane_type(Vec4::UnitY(), 0, 0.5));
    for (int i = 0; i < 4 * 4 * 4 * 6; ++i)
        world.add(
            sphere_type(0.5, 1, 0.5),
            {{i % 4 - 1.5, i / 64 + 0.5, i / 4 % 4 - 1.5, i / 16 % 4 - 1.5}, {}, Vec4::Zero(), {}});
    BodyType box = box_type(Vec4::Constant(0.6), 3);
    box.restitution = 0.5, box.rolling_friction = 0.01;
    for (const double side : {-1, 1})
        world.add(box, {{side * 8, 2, 0.2, 0.1}, {}, {side * -800, 0, 0, 0}, {}});
    return world;
}

/// Stops every step at up to so many of its questions, and then lets it end.
/// @param stops   0: at each
void expect_unharmed(World world, int steps, int stops) {
    const double dt = 1 / world.settings().steps_per_second;
    int stopped = 0;
    for (int step = 0; step < steps; ++step) {
        const std::string before = world.save();
        World straight = world;
        std::atomic<int> questions = 0;
        straight.step(dt, [&] { return ++questions < 0; });
        const int all = questions, most = stops == 0 ? all : std::min(stops, all);
        // The copy has nothing kept to make its step faster, and may ask more.
        bool has_ended = false;
        for (int k = 0; k <= most && !has_ended; ++k) {
            const int last = k < most ? all * k / most : 2 * all + 1000;
            std::atomic<int> asked = 0;
            try {
                world.step(dt, [&] { return ++asked > last; });
                has_ended = true;
            } catch (const Stopped&) {
                ++stopped;
                ASSERT_TRUE(world.save() == before) << "step " << step << ", question " << last;
            }
        }
        ASSERT_TRUE(has_ended);
        ASSERT_TRUE(same_worlds(world, straight)) << "step " << step;
    }
    EXPECT_GT(stopped, 10 * steps);
}

TEST(WorldThreads, AStepThatIsStoppedLeavesTheWorldAsItWas) {
    for (const int count : {0, 1, 3}) {
        World busy = busy_world(), hit = hit_world();
        if (count > 0) busy.set_workers(threads(count)), hit.set_workers(threads(count));
        for (int i = 0; i < 100; ++i) busy.step();  // to where the stack is about to sleep
        expect_unharmed(busy, 8, 25);
        expect_unharmed(hit, 3, 25);
    }
}

TEST(WorldThreads, AStepIsAskedForAStopManyTimes) {
    World world = hit_world();
    world.set_workers(threads(2));
    std::atomic<int> questions = 0;
    for (int i = 0; i < 3; ++i) world.step(0.004, [&] { return ++questions < 0; });
    EXPECT_GT(questions, 300);
}

}  // namespace
}  // namespace tesserae
