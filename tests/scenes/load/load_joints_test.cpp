// SPDX-License-Identifier: Apache-2.0
// What the joints of scene files are, by closed forms. The balls have radius r and mass m, and so
// the inertia m r^2 / 3 in every plane.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

constexpr double kPi = std::numbers::pi;
/// Sums of a few products of numbers up to 10, of which decimals are rounded.
constexpr double kJointRounding = 1e-14;

const std::string kTwoBalls = R"(
[physics]
[[body]]
name = "left"
shape = "hypersphere"
radius = 1
mass = 2
position = [-1, 0.5, 0.25, 1]
rotation = { xy = 20, zw = -50, xw = 70 }
[[body]]
name = "right"
shape = "hypersphere"
radius = 0.5
mass = 3
position = [3, 0.5, 3.25, 1]
rotation = [{ xz = 130 }, { yw = 10 }]
)";

Scene scene_with(const std::string& keys) { return load_text(kTwoBalls + "[[joint]]\n" + keys); }
Scene scene_between(const std::string& keys) {
    return scene_with("a = \"left\"\nb = \"right\"\n" + keys);
}

RowVector values_in(const Scene& scene, const Bodies& bodies) {
    return coordinates_of(scene.joints.at(0), bodies).values;
}
/// The coordinates after the second body moved and turned.
RowVector values_after(const Scene& scene, const Vec4& way, const Bivector& turning = {},
                       const Vec4& about = Vec4::Zero()) {
    Bodies bodies = scene.bodies;
    const Rotor turn = exp(-0.5 * turning);
    bodies.rotor[1] = turn * bodies.rotor[1];
    bodies.position[1] = about + rotate(turn, bodies.position[1] - about) + way;
    return values_in(scene, bodies);
}

void expect_placed(const Scene& scene) {
    ASSERT_EQ(scene.joints.size(), 1U);
    EXPECT_LT(values_in(scene, scene.bodies).norm(), kJointRounding);
}

TEST(LoadJoints, PointIsOneOfBothBodies) {
    const Scene scene = scene_between("type = \"point\"\nanchor = [1, 2, 3, 4]\n");
    expect_placed(scene);
    const Joint& joint = scene.joints[0];
    EXPECT_EQ(joint.a, 0U);
    EXPECT_EQ(joint.b, 1U);
    EXPECT_EQ(joint.held, kAllHeld);
    EXPECT_FALSE(joint.collide);
    const auto& point = std::get<PointJoint>(joint.kind);
    const Bodies& bodies = scene.bodies;
    const Vec4 anchor(1, 2, 3, 4);
    EXPECT_LT((bodies.position[0] + rotate(bodies.rotor[0], point.on_a) - anchor).norm(), 1e-14);
    EXPECT_LT((bodies.position[1] + rotate(bodies.rotor[1], point.on_b) - anchor).norm(), 1e-14);
    EXPECT_EQ(scene.joint_names, std::vector<std::string>{"joint-0"});
}

TEST(LoadJoints, OfTheWorldMeasuresTheBodysMotion) {
    const Scene scene =
        scene_with("a = \"right\"\ntype = \"slider\"\naxis = [0, 0, 3, 4]\ncollide = true\n");
    expect_placed(scene);
    EXPECT_EQ(scene.joints[0].a, kWorld);
    EXPECT_EQ(scene.joints[0].b, 1U);
    EXPECT_TRUE(scene.joints[0].collide);
    EXPECT_EQ(scene.joints[0].held, kAllHeld & ~1);
    // 0.5 m along the axis (0, 0, 0.6, 0.8).
    const RowVector values = values_after(scene, {0, 0, 0.3, 0.4});
    EXPECT_NEAR(values[0], 0.5, kJointRounding);
    EXPECT_LT(values.tail(9).norm(), kJointRounding);
}

