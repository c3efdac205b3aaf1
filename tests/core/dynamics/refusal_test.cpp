#include <gtest/gtest.h>

#include "core/dynamics/supported.hpp"
#include "core/dynamics/world.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

BodyType fixed(BodyType type) {
    type.fixed_position = type.fixed_rotation = true;
    return type;
}

std::string refusal(std::initializer_list<BodyType> types) {
    Bodies bodies;
    for (const BodyType& type : types) add(bodies, type);
    const auto reason = unsupported_contacts(bodies);
    if (reason) {
        EXPECT_THROW(World(bodies, PhysicsSettings{}), InputError);
    } else {
        EXPECT_NO_THROW(World(bodies, PhysicsSettings{}));
    }
    return reason.value_or("");
}

TEST(UnsupportedContacts, RefuseABoxThatCanMeetSomething) {
    const BodyType box = box_type({1, 1, 1, 1}), sphere = sphere_type(1);
    const BodyType floor = plane_type(Vec4::UnitY(), 0);
    EXPECT_NE(refusal({box, floor}).find("hyperbox against hyperplane"), std::string::npos);
    EXPECT_NE(refusal({box, floor}).find("not yet"), std::string::npos);
    EXPECT_NE(refusal({sphere, fixed(box)}).find("hypersphere against hyperbox"),
              std::string::npos);
    EXPECT_NE(refusal({fixed(sphere), box}), "");
    EXPECT_NE(refusal({box, fixed(box)}).find("hyperbox against hyperbox"), std::string::npos);
}

TEST(UnsupportedContacts, AllowWhatCannotMeet) {
    const BodyType box = box_type({1, 1, 1, 1}), sphere = sphere_type(1);
    const BodyType floor = plane_type(Vec4::UnitY(), 0);
    EXPECT_EQ(refusal({}), "");
    EXPECT_EQ(refusal({box}), "");
    EXPECT_EQ(refusal({fixed(box), fixed(box), floor, floor, fixed(sphere)}), "");
    EXPECT_EQ(refusal({sphere, sphere, fixed(sphere), floor}), "");
}

TEST(Simulation, RefusesArraysThatDoNotFit) {
    Bodies bodies;
    add(bodies, sphere_type(1));
    Bodies shorter = bodies, wrong_type = bodies;
    shorter.velocity.clear();
    wrong_type.type[0] = 1;
    EXPECT_THROW(World(shorter, PhysicsSettings{}), InputError);
    EXPECT_THROW(World(wrong_type, PhysicsSettings{}), InputError);
}

}  // namespace
}  // namespace tesserae
