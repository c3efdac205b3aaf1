// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

TEST(Simulation, RefusesArraysThatDoNotFit) {
    Bodies bodies;
    add(bodies, sphere_type(1));
    Bodies shorter = bodies, wrong_type = bodies;
    shorter.velocity.clear();
    wrong_type.type[0] = 1;
    EXPECT_THROW(Stepper(shorter, PhysicsSettings{}), InputError);
    EXPECT_THROW(Stepper(wrong_type, PhysicsSettings{}), InputError);
}

}  // namespace
}  // namespace tesserae
