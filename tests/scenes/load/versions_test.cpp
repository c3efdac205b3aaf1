// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/versions.hpp"

#include <gtest/gtest.h>

#include <set>

#include "scenes/load/effective.hpp"
#include "scenes/load/hash.hpp"

namespace tesserae::scenes {
namespace {

const std::string kEffective =
    "[scene]\nname = \"a\"\n\n[physics]\nduration = 2\nseed = 1\n\n[render]\nsamples = 4\n";

TEST(Versions, TheFirstAddsNothingToWhatIsHashed) {
    // So files made before there were versions are still those of their scenes.
    EXPECT_EQ(motion_hash(kEffective, 1), hex_hash(motion_part(kEffective)));
    EXPECT_EQ(motion_hash(kEffective, 1), hex_hash("[physics]\nseed = 1\n"));
    EXPECT_EQ(frame_hash(kEffective, 1, 1), hex_hash(kEffective));
}

TEST(Versions, EveryOtherGivesAnotherHash) {
    std::set<std::string> hashes;
    for (int motion : {1, 2, 3}) {
        EXPECT_TRUE(hashes.insert(motion_hash(kEffective, motion)).second) << motion;
        for (int picture : {1, 2, 3})
            EXPECT_TRUE(hashes.insert(frame_hash(kEffective, picture, motion)).second)
                << motion << " " << picture;
    }
    EXPECT_EQ(motion_hash(kEffective, 2), hex_hash("[physics]\nseed = 1\nmotion_version = 2\n"));
    EXPECT_EQ(frame_hash(kEffective, 3, 2),
              hex_hash(kEffective + "picture_version = 3\nmotion_version = 2\n"));
}

TEST(Versions, AMotionHashLeavesOutWhatDoesNotMoveBodies) {
    std::string other = kEffective;
    other.replace(other.find("samples = 4"), 11, "samples = 9");
    EXPECT_EQ(motion_hash(other, 2), motion_hash(kEffective, 2));
    EXPECT_NE(frame_hash(other, 2, 2), frame_hash(kEffective, 2, 2));
}

TEST(Versions, NamesOfBodiesAreToldFromOtherNames) {
    const auto text = [](const char* material, const char* body, const char* lattice) {
        return std::string("[scene]\nname = \"s\"\n\n[[material]]\nname = ") + material +
               "\n\n[[body]]\nname = " + body +
               "\nvisible = true\n\n[[lattice]]\nname = " + lattice + "\n";
    };
    const std::string one = text("\"m\"", "\"b\"", "\"l\"");
    EXPECT_TRUE(same_body_names(one, text("\"n\"", "\"b\"", "\"l\"")));
    EXPECT_FALSE(same_body_names(one, text("\"m\"", "\"c\"", "\"l\"")));
    EXPECT_FALSE(same_body_names(one, text("\"m\"", "\"b\"", "\"c\"")));
    EXPECT_FALSE(same_body_names(one, ""));
}

}  // namespace
}  // namespace tesserae::scenes