/// The centres are 5 m apart, along (0.8, 0, 0.6, 0).
TEST(LoadJoints, LinesHaveTheirPlacedLength) {
    for (const std::string type : {"distance", "rope", "spring"}) {
        const std::string keys = type == "spring" ? "frequency = 2\n" : "";
        const Scene scene = scene_between("type = \"" + type + "\"\n" + keys);
        expect_placed(scene);
        EXPECT_NEAR(std::get<LineJoint>(scene.joints[0].kind).length, 5, kJointRounding);
        EXPECT_NEAR(values_after(scene, {0.8, 0, 0.6, 0})[0], 1, kJointRounding);
    }
    const Joint distance = scene_between("type = \"distance\"\nlength = 5.000001\n").joints[0];
    EXPECT_EQ(std::get<LineJoint>(distance.kind).length, 5.000001);
    EXPECT_EQ(held_of(distance), 1);
    const Joint rope = scene_between("type = \"rope\"\nlength = 6\n").joints[0];
    EXPECT_EQ(std::get<LineJoint>(rope.kind).length, 6);
    EXPECT_EQ(rope.held, 0);
    ASSERT_EQ(rope.limits.size(), 1U);
    EXPECT_EQ(rope.limits[0].low, -kNoLimit);
    EXPECT_EQ(rope.limits[0].high, 0);
    // A rope may begin slack, without any length.
    const std::string ends = "anchor_a = [1, 2, 3, 4]\nanchor_b = [1, 2, 3, 4]\nlength = 2\n";
    EXPECT_EQ(std::get<LineJoint>(scene_between("type = \"rope\"\n" + ends).joints[0].kind).length,
              2);
    const Scene hung = scene_with("type = \"rope\"\na = \"right\"\nanchor_b = [3, 2.5, 3.25, 1]\n");
    expect_placed(hung);
    EXPECT_EQ(std::get<LineJoint>(hung.joints[0].kind).length, 2);
    EXPECT_EQ(std::get<LineJoint>(hung.joints[0].kind).on_a, Vec4(3, 2.5, 3.25, 1));
}

TEST(LoadJoints, SpringSwingsAtItsFrequency) {
    // Along the line of the centres only the masses count: 2 kg and 3 kg are 1.2 kg together.
    const double mass = 1.2, rate = 2 * kPi * 2;
    const Joint joint =
        scene_between("type = \"spring\"\nfrequency = 2\ndamping = 0.25\nlength = 4\n").joints[0];
    EXPECT_EQ(joint.held, 0);
    ASSERT_EQ(joint.drives.size(), 1U);
    EXPECT_NEAR(joint.drives[0].stiffness, mass * rate * rate, 1e-10);
    EXPECT_NEAR(joint.drives[0].damping, 2 * 0.25 * mass * rate, 1e-12);
    EXPECT_EQ(joint.drives[0].target, 0);
    EXPECT_FALSE(joint.drives[0].holds_speed);
    EXPECT_EQ(std::get<LineJoint>(joint.kind).length, 4);

    const Joint plain =
        scene_between("type = \"spring\"\nstiffness = 7\ndamping_force = 0.5\n").joints[0];
    EXPECT_EQ(plain.drives[0].stiffness, 7);
    EXPECT_EQ(plain.drives[0].damping, 0.5);
    EXPECT_EQ(plain.drives[0].most, kNoLimit);
}

TEST(LoadJoints, SpringWithoutLengthPullsAlikeInAllDirections) {
    const Scene scene = scene_between("type = \"spring\"\nfrequency = 2\nlength = 0\n");
    const Joint& joint = scene.joints[0];
    EXPECT_LT((values_in(scene, scene.bodies) - RowVector(Vec4(4, 0, 3, 0))).norm(),
              kJointRounding);
    EXPECT_EQ(joint.held, 0);
    ASSERT_EQ(joint.drives.size(), 4U);
    for (int i = 0; i < 4; ++i) {
        const JointDrive& drive = joint.drives[static_cast<std::size_t>(i)];
        EXPECT_EQ(drive.coordinate, i);
        EXPECT_NEAR(drive.stiffness, 1.2 * std::pow(2 * kPi * 2, 2), 1e-10);
        EXPECT_EQ(drive.damping, 0);
    }
}

TEST(LoadJoints, SpringOfAPointHasTheMeanMass) {
    const Joint joint = load_text(
                            "[[body]]\nshape = \"hypersphere\"\nradius = 1\nmass = 3\n"
                            "[[joint]]\ntype = \"spring\"\na = \"body-0\"\nfrequency = 1\n"
                            "anchor_a = [0, 2, 0, 0]\nanchor_b = [0, 2, 0, 0]\n")
                            .joints[0];
    // The inertia is 1 kg m^2. A force at 2 m has the response 1/3 + 4 in three directions, and 1/3
    // along the arm.
    const double mass = 4 / (3 * (1.0 / 3 + 4) + 1.0 / 3);
    ASSERT_EQ(joint.drives.size(), 4U);
    for (const JointDrive& drive : joint.drives)
        EXPECT_NEAR(drive.stiffness, mass * std::pow(2 * kPi, 2), 1e-12);
}

