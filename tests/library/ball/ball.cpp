// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <tesserae/world.hpp>

int main() {
    tesserae::World world;
    world.add({.shape = tesserae::Hyperplane{}});
    const auto ball =
        world.add({.shape = tesserae::Hypersphere{0.5}}, {.position = {0, 2, 0, 0.2}});
    for (int step = 0; step < 480; ++step) world.step();
    const tesserae::Vec4 at = world.state(ball).position;
    std::printf("the ball is at %.17g %.17g %.17g %.17g\n", at[0], at[1], at[2], at[3]);
    for (const tesserae::ContactReading& touch : world.contacts())
        std::printf("%u touches %u: %.17g N s\n", touch.a, touch.b, touch.impulse);
}
