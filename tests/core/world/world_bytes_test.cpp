// SPDX-License-Identifier: Apache-2.0
#include "core/world/world_bytes.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "core/error.hpp"
#include "tests/core/world/random_world.hpp"

namespace tesserae {
namespace {

using namespace testing;

/// What a World::load of these bytes throws, or "".
std::string error_of(const std::string& bytes) {
    try {
        World::load(bytes);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// The bytes with the checksum that fits them, as someone would write who means harm.
std::string sealed(std::string bytes) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (std::size_t i = 0; i + 8 < bytes.size(); ++i)
        hash = (hash ^ static_cast<std::uint8_t>(bytes[i])) * 0x100000001b3;
    std::memcpy(bytes.data() + bytes.size() - 8, &hash, 8);
    return bytes;
}

TEST(WorldBytes, ALoadedWorldGoesOnWithTheSameBits) {
    World world = busy_world();
    for (const int steps : {0, 1, 100, 300}) {
        for (int i = 0; i < steps; ++i) world.step();
        world.apply_torque(world.ids().back(), {0, 0, 1, 0, 0, 0});
        World loaded = World::load(world.save());
        EXPECT_TRUE(same_worlds(world, loaded)) << steps;
        for (int i = 0; i < 60; ++i) world.step(), loaded.step();
        EXPECT_TRUE(same_worlds(world, loaded)) << steps;
        EXPECT_EQ(world.contacts().size(), loaded.contacts().size());
    }
    world.remove(world.ids()[3]);
    world.remove_joint(world.joint_ids()[1]);
    World loaded = World::load(world.save());
    EXPECT_EQ(loaded.add(sphere_type(1), {{0, 100, 0, 0}, {}, Vec4::Zero(), {}}),
              world.add(sphere_type(1), {{0, 100, 0, 0}, {}, Vec4::Zero(), {}}));
    for (int i = 0; i < 60; ++i) world.step(), loaded.step();
    EXPECT_TRUE(same_worlds(world, loaded));
}

TEST(WorldBytes, KeepAllShapesAndJoints) {
    World world(without_gravity());
    Polychoron points;
    points.regular = RegularPolychoron::kNone;
    points.vertices = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}, {-1, -1, -1, -1}};
    Duoprism prism;
    prism.polygons = {3, 5};
    Polychoron cell;
    cell.regular = RegularPolychoron::k24Cell;
    const Shape shapes[] = {Hypersphere{2}, Hypercapsule{1, 2}, Hyperbox{}, points,       cell,
                            prism,          Spherinder{},       Cubinder{}, Duocylinder{}};
    double x = 0;
    for (const Shape& shape : shapes) {
        BodyType type;
        type.shape = shape;
        world.add(type, {{x += 10, 0, 0, 0}, {}, Vec4::Zero(), {}});
    }
    world.add(plane_type({0, 2, 0, 0}, -50));
    for (const auto type :
         {JointType::kPoint, JointType::kDistance, JointType::kRope, JointType::kWeld,
          JointType::kSlider, JointType::kHinge, JointType::kSwivel}) {
        JointDescription joint{.type = type};
        joint.anchor = {10, 0, 0, 0};
        world.join(joint, static_cast<BodyId>(type), static_cast<BodyId>(type) + 1);
    }
    JointDescription general{.type = JointType::kGeneral};
    general.free = 0x3ff;
    general.limits[1] = Vec2(-1, 2);
    general.springs[2] = JointSpring{.frequency = 2.0};
    general.motors[5] = JointMotor{.target = 0.5, .max = 3.0};
    world.join(general, 8);
    World loaded = World::load(world.save());
    for (const BodyId id : world.ids()) EXPECT_TRUE(world.type(id) == loaded.type(id)) << id;
    for (int i = 0; i < 20; ++i) world.step(), loaded.step();
    EXPECT_TRUE(same_worlds(world, loaded));
}

TEST(WorldBytes, WhatIsDamagedIsToldAndNothingElse) {
    World world = busy_world();
    for (int i = 0; i < 200; ++i) world.step();
    const std::string bytes = world.save();
    EXPECT_NE(error_of("no world").find("not the bytes of a saved world"), std::string::npos);
    std::mt19937_64 random(1);
    std::uniform_int_distribution<std::size_t> anywhere(0, bytes.size() - 1);
    for (int i = 0; i < 200; ++i) {
        std::string damaged = bytes;
        damaged[anywhere(random)] ^= static_cast<char>(1 << i % 8);
        EXPECT_NE(error_of(damaged), "") << i;
        EXPECT_NE(error_of(bytes.substr(0, anywhere(random))), "") << i;
    }
    std::string other = bytes;
    other[std::string("tesserae world 1\n").size()] ^= 1;
    EXPECT_NE(error_of(sealed(other)).find("motion version"), std::string::npos);
}

/// With a checksum that fits: what is still taken steps without a crash.
TEST(WorldBytes, WhatMeansHarmDoesNone) {
    World world = busy_world();
    for (int i = 0; i < 200; ++i) world.step();
    const std::string bytes = world.save();
    std::mt19937_64 random(2);
    std::uniform_int_distribution<std::size_t> anywhere(21, bytes.size() - 9);
    int refused = 0, stepped = 0;
    for (int i = 0; i < 1500; ++i) {
        std::string damaged = bytes;
        const std::size_t at = anywhere(random);
        const std::uint64_t values[] = {0, ~std::uint64_t{0}, 0x7ff8000000000000,
                                        0x7fefffffffffffff, random()};
        const std::size_t length = std::min<std::size_t>(i % 2 == 0 ? 8 : 1, bytes.size() - 8 - at);
        std::memcpy(damaged.data() + at, &values[static_cast<std::size_t>(i) % 5], length);
        try {
            World loaded = World::load(sealed(damaged));
            // A body of 1e9 m/s in a heap takes half a minute to be stopped.
            double fastest = 0;
            for (const BodyId id : loaded.ids()) {
                const BodyState state = loaded.state(id);
                fastest = std::max({fastest, state.velocity.norm(), norm(state.angular_velocity)});
            }
            for (int step = 0; step < 2 && fastest < 1e4; ++step) loaded.step();
            stepped += fastest < 1e4 ? 1 : 0;
            loaded.contacts();
        } catch (const InputError&) {
            ++refused;
        } catch (const RunError&) {  // a body is too fast
        }
    }
    EXPECT_GT(refused, 300);
    EXPECT_GT(stepped, 300);
}

}  // namespace
}  // namespace tesserae
