// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/group_numbers.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

const std::string kBall = "[[body]]\nshape = \"hypersphere\"\nradius = 1\n";

std::string quoted_list(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
    return "[" + text + "]";
}

bool collide_in(const Scene& scene, BodyId a, BodyId b) {
    return collide(scene.bodies.type_of(a), scene.bodies.type_of(b));
}

/// Every two of random bodies by their names, in scenes of up to 64 groups.
TEST(GroupNumbers, CollideAsTheNamesSay) {
    std::mt19937_64 random(1);
    for (int round = 0; round < 20; ++round) {
        struct Named {
            std::string group;
            bool is_choosy;
            std::vector<std::string> collides_with;
        };
        const std::size_t count = 1 + random() % 63;
        const auto name_of = [](std::size_t i) { return i == 0 ? "" : "g" + std::to_string(i); };
        std::vector<Named> all;
        std::string text;
        for (std::size_t i = 0; i < 2 * count; ++i) {
            Named named{name_of(i % (count + 1)), random() % 2 == 0, {}};
            for (std::size_t k = 0; k < count; ++k)
                if (random() % 2 == 0) named.collides_with.push_back(name_of(k));
            text += kBall;
            if (!named.group.empty() || random() % 2 == 0)
                text += "group = \"" + named.group + "\"\n";
            if (named.is_choosy)
                text += "collides_with = " + quoted_list(named.collides_with) + "\n";
            all.push_back(std::move(named));
        }
        const Scene scene = load_text(text);
        const auto likes = [](const Named& a, const Named& b) {
            return !a.is_choosy || std::find(a.collides_with.begin(), a.collides_with.end(),
                                             b.group) != a.collides_with.end();
        };
        for (BodyId a = 0; a < all.size(); ++a)
            for (BodyId b = 0; b < all.size(); ++b)
                ASSERT_EQ(collide_in(scene, a, b), likes(all[a], all[b]) && likes(all[b], all[a]))
                    << a << " " << b << "\n"
                    << text;
        // The canonical text is the same again, whose groups may have other numbers.
        EXPECT_EQ(load_text(scene.effective).effective, scene.effective);
    }
}

TEST(GroupNumbers, AreNotWrittenWhereThereAreNone) {
    const std::string plain = load_text(kBall).effective;
    EXPECT_EQ(load_text(kBall + "group = \"\"\ngravity_scale = 1\ndamping = 0\n").effective, plain);
    EXPECT_EQ(plain.find("group"), std::string::npos);
    EXPECT_NE(load_text(kBall + "collides_with = []").effective, plain);
}

TEST(GroupNumbers, AreSetFromTheCommandLineAndForLattices) {
    const std::string text =
        kBall +
        "name = \"one\"\n[[lattice]]\nshape = \"hypersphere\"\nradius = 1\nname = \"many\"\n"
        "count = [2, 1, 1, 1]\nspacing = [3, 0, 0, 0]\ngroup = \"smoke\"\n";
    EXPECT_TRUE(collide_in(load_text(text), 0, 1));
    EXPECT_FALSE(collide_in(load_text(text, {"body.one.collides_with=[\"\"]"}), 0, 2));
    const Scene scene = load_text(text, {"lattice.many.gravity_scale=-0.5", "body.one.damping=2"});
    EXPECT_EQ(scene.bodies.type_of(1).gravity_scale, -0.5);
    EXPECT_EQ(scene.bodies.type_of(0).damping, 2);
}

TEST(GroupNumbers, ErrorsSayWhere) {
    const auto expect = [](const std::string& keys, const std::string& message) {
        EXPECT_EQ(error_of(kBall + "group = \"balls\"\n" + kBall + keys), message);
    };
    expect("collides_with = [\"bals\"]\n",
           "test.toml:8:17: body 1: collides_with = [\"bals\"]: no body is of the group \"bals\"; "
           "did you mean \"balls\"?");
    expect("collides_with = \"balls\"\n",
           "test.toml:8:17: body 1: collides_with = \"balls\": wrong type; expected an array of "
           "strings");
    expect("collides_with = [1]\n",
           "test.toml:8:18: body 1: collides_with[0] = 1: wrong type; expected a string");
    expect("collides_with = [\"balls\", \"balls\"]\n",
           "test.toml:8:27: body 1: collides_with[1] = \"balls\": is listed twice");
    expect("group = 3\n", "test.toml:8:9: body 1: group = 3: wrong type; expected a string");
    expect("damping = -1\n", "test.toml:8:11: body 1: damping = -1: expected a finite number >= 0");
    expect("gravity_scale = inf\n",
           "test.toml:8:17: body 1: gravity_scale = inf: expected a finite number");
    // Later bodies count too.
    EXPECT_EQ(error_of(kBall + "collides_with = [\"late\"]\n" + kBall + "group = \"late\"\n"), "");
    const std::string plane = "[[body]]\nshape = \"hyperplane\"\nnormal = [0, 1, 0, 0]\n";
    EXPECT_EQ(error_of(plane + "damping = 1\n"),
              "test.toml:4:11: body 0: damping = 1: a hyperplane never moves and has no damping");
    EXPECT_EQ(error_of(plane + "collides_with = []\n" + kBall), "");
}

TEST(GroupNumbers, AreAtMost64) {
    std::string text;
    for (int i = 1; i <= 64; ++i) text += kBall + "group = \"g" + std::to_string(i) + "\"\n";
    EXPECT_EQ(error_of(text),
              "test.toml:256:9: body 63: group = \"g64\": is group 65; expected at most 64 in a "
              "scene, with that of bodies without a group");
    EXPECT_EQ(error_of(text.substr(0, text.rfind("group"))), "");
}

}  // namespace
}  // namespace tesserae::scenes
