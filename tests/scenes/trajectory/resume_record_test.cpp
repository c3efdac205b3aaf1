#include "scenes/trajectory/resume_record.hpp"

#include <gtest/gtest.h>

#include <random>

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
                EXPECT_EQ(again->memory.angular_impulses, record.memory.angular_impulses);
                EXPECT_EQ(again->memory.impulses.size(), contacts);
                for (std::size_t cut = 0; cut < bytes.size(); cut += 1 + cut / 8)
                    EXPECT_FALSE(to_record(std::string_view(bytes).substr(0, cut))) << cut;
            }
}

}  // namespace
}  // namespace tesserae::scenes