TEST(LoadJoints, WeldHoldsAll) {
    const Scene scene = scene_between("type = \"weld\"\nanchor = [1, 2, 3, 4]\n");
    expect_placed(scene);
    EXPECT_EQ(scene.joints[0].held, kAllHeld);
}

TEST(LoadJoints, HingeTurnsInItsPlane) {
    // The plane of (0, 1, 0, 0) and (0.8, 0, 0, 0.6), from the first toward the second.
    const Scene scene = scene_between(
        "type = \"hinge\"\nanchor = [1, 2, 3, 4]\nplane = [[0, 2, 0, 0], [4, 1, 0, 3]]\n"
        "limits = [-90, 45]\nmotor = { speed = 1.5, max = 20 }\n");
    expect_placed(scene);
    const Joint& joint = scene.joints[0];
    EXPECT_EQ(joint.held, kAllHeld & ~(1 << 4));
    ASSERT_EQ(joint.limits.size(), 1U);
    EXPECT_EQ(joint.limits[0].coordinate, 4);
    EXPECT_NEAR(joint.limits[0].low, -kPi / 2, 1e-15);
    EXPECT_NEAR(joint.limits[0].high, kPi / 4, 1e-15);
    ASSERT_EQ(joint.drives.size(), 1U);
    EXPECT_EQ(joint.drives[0].coordinate, 4);
    EXPECT_TRUE(joint.drives[0].holds_speed);
    EXPECT_EQ(joint.drives[0].speed, 1.5);
    EXPECT_EQ(joint.drives[0].most, 20);
    const Bivector plane = wedge(Vec4(0, 1, 0, 0), Vec4(0.8, 0, 0, 0.6));
    const RowVector values = values_after(scene, Vec4::Zero(), 0.3 * plane, Vec4(1, 2, 3, 4));
    EXPECT_NEAR(values[4], 0.3, kJointRounding);
    EXPECT_NEAR(values.norm(), 0.3, kJointRounding);
}

TEST(LoadJoints, HingesTakeThePlanesOfTheWorldByName) {
    const Scene scene = scene_with(
        "a = \"right\"\ntype = \"hinge\"\nanchor = [3, 0.5, 3.25, 1]\nplane = \"yw\"\n"
        "motor = { target = 30, frequency = 2, damping = 0.5 }\n");
    Bivector yw;
    yw.yw = 0.25;
    EXPECT_NEAR(values_after(scene, Vec4::Zero(), yw, Vec4(3, 0.5, 3.25, 1))[4], 0.25,
                kJointRounding);
    // A ball of 3 kg and 0.5 m that turns about its centre.
    const double inertia = 3 * 0.25 / 3, rate = 2 * kPi * 2;
    const JointDrive& drive = scene.joints[0].drives.at(0);
    EXPECT_FALSE(drive.holds_speed);
    EXPECT_NEAR(drive.target, kPi / 6, 1e-15);
    EXPECT_NEAR(drive.stiffness, inertia * rate * rate, 1e-12);
    EXPECT_NEAR(drive.damping, inertia * rate, 1e-13);
    EXPECT_EQ(drive.most, kNoLimit);
    // The same plane by its directions is the same scene.
    const auto effective_with = [](const std::string& plane) {
        return scene_between("type = \"hinge\"\nanchor = [1, 2, 3, 4]\nplane = " + plane + "\n")
            .effective;
    };
    EXPECT_EQ(effective_with("\"yw\""), effective_with("[[0, 1, 0, 0], [0, 0, 0, 1]]"));
    EXPECT_NE(effective_with("\"yw\""), effective_with("[[0, 0, 0, 1], [0, 1, 0, 0]]"));
}

TEST(LoadJoints, SwivelKeepsItsAxis) {
    const Scene scene =
        scene_between("type = \"swivel\"\nanchor = [1, 2, 3, 4]\naxis = [0, 0, -2, 0]\n");
    expect_placed(scene);
    const std::uint16_t free = kAllHeld & ~scene.joints[0].held;
    EXPECT_EQ(free, 1 << 7 | 1 << 8 | 1 << 9);
    // A turning that leaves z changes free coordinates only.
    Bivector turning;
    turning.xy = 0.2, turning.xw = -0.1, turning.yw = 0.15;
    const RowVector values = values_after(scene, Vec4::Zero(), turning, Vec4(1, 2, 3, 4));
    EXPECT_LT(values.head(7).norm(), kJointRounding);
    EXPECT_NEAR(values.norm(), norm(turning), kJointRounding);
}

