// SPDX-License-Identifier: Apache-2.0
#include "parallel/world_threads.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace tesserae
