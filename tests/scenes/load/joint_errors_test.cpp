// SPDX-License-Identifier: Apache-2.0
// What is refused of [[joint]], and how it is said.
#include <gtest/gtest.h>

#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

/// Its first joint's table begins in line 34.
const std::string kJointBodies = R"([physics]
[[body]]
name = "left"
shape = "hypersphere"
radius = 1
position = [-1, 0, 0, 0]
[[body]]
name = "right"
shape = "hypersphere"
radius = 1
position = [3, 0, 3, 0]
[[body]]
name = "wall"
shape = "hyperbox"
size = [1, 1, 1, 1]
position = [0, 9, 0, 0]
fixed = ["position", "rotation"]
[[body]]
name = "floor"
shape = "hyperplane"
normal = [0, 1, 0, 0]
offset = -9
[[body]]
name = "pinned"
shape = "hypersphere"
radius = 1
position = [5, 5, 5, 5]
fixed = ["position"]
[[lattice]]
name = "grid"
shape = "hypersphere"
radius = 0.1
count = [2, 2, 1, 1]
spacing = 1
)";

const std::string kAnchor = "anchor = [1, 2, 3, 4]\n";
const std::string kPair = "a = \"left\"\nb = \"right\"\n";
const std::string kHinge = "type = \"hinge\"\n" + kPair + kAnchor;
const std::string kXyHinge = kHinge + "plane = \"xy\"\n";
const std::string kGeneral = "type = \"general\"\n" + kPair + kAnchor;

std::string error_of_joint(const std::string& keys) {
    return error_of(kJointBodies + "[[joint]]\n" + keys);
}

struct WrongJoint {
    std::string keys;   ///< of the only joint
    std::string error;  ///< a part of the message
};
void expect_refused(const std::vector<WrongJoint>& cases) {
    for (const auto& [keys, error] : cases)
        EXPECT_NE(error_of_joint(keys).find(error), std::string::npos)
            << keys << "gives\n"
            << error_of_joint(keys) << "\nnot\n"
            << error;
}

TEST(JointErrors, NameThePlaceTheKeyAndWhatWasExpected) {
    EXPECT_EQ(error_of_joint("name = \"door\"\ntype = \"hing\"\n" + kPair + kAnchor),
              "test.toml:37:8: joint 0 \"door\": type = \"hing\": expected one of \"point\", "
              "\"distance\", \"rope\", \"spring\", \"weld\", \"slider\", \"hinge\", \"swivel\", "
              "\"general\"; did you mean \"hinge\"?");
}

TEST(JointErrors, OfTypesAndKeys) {
    expect_refused({
        {kPair, "type is missing; expected one of \"point\" \"distance\""},
        {kXyHinge + "moter = { speed = 1 }\n",
         "moter = { speed = 1 }: unknown table; did you mean \"motor\"?"},
        {"type = \"weld\"\n" + kPair, "anchor is missing"},
        {kHinge, "plane is missing; expected the plane to turn in"},
        {"type = \"slider\"\n" + kPair, "axis is missing"},
        {"type = \"slider\"\naxis = [0, 0, 0, 0]\n" + kPair, "expected a direction, not zero"},
        {"type = \"weld\"\nname = \"\"\n" + kPair + kAnchor, "expected 1 to 256 bytes"},
        {"type = \"weld\"\n" + kPair + kAnchor + "limits = [0, 1]\n", "unknown key"},
        {kHinge + "plane = \"yx\"\n", "did you mean \"xy\"?"},
        {kHinge + "plane = [[1, 0, 0, 0]]\n", "has 1 directions; expected two"},
        {kHinge + "plane = [[1, 2, 0, 0], [-2, -4, 0, 0]]\n", "the two directions are parallel"},
        {kHinge + "plane = [[1, 2, 0, 0], [0, 0, 0, 0]]\n", "expected two directions, not zero"},
    });
}

TEST(JointErrors, OfBodies) {
    const std::string weld = "type = \"weld\"\n" + kAnchor;
    expect_refused({
        {weld, "a is missing; expected a body's name"},
        {weld + "a = \"lefd\"\n", "no body is called so; did you mean \"left\"?"},
        {weld + "a = \"left\"\nb = \"rigth\"\n", "b = \"rigth\": no body is called so; did you"},
        {weld + "a = \"left\"\nb = \"world\"\n", "a joint without b joins a to the world"},
        {weld + "a = \"grid\"\n",
         "the lattice has 4 bodies; expected one of them, \"grid.0\" to \"grid.3\""},
        {weld + "a = \"grid.4\"\n", "the lattice has 4 bodies"},
        {weld + "a = \"left.0\"\n", "no body is called so"},
        {weld + "a = \"left\"\nb = \"left\"\n", "b = \"left\": is body a too"},
        {weld + "a = \"wall\"\n", "a = \"wall\": is fixed; expected a body that may move"},
        {weld + "a = \"floor\"\n", "a = \"floor\": is a hyperplane"},
        {weld + "a = \"wall\"\nb = \"floor\"\n",
         "b = \"floor\": is a hyperplane, and a is fixed; expected that one of them may move"},
    });
}

