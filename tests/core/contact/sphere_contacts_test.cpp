// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/contact/find_contacts.hpp"

namespace tesserae {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

struct Random {
    std::mt19937_64 engine{7};

    double uniform(double a, double b) { return std::uniform_real_distribution<>(a, b)(engine); }
    Vec4 vector(double size) {
        return {uniform(-size, size), uniform(-size, size), uniform(-size, size),
                uniform(-size, size)};
    }
    Vec4 direction() {
        std::normal_distribution<> normal;
        return Vec4(normal(engine), normal(engine), normal(engine), normal(engine)).normalized();
    }
};

Shape sphere(double radius) { return Hypersphere{radius}; }
Shape plane(const Vec4& normal, double offset) {
    Hyperplane p;
    p.normal = normal;
    p.offset = offset;
    return p;
}

std::vector<Contact> contacts(const Shape& a, const Vec4& x_a, const Shape& b, const Vec4& x_b,
                              double margin) {
    const Rotor rotor;
    std::vector<Contact> list;
    find_contacts(3, a, {x_a, rotor}, 8, b, {x_b, rotor}, margin, list);
    return list;
}

// The contact is built from its answer: a point, a normal, a gap and two radii place the spheres.
TEST(SphereSphereContacts, AreThoseThatTheSpheresWereBuiltFrom) {
    Random random;
    for (int i = 0; i < 20000; ++i) {
        const Vec4 point = random.vector(10), normal = random.direction();
        const double r_a = std::exp(random.uniform(-3, 3)), r_b = std::exp(random.uniform(-3, 3));
        const double gap = random.uniform(-0.9, 0.9) * std::min(r_a, r_b);
        const Vec4 x_a = point - (r_a + 0.5 * gap) * normal;
        const Vec4 x_b = point + (r_b + 0.5 * gap) * normal;
        const auto list = contacts(sphere(r_a), x_a, sphere(r_b), x_b, 1e3);
        ASSERT_EQ(list.size(), 1u);
        // Coordinates below 50 are rounded, and a direction over a distance of at least 0.05.
        const double error = 50 * 8 * kEpsilon;
        const double distance = r_a + r_b + gap;
        EXPECT_NEAR(list[0].separation, gap, error);
        EXPECT_LT((list[0].normal - normal).norm(), error / distance) << i;
        EXPECT_LT((list[0].point - point).norm(), error * (1 + r_a / distance)) << i;
        EXPECT_EQ(list[0].a, 3u);
        EXPECT_EQ(list[0].b, 8u);
    }
}

TEST(SphereSphereContacts, AreReportedUpToTheMargin) {
    const Vec4 far{2.5, 0, 0, 0};  // gap 0.5, exact in binary
    EXPECT_EQ(contacts(sphere(1), Vec4::Zero(), sphere(1), far, 0.5).size(), 1u);
    EXPECT_EQ(contacts(sphere(1), Vec4::Zero(), sphere(1), far, 0.4999).size(), 0u);
}

TEST(SphereSphereContacts, HaveAUnitNormalHoweverCloseTheCentres) {
    for (double d : {0.0, 1e-320, 1e-300, 1e-150, 1e-100, 1e-20, 1e-3}) {
        const auto list = contacts(sphere(1), Vec4::Zero(), sphere(2), Vec4(0, 0, -d, d), 0);
        ASSERT_EQ(list.size(), 1u);
        EXPECT_NEAR(list[0].normal.norm(), 1, 4 * kEpsilon) << d;
        EXPECT_NEAR(list[0].separation, std::sqrt(2.0) * d - 3, 4 * kEpsilon) << d;
        if (d == 0) {
            EXPECT_EQ(list[0].normal, Vec4::UnitX().eval());
        }
    }
}

TEST(SphereSphereContacts, AreNoneWhereTheDistanceOverflows) {
    const Vec4 far{1e200, 0, 0, 0};
    EXPECT_TRUE(contacts(sphere(1), Vec4::Zero(), sphere(1), far, 1e10).empty());
}

TEST(SpherePlaneContacts, AreThoseThatTheSphereWasBuiltFrom) {
    Random random;
    for (int i = 0; i < 20000; ++i) {
        const Vec4 normal = random.direction();
        const double offset = random.uniform(-5, 5), radius = std::exp(random.uniform(-3, 2));
        const double gap = random.uniform(-3, 0.9) * radius;  // also with the centre behind
        Vec4 foot = random.vector(5);
        foot += (offset - normal.dot(foot)) * normal;
        const Vec4 centre = foot + (radius + gap) * normal;
        const double error = 50 * 8 * kEpsilon;
        for (bool plane_first : {false, true}) {
            const auto list =
                plane_first
                    ? contacts(plane(normal, offset), Vec4::Zero(), sphere(radius), centre, 1e3)
                    : contacts(sphere(radius), centre, plane(normal, offset), Vec4::Zero(), 1e3);
            ASSERT_EQ(list.size(), 1u);
            // From a to b: out of the solid side when the plane is a, into it when it is b.
            const Vec4 expected = plane_first ? normal : Vec4(-normal);
            EXPECT_EQ(list[0].normal, expected);
            EXPECT_NEAR(list[0].separation, gap, error);
            EXPECT_LT((list[0].point - (foot + 0.5 * gap * normal)).norm(), error);
        }
    }
}

}  // namespace
}  // namespace tesserae