TEST(LoadJoints, GeneralFreesWhatItLists) {
    const Scene scene = scene_between(
        "type = \"general\"\nanchor = [1, 2, 3, 4]\nrotation = { xy = 90 }\n"
        "free = [\"zw\", \"x\", \"yz\"]\n"
        "limits = { x = [0, 2], zw = [-180, 180] }\n"
        "spring = { yz = { stiffness = 5 }, x = { stiffness = 6, damping_force = 1 } }\n"
        "motor = { x = { target = 1.5, max = 9 } }\nbreak = { torque = 12 }\n");
    expect_placed(scene);
    const Joint& joint = scene.joints[0];
    EXPECT_EQ(joint.held, kAllHeld & ~(1 << 0 | 1 << 7 | 1 << 9));
    // The joint's x is the world's y.
    EXPECT_NEAR(values_after(scene, {0, 0.5, 0, 0})[0], 0.5, kJointRounding);
    ASSERT_EQ(joint.limits.size(), 2U);
    EXPECT_EQ(joint.limits[0].high, 2);
    EXPECT_NEAR(joint.limits[1].high, kPi, 1e-15);
    ASSERT_EQ(joint.drives.size(), 3U);
    EXPECT_EQ(joint.drives[0].stiffness, 6);
    EXPECT_EQ(joint.drives[1].target, 1.5);
    EXPECT_EQ(joint.drives[1].most, 9);
    // 5 Hz without swinging.
    const double mass = mass_along(joint, 0, scene.bodies), rate = 2 * kPi * 5;
    EXPECT_NEAR(joint.drives[1].stiffness, mass * rate * rate, 1e-10);
    EXPECT_NEAR(joint.drives[1].damping, 2 * mass * rate, 1e-12);
    EXPECT_EQ(joint.drives[2].coordinate, 7);
    EXPECT_EQ(joint.break_force, kNoLimit);
    EXPECT_EQ(joint.break_torque, 12);
}

TEST(LoadJoints, JoinsBodiesOfLattices) {
    const Scene scene =
        load_text(kTwoBalls +
                  "[[lattice]]\nname = \"grid\"\nshape = \"hypersphere\"\nradius = 0.1\n"
                  "count = [2, 2, 1, 1]\nspacing = 1\n"
                  "[[joint]]\ntype = \"distance\"\na = \"grid.3\"\nb = \"left\"\n");
    EXPECT_EQ(scene.joints[0].a, 5U);
    EXPECT_EQ(scene.joints[0].b, 0U);
}

/// Some joints of every type, with all keys.
const std::string kAllJoints = kTwoBalls + R"(
[[body]]
name = "floor"
shape = "hyperplane"
normal = [0, 1, 0, 0]
offset = -9
[[joint]]
type = "point"
a = "left"
anchor = [1, 2, 3, 4]
break = { force = 20 }
[[joint]]
name = "rod"
type = "distance"
a = "left"
b = "right"
collide = true
[[joint]]
type = "rope"
a = "left"
b = "right"
length = 9
[[joint]]
type = "spring"
a = "left"
b = "floor"
anchor_b = [0, -9, 0, 0]
frequency = 0.3
[[joint]]
type = "spring"
a = "left"
b = "right"
anchor_a = [0.1, 0.2, 0.3, 0.4]
stiffness = 3
length = 0
[[joint]]
type = "weld"
a = "right"
b = "floor"
anchor = [0, 0, 0, 0]
[[joint]]
type = "slider"
a = "left"
axis = [1, 2, 3, 4]
limits = [-1, 2]
motor = { target = 0.5 }
[[joint]]
name = "door"
type = "hinge"
a = "left"
b = "right"
anchor = [1, 2, 3, 4]
plane = [[1, 2, 3, 4], [4, 3, 2, 1]]
limits = [-30.1, 45.7]
motor = { speed = -2, max = 3 }
break = { force = 20, torque = 3.5 }
[[joint]]
type = "swivel"
a = "left"
b = "right"
anchor = [1, 2, 3, 4]
axis = [1, 2, 3, 4]
[[joint]]
type = "general"
a = "left"
b = "right"
anchor = [1, 2, 3, 4]
rotation = [{ xy = 30 }, { yw = 17 }]
free = ["yw", "w", "x"]
limits = { w = [-1, 1], yw = [-10, 10] }
spring = { x = { frequency = 3, damping = 0.1 }, yw = { stiffness = 2 } }
motor = { yw = { target = 5, frequency = 4, damping = 0.5, max = 2 } }
)";