TEST(JointErrors, OfLengths) {
    const std::string same = "anchor_a = [1, 1, 1, 1]\nanchor_b = [1, 1, 1, 1]\n";
    expect_refused({
        {"type = \"distance\"\na = \"left\"\n", "anchor_b is missing"},
        {"type = \"distance\"\na = \"left\"\nb = \"floor\"\n", "anchor_b is missing"},
        {"type = \"distance\"\n" + kPair + "length = 5.00001\n",
         "length = 5.00001: the anchors are placed 5 m apart; expected this, or no length"},
        {"type = \"rope\"\n" + kPair + "length = 4.9\n",
         "length = 4.9: the anchors are placed 5 m apart; expected no less"},
        {"type = \"distance\"\n" + kPair + same, "both anchors are at one point"},
        {"type = \"distance\"\nlength = 1\n" + kPair + same, "both anchors are at one point"},
        {"type = \"rope\"\n" + kPair + same, "both anchors are at one point"},
        {"type = \"spring\"\nstiffness = 2\nlength = 1\n" + kPair + same,
         "length = 1: both anchors are at one point"},
        {"type = \"rope\"\nlength = 0\n" + kPair, "expected a finite number > 0"},
    });
    EXPECT_EQ(error_of_joint("type = \"spring\"\nstiffness = 2\n" + kPair + same), "");
    EXPECT_EQ(error_of_joint("type = \"distance\"\nlength = 5.000001\n" + kPair), "");
}

TEST(JointErrors, OfSprings) {
    const std::string spring = "type = \"spring\"\n" + kPair;
    expect_refused({
        {spring, "frequency is missing; expected one in Hz, or a stiffness in N/m"},
        {spring + "damping = 1\n", "frequency is missing"},
        {spring + "frequency = 1\nstiffness = 2\n",
         "stiffness = 2: there is a frequency too; expected only one of them"},
        {spring + "frequency = 1\ndamping_force = 2\n", "damping_force = 2: goes with a stiffness"},
        {spring + "stiffness = 1\ndamping = 2\n", "damping = 2: goes with a frequency"},
        {spring + "frequency = 0\n", "expected a finite number > 0"},
        {spring + "frequency = 1\ndamping = -1\n", "expected a finite number >= 0"},
        {"type = \"spring\"\nfrequency = 1\na = \"pinned\"\nanchor_b = [5, 5, 5, 7]\n",
         "frequency = 1: what is joined cannot move so"},
    });
}

TEST(JointErrors, OfLimitsAndMotors) {
    const std::string slider = "type = \"slider\"\naxis = [1, 0, 0, 0]\n" + kPair;
    expect_refused({
        {slider + "limits = [1, 1]\n", "limits = [1, 1]: expected [low, high] with low < high"},
        {slider + "limits = [2, 1]\n", "expected [low, high] with low < high"},
        {slider + "limits = [1, 2]\n", "expected limits with 0 between them"},
        {slider + "limits = [-2, -1]\n", "expected limits with 0 between them"},
        {slider + "limits = [-2]\n", "has 1 values"},
        {kXyHinge + "limits = [-181, 20]\n", "expected angles from -180 to 180 degrees"},
        {kXyHinge + "motor = { max = 3 }\n", "motor: speed is missing; expected a speed, or a"},
        {kXyHinge + "motor = { speed = 1, target = 3 }\n", "target = 3: there is a speed too"},
        {kXyHinge + "motor = { speed = 1, frequency = 3 }\n", "frequency = 3: goes with a target"},
        {kXyHinge + "motor = { target = 190 }\n", "expected a number >= -180"},
        {kXyHinge + "motor = { speed = 1, max = 0 }\n", "expected a finite number > 0"},
        {kXyHinge + "motor = 3\n", "expected a table such as { speed = 1, max = 10 }"},
        {kXyHinge + "motor = { sped = 1 }\n", "unknown key; did you mean \"speed\"?"},
    });
    EXPECT_EQ(error_of_joint(slider + "limits = [0, 500]\n"), "");
}

TEST(JointErrors, OfGeneralJoints) {
    expect_refused({
        {kGeneral, "free is missing"},
        {kGeneral + "free = []\n", "expected at least one coordinate"},
        {kGeneral + "free = [\"yx\"]\n", "free[0] = \"yx\": expected one of \"x\", \"y\""},
        {kGeneral + "free = [\"x\", \"y\", \"x\"]\n", "free[2] = \"x\": is listed twice"},
        {kGeneral + "free = [\"x\"]\nlimits = { y = [-1, 1] }\n",
         "limits: y = [-1, 1]: this coordinate is held; expected one that is free"},
        {kGeneral + "free = [\"x\"]\nspring = { xy = { frequency = 1 } }\n", "is held"},
        {kGeneral + "free = [\"x\"]\nmotor = { xy = { speed = 1 } }\n", "is held"},
        {kGeneral + "free = [\"x\"]\nmotor = { q = { speed = 1 } }\n", "unknown table"},
        {kGeneral + "free = [\"x\"]\nspring = { x = {} }\n", "frequency is missing"},
        {kGeneral + "free = [\"x\"]\nspring = { x = { frequency = 1, stiffness = 1 } }\n",
         "spring: x: stiffness = 1: there is a frequency too"},
        {kGeneral + "free = [\"xy\"]\nlimits = { xy = [-200, 1] }\n", "from -180 to 180"},
        {kGeneral + "free = [\"x\"]\nrotation = 3\n", "expected a table of planes"},
        {"type = \"general\"\na = \"pinned\"\nanchor = [5, 5, 5, 5]\nfree = [\"x\"]\n"
         "spring = { x = { frequency = 1 } }\n",
         "cannot move so, and has no frequency; expected a stiffness"},
    });
}

