// SPDX-License-Identifier: Apache-2.0
#include "scenes/trajectory/resume_record.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "scenes/load/hash.hpp"

namespace tesserae::scenes {
namespace {

double number(std::mt19937_64& random) { return std::normal_distribution<>(0, 10)(random); }

Bivector bivector(std::mt19937_64& random) {
    Bivector b;
    for (double* plane : {&b.xy, &b.xz, &b.xw, &b.yz, &b.yw, &b.zw}) *plane = number(random);
    return b;
}

/// With so many impulses of contacts and of joints, whose parts have either sign.
ResumeRecord random_record(unsigned contacts, unsigned joints, bool rolling,
                           std::mt19937_64& random) {
    ResumeRecord record;
    record.rows = 7, record.first = 5, record.step = 30, record.hash = {1, 2};
    for (BodyId i = 0; i < contacts; ++i) {
        KeptImpulse impulse;
        impulse.normal = std::abs(number(random));
        impulse.a = i, impulse.b = i + 1, impulse.feature = 3 * i;
        record.memory.impulses.push_back(impulse);
        if (rolling) record.memory.angular_impulses.push_back(bivector(random));
    }
    for (unsigned i = 0; i < joints; ++i)
        record.memory.joint_impulses.push_back(
            {{number(random), number(random), number(random), number(random)}, bivector(random)});
    // Joints have two parts or one; some are broken, or none ever was.
    for (unsigned i = 0; i < (rolling ? joints / 2 : 0); ++i)
        record.memory.broken.push_back(i % 3 == 0);
    return record;
}

TEST(ResumeRecord, ComesBackFromItsBytes) {
    std::mt19937_64 random(1);
    for (const unsigned contacts : {0u, 1u, 20u})
        for (const unsigned joints : {0u, 1u, 30u})
            for (const bool rolling : {false, true}) {
                const ResumeRecord record = random_record(contacts, joints, rolling, random);
                const std::string bytes = to_bytes(record);
                const auto again = to_record(bytes);
                ASSERT_TRUE(again);
                EXPECT_EQ(to_bytes(*again), bytes);
                EXPECT_EQ(again->memory.joint_impulses, record.memory.joint_impulses);
                EXPECT_EQ(again->memory.broken, record.memory.broken);
                EXPECT_EQ(again->memory.angular_impulses, record.memory.angular_impulses);
                EXPECT_EQ(again->memory.impulses.size(), contacts);
                for (std::size_t cut = 0; cut < bytes.size(); cut += 1 + cut / 8)
                    EXPECT_FALSE(to_record(std::string_view(bytes).substr(0, cut))) << cut;
            }
}

/// Where the numbers of parts and of broken joints are, in a record that has some.
constexpr std::size_t kRecordFront = 24, kPartsAt = kRecordFront + 64, kBrokenAt = kPartsAt + 8;

/// A record whose bytes at a place are changed, with the hash that fits.
std::string forged(std::string bytes, std::size_t at, std::uint64_t number) {
    std::memcpy(bytes.data() + at, &number, sizeof number);
    const auto hash = hash_of(std::string_view(bytes).substr(kRecordFront));
    std::memcpy(bytes.data() + 8, &hash, sizeof hash);
    return bytes;
}

TEST(ResumeRecord, RefusesNumbersOfJointsThatItDoesNotHold) {
    std::mt19937_64 random(2);
    const std::string bytes = to_bytes(random_record(3, 30, true, random));
    ASSERT_TRUE(to_record(forged(bytes, kPartsAt, 30)));
    ASSERT_TRUE(to_record(forged(bytes, kBrokenAt, 15)));
    for (const std::uint64_t number : {std::uint64_t{0}, std::uint64_t{14}, std::uint64_t{31},
                                       std::uint64_t{1} << 40, ~std::uint64_t{0}})
        for (const std::size_t at : {kPartsAt, kBrokenAt})
            EXPECT_FALSE(to_record(forged(bytes, at, number))) << at << " " << number;
}

TEST(ResumeRecord, WithoutJointsIsAsItWasBeforeThereWereAny) {
    std::mt19937_64 random(3);
    // Front, fixed numbers, and a contact of 36 bytes each.
    EXPECT_EQ(to_bytes(random_record(5, 0, false, random)).size(), kRecordFront + 64 + 5 * 36);
    EXPECT_EQ(to_bytes(random_record(5, 2, false, random)).size(),
              kRecordFront + 64 + 16 + 5 * 36 + 2 * 80);
}

TEST(ResumeRecord, FitsJointsOrHasNothingOfThem) {
    StepMemory memory;
    EXPECT_TRUE(is_of_joints(memory, 3, 5));
    memory.joint_impulses.resize(5);
    EXPECT_TRUE(is_of_joints(memory, 3, 5));
    EXPECT_FALSE(is_of_joints(memory, 3, 4));
    EXPECT_FALSE(is_of_joints(memory, 0, 0));
    memory.broken.resize(3);
    EXPECT_TRUE(is_of_joints(memory, 3, 5));
    EXPECT_FALSE(is_of_joints(memory, 4, 5));
}

}  // namespace
}  // namespace tesserae::scenes
