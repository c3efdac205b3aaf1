// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_set.hpp"

#include <gtest/gtest.h>

#include "core/shape/hypersphere.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

TEST(LightSet, FirstSphereIsThatOfTryingAll) {
    // Small and large ones, one in another, in one place, touching the origin, far away.
    Random random(551);
    int met = 0;
    for (int round = 0; round < 300; ++round) {
        Lights lights;
        const auto count = round % 40;
        const double spread = round % 3 == 0 ? 1e6 : 5;
        for (int i = 0; i < count; ++i) {
            const Vec4 place =
                i % 7 == 6 ? lights.spheres.back().position : Vec4(random_vector(random, spread));
            const double radius =
                i % 14 == 6 ? lights.spheres.back().radius : spread * uniform(random, 0.01, 0.4);
            lights.spheres.push_back({place, radius, Color::Ones()});
        }
        const LightSet set(lights, Vec4::Zero());
        for (int k = 0; k < 50; ++k) {
            Ray ray = {random_vector(random, spread), random_direction(random)};
            if (k % 5 == 0) ray.limit = uniform(random, 0, spread);
            LightSet::Seen expected;
            for (std::uint32_t i = 0; i < set.spheres.size(); ++i) {
                const double t = ray_hit(Hypersphere{set.spheres[i].radius},
                                         ray.origin - set.spheres[i].position, ray.direction);
                if (t < ray.limit && t < expected.distance) expected = {i, t};
            }
            const LightSet::Seen seen = set.first_sphere(ray);
            ASSERT_EQ(seen.sphere, expected.sphere) << round;
            ASSERT_EQ(seen.distance, expected.distance) << round;
            met += seen.sphere != LightSet::kNone;
        }
    }
    EXPECT_GT(met, 800);
}

}  // namespace
}  // namespace tesserae::render
