// SPDX-License-Identifier: Apache-2.0
// What the keys of bodies mean.
#include <gtest/gtest.h>

#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

/// In a table all planes at once, in an array one after the other about the world's axes.
TEST(LoadBodies, TurnsOneAfterTheOther) {
    const auto rotor_of = [](const std::string& rotation) {
        return load_text("[[body]]\nshape = \"hypersphere\"\nradius = 1\nrotation = " + rotation)
            .bodies.rotor[0];
    };
    const auto turned = [&](const std::string& rotation, const Vec4& point) {
        return rotate(rotor_of(rotation), point);
    };
    const Vec4 x = Vec4::UnitX(), y = Vec4::UnitY(), z = Vec4::UnitZ(), w = Vec4::UnitW();
    EXPECT_LT((turned("[{ xy = 90 }, { yz = 90 }]", x) - z).norm(), 1e-15);
    EXPECT_LT((turned("[{ yz = 90 }, { xy = 90 }]", x) - y).norm(), 1e-15);
    EXPECT_LT((turned("[{ xy = 90 }, { yz = 90 }, { zw = 90 }]", x) - w).norm(), 1e-15);
    EXPECT_GT((turned("{ xy = 90, yz = 90 }", x) - z).norm(), 0.1) << "127 degrees in one plane";
    EXPECT_EQ(rotor_of("[{ xy = 30, zw = 15 }]"), rotor_of("{ xy = 30, zw = 15 }"));
    // The canonical text of one turn is as ever, and of several can be read again.
    const auto text = [](const std::string& rotation) {
        return load_text("[[body]]\nshape = \"hypersphere\"\nradius = 1\nrotation = " + rotation)
            .effective;
    };
    EXPECT_EQ(text("[{ xy = 30 }]"), text("{ xy = 30 }"));
    EXPECT_EQ(load_text(text("[{ xy = 30 }, { xw = 5 }]")).effective,
              text("[{ xy = 30 }, { xw = 5 }]"));
    for (const char* wrong : {"[]", "3", "[3]", "[{ xy = 1 }, { qq = 1 }]", "[[1]]"})
        EXPECT_NE(
            error_of(std::string("[[body]]\nshape = \"hypersphere\"\nradius = 1\nrotation = ") +
                     wrong),
            "")
            << wrong;
    const std::string spin =
        error_of("[[body]]\nshape = \"hypersphere\"\nradius = 1\nangular_velocity = 3\n");
    EXPECT_NE(spin.find("rad/s"), std::string::npos) << spin;
    EXPECT_EQ(spin.find("degrees"), std::string::npos) << spin;
}

}  // namespace
}  // namespace tesserae::scenes