TEST(LoadJoints, CanonicalTextIsItselfAgain) {
    const Scene scene = load_text(kAllJoints);
    EXPECT_EQ(scene.joints.size(), 10U);
    EXPECT_TRUE(scene.unused.empty()) << scene.unused.front();
    const Scene again = load_scene_text("again.toml", scene.effective, {});
    EXPECT_EQ(again.effective, scene.effective);
    EXPECT_EQ(again.hash, scene.hash);
    EXPECT_EQ(again.motion_hash, scene.motion_hash);
    EXPECT_EQ(again.joint_names, scene.joint_names);
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
        EXPECT_EQ(again.joints[i].held, scene.joints[i].held);
        EXPECT_EQ(coordinates_of(again.joints[i], again.bodies).values,
                  coordinates_of(scene.joints[i], scene.bodies).values);
    }
}

TEST(LoadJoints, ChangeTheMotionsHashButForTheirNames) {
    const Scene scene = load_text(kAllJoints);
    const auto with = [](const std::string& set) { return load_text(kAllJoints, {set}); };
    EXPECT_EQ(with("joint.door.name=\"gate\"").motion_hash, scene.motion_hash);
    EXPECT_NE(with("joint.door.name=\"gate\"").hash, scene.hash);
    for (const char* set :
         {"joint.door.limits=[-30.1, 45.8]", "joint.door.collide=true", "joint.rod.b=\"floor\"",
          "joint.joint-2.length=10.0", "joint.door.break.force=21", "joint.door.motor.speed=2"}) {
        const bool is_world = std::string(set) == "joint.rod.b=\"floor\"";
        EXPECT_NE(
            load_text(kAllJoints,
                      is_world ? std::vector<std::string>{set, "joint.rod.anchor_b=[0, 0, 0, 0]"}
                               : std::vector<std::string>{set})
                .motion_hash,
            scene.motion_hash)
            << set;
    }
}

TEST(LoadJoints, TakeOverrides) {
    const auto door_with = [](const std::vector<std::string>& sets) {
        return load_text(kAllJoints, sets).joints[7];
    };
    EXPECT_EQ(door_with({"joint.door.motor.max=8"}).drives[0].most, 8);
    EXPECT_NEAR(door_with({"joint.door.limits=[-1, 18]"}).limits[0].high, kPi / 10, 1e-15);
    // A target stands instead of a speed, a stiffness instead of a frequency.
    EXPECT_FALSE(door_with({"joint.door.motor.target=8"}).drives[0].holds_speed);
    EXPECT_EQ(load_text(kAllJoints, {"joint.joint-3.stiffness=8"}).joints[3].drives[0].stiffness,
              8);
    EXPECT_NE(error_of(kAllJoints, {"joint.dor.limits=[-1, 18]"})
                  .find("no joint is called \"dor\"; did you mean \"door\"?"),
              std::string::npos);
    EXPECT_NE(error_of(kAllJoints, {"joint.limits=1"}).find("expected joint.NAME.KEY=VALUE"),
              std::string::npos);
}

TEST(LoadJoints, OfAStillChangeNothing) {
    std::string still = kAllJoints;
    still.erase(still.find("[physics]"), 9);
    const Scene scene = load_text(still);
    EXPECT_EQ(scene.joints.size(), 10U);
    ASSERT_EQ(scene.unused.size(), 10U);
    EXPECT_NE(
        scene.unused[1].find("joint 1 \"rod\": type = \"distance\": changes nothing: a still"),
        std::string::npos)
        << scene.unused[1];
    const Scene world =
        scene_with("a = \"left\"\ntype = \"slider\"\naxis = [1, 0, 0, 0]\ncollide = true\n");
    ASSERT_EQ(world.unused.size(), 1U);
    EXPECT_NE(world.unused[0].find("collide = true: changes nothing"), std::string::npos);
}

}  // namespace
}  // namespace tesserae::scenes
