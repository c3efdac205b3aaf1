#include <gtest/gtest.h>

#include "core/dynamics/world.hpp"
#include "parallel/parallel_world.hpp"
#include "parallel/threads.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae::parallel {
namespace {

using namespace tesserae::testing;

/// The heap of spheres with every third one a box and every third a capsule, turning.
Bodies mixed_heap() {
    Bodies bodies = heap_of_spheres(90, 3);
    for (BodyId id = 0; id < bodies.size(); ++id) {
        BodyType& type = bodies.types[bodies.type[id]];
        if (!is_bounded(type.shape)) continue;
        const double r = std::get<Hypersphere>(type.shape).radius;
        if (id % 3 == 0) type.shape = Hyperbox{{r, 1.2 * r, 1.1 * r, 0.8 * r}};
        if (id % 3 == 1) type.shape = Hypercapsule{0.5 * r, r};
        bodies.rotor[id] = exp({0.1 * id, 0.2, 0.05 * id, -0.1, 0.3, 0.02 * id});
        bodies.angular_velocity[id] = {1, -0.5, 0.3, 0.2, -1, 0.7};
    }
    return bodies;
}

TEST(MixedHeap, HasTheBitsOfTheSerialWorldAndStaysAboveTheFloor) {
    constexpr int kSteps = 200;
    constexpr double kStep = 1.0 / 240;
    World serial(mixed_heap(), PhysicsSettings{});
    std::uint64_t contacts = 0;
    const Bodies& end = serial.bodies();
    for (int i = 0; i < kSteps; ++i) {
        contacts += serial.step(kStep).contacts;
        for (BodyId id = 0; id < end.size(); ++id) {
            const Shape& shape = end.type_of(id).shape;
            if (!is_bounded(shape)) continue;
            const auto extents = [&](const Mat4& R) {
                return std::visit([&](const auto& s) { return half_extents(s, R); }, shape);
            };
            // Nothing sinks into the floor by more than a twentieth of its least size.
            const double least = 2 * extents(Mat4::Identity()).minCoeff();
            const double lowest = end.position[id][1] - extents(to_matrix(end.rotor[id]))[1];
            ASSERT_GT(lowest, -0.05 * least) << id << " in step " << i;
        }
    }
    EXPECT_GT(contacts, 5000u);
    for (int count : {1, 2, 3}) {
        Threads threads(count);
        ParallelWorld world(mixed_heap(), PhysicsSettings{});
        threads.run([&] {
            for (int i = 0; i < kSteps; ++i) world.step(kStep);
        });
        EXPECT_TRUE(same_bits(world.bodies(), end)) << count;
        EXPECT_TRUE(same_values(world.memory(), serial.memory())) << count;
    }
}

}  // namespace
}  // namespace tesserae::parallel