TEST(JointErrors, OfBreaking) {
    expect_refused({
        {kXyHinge + "break = {}\n", "force is missing; expected one in N, or a torque in N m"},
        {kXyHinge + "break = { force = 0 }\n", "expected a finite number > 0"},
        {kXyHinge + "break = { torque = -2 }\n", "expected a finite number > 0"},
        {kXyHinge + "break = 3\n", "expected a table such as"},
    });
}

std::string weld_of(const std::string& name, const std::string& a, const std::string& b) {
    return "[[joint]]\nname = \"" + name + "\"\ntype = \"weld\"\na = \"" + a + "\"\n" +
           (b.empty() ? "" : "b = \"" + b + "\"\n") + kAnchor;
}

TEST(JointErrors, OfWeldsThatCloseOnThemselves) {
    const std::string twice =
        error_of(kJointBodies + weld_of("one", "left", "right") + weld_of("two", "right", "left"));
    EXPECT_NE(twice.find("joint 1 \"two\": closes a loop of welds, of which joint \"one\" is"),
              std::string::npos)
        << twice;
    // Welds that break may share a load.
    EXPECT_EQ(error_of(kJointBodies + weld_of("one", "left", "right") +
                       weld_of("two", "right", "left") + "break = { force = 10 }\n"),
              "");
    // What never moves is one body: the chain from the wall to the world is closed.
    const std::string chain = weld_of("one", "left", "wall") + weld_of("two", "left", "right");
    EXPECT_EQ(error_of(kJointBodies + chain), "");
    EXPECT_NE(error_of(kJointBodies + chain + weld_of("three", "right", ""))
                  .find("joint 2 \"three\": closes a loop of welds, of which joint \"two\" is"),
              std::string::npos);
    EXPECT_NE(error_of(kJointBodies + chain + weld_of("three", "right", "floor")).find("closes"),
              std::string::npos);
    // The other weld that is named is part of the loop, not only connected with it.
    const std::string star = weld_of("one", "grid.0", "grid.1") +
                             weld_of("two", "grid.2", "grid.3") + weld_of("far", "left", "right") +
                             weld_of("between", "grid.1", "grid.2") +
                             weld_of("later", "grid.3", "left");
    EXPECT_EQ(error_of(kJointBodies + star), "");
    EXPECT_NE(error_of(kJointBodies + star + weld_of("last", "grid.2", "grid.3"))
                  .find("of which joint \"two\" is another"),
              std::string::npos);
    EXPECT_NE(error_of(kJointBodies + star + weld_of("last", "grid.0", "grid.3"))
                  .find("of which joint \"between\" is another"),
              std::string::npos);
}

TEST(JointErrors, OfNames) {
    EXPECT_NE(error_of(kJointBodies + weld_of("w", "left", "") + weld_of("w", "right", ""))
                  .find("joint 1 \"w\": name = \"w\": another joint has this name"),
              std::string::npos);
    EXPECT_NE(error_of(kJointBodies + weld_of("joint-1", "left", "") + "[[joint]]\n" + kXyHinge)
                  .find("another joint is called \"joint-1\", the default name of this one"),
              std::string::npos);
    EXPECT_NE(error_of(kJointBodies + "[joint]\n" + kXyHinge).find("expected an array of tables"),
              std::string::npos);
}

TEST(JointErrors, AreToldAllAtOnce) {
    const std::string errors = error_of(
        kJointBodies + "[[joint]]\n" + kHinge + "plane = 3\nlimits = [3, 2]\n[[joint]]\n" +
        "type = \"rope\"\na = \"lift\"\nb = \"right\"\nlength = -1\nbreak = { force = 0 }\n");
    for (const char* part :
         {"plane = 3", "low < high", "did you mean \"left\"?", "length = -1", "force = 0"})
        EXPECT_NE(errors.find(part), std::string::npos) << part << "\n" << errors;
    // Where bodies have errors, joints are not told to name unknown ones.
    std::string bodies = kJointBodies;
    bodies.replace(bodies.find("radius = 1"), 10, "radius = 0");
    const std::string of_body = error_of(bodies + "[[joint]]\n" + kXyHinge + "limits = [3, 2]\n");
    EXPECT_NE(of_body.find("radius = 0"), std::string::npos);
    EXPECT_NE(of_body.find("low < high"), std::string::npos);
    EXPECT_EQ(of_body.find("no body is called so"), std::string::npos) << of_body;
}

}  // namespace
}  // namespace tesserae::scenes
