// SPDX-License-Identifier: Apache-2.0
// Polychora and products of balls in scene files: what their keys make, and which bodies share it.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/plan/plan.hpp"
#include "tests/error_of.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

const BodyType& type_of(const Scene& scene, BodyId body) { return scene.bodies.type_of(body); }

TEST(ConvexShapes, StandAsTheFormatSays) {
    const Scene scene = load_text(R"(
[[body]]
shape = "duoprism"
polygons = [5, 7]
radii = [0.5, 2]
[[body]]
shape = "duocylinder"
radii = [0.5, 2]
[[body]]
shape = "spherinder"
radius = 0.5
height = 3
[[body]]
shape = "cubinder"
radius = 0.5
size = [2, 3]
)");
    const auto reaches = [&](BodyId body, const Vec4& direction, double expected) {
        const double reach = std::visit(
            [&](const auto& s) -> double { return direction.dot(support(s, direction)); },
            type_of(scene, body).shape);
        EXPECT_NEAR(reach, expected, 1e-12) << body << ": " << direction.transpose();
    };
    const Vec4 x = Vec4::UnitX(), y = Vec4::UnitY(), z = Vec4::UnitZ(), w = Vec4::UnitW();
    // Vertices on +x and +z, faces opposite.
    reaches(0, x, 0.5), reaches(0, -x, 0.5 * std::cos(M_PI / 5));
    reaches(0, z, 2), reaches(0, -z, 2 * std::cos(M_PI / 7));
    reaches(1, y, 0.5), reaches(1, w, 2), reaches(1, (x + y).normalized(), 0.5);
    reaches(2, y, 1.5), reaches(2, w, 0.5), reaches(2, (x + z + w).normalized(), 0.5);
    reaches(3, y, 0.5), reaches(3, z, 1), reaches(3, w, 1.5);
    // 1000 kg/m^4.
    const double contents[] = {
        0.5 * 5 * 0.25 * std::sin(2 * M_PI / 5) * 0.5 * 7 * 4 * std::sin(2 * M_PI / 7),
        M_PI * M_PI * 0.25 * 4, 4.0 / 3 * M_PI * 0.125 * 3, M_PI * 0.25 * 2 * 3};
    for (BodyId body = 0; body < 4; ++body)
        EXPECT_NEAR(type_of(scene, body).mass / (1000 * contents[body]), 1, 1e-13) << body;
    // Written out and read again it is the same scene.
    EXPECT_EQ(load_text(scene.effective).hash, scene.hash);
}

TEST(ConvexShapes, EqualOnesShareOneHull) {
    const auto prism = [](const char* more) {
        return std::string("[[body]]\nshape = \"duoprism\"\npolygons = [9, 9]\n") + more;
    };
    const Scene scene = load_text(prism("radii = [1, 1]\n") + prism("radii = [1, 1]\nmass = 3\n") +
                                  prism("radii = [1, 2]\n"));
    const auto hull = [&](BodyId body) {
        return std::get<Duoprism>(type_of(scene, body).shape).body.get();
    };
    EXPECT_EQ(hull(0), hull(1));
    EXPECT_NE(hull(0), hull(2));
    // It counts once.
    const Scene one = load_text(prism("radii = [1, 1]\n") + prism("radii = [1, 1]\n"));
    const std::uint64_t of_second = shared_bytes(std::get<Duoprism>(type_of(scene, 2).shape));
    const auto memory = [](const Scene& s) { return make_plan(s, 1).memory_bytes; };
    EXPECT_NEAR(double(memory(scene) - memory(one)), double(of_second), 20000);
}

TEST(ConvexShapes, ErrorsNameThePlace) {
    const auto expect_error = [](const std::string& text, const std::string& part) {
        const std::string error = tesserae::testing::error_of<InputError>([&] { load_text(text); });
        EXPECT_NE(error.find(part), std::string::npos) << error;
    };
    const std::string prism = "[[body]]\nshape = \"duoprism\"\n";
    expect_error(prism + "radii = [1, 1]\n", "polygons is missing");
    expect_error(prism + "polygons = [3, 2]\nradii = [1, 1]\n", "3:16: ");
    expect_error(prism + "polygons = [3.5, 3]\nradii = [1, 1]\n", "expected an integer from 3");
    expect_error(prism + "polygons = [40, 30]\nradii = [1, 1]\n",
                 "1200 vertices; expected at most");
    expect_error(prism + "polygons = [3, 3]\nradii = [1, 0]\n", "radii[1] = 0: ");
    expect_error("[[body]]\nshape = \"spherinder\"\nradius = 1\n", "height is missing");
    expect_error("[[body]]\nshape = \"spherinder\"\nradius = 1\nheight = 0\n", "4:10: ");
    expect_error("[[body]]\nshape = \"cubinder\"\nradius = 1\nsize = [1, 1, 1]\n",
                 "expected an array of 2 numbers");
    expect_error("[[body]]\nshape = \"duocylinder\"\nradius = 1\nradii = [1, 1]\n",
                 "unknown key; did you mean \"radii\"?");
}

}  // namespace
}  // namespace tesserae::scenes
