// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "core/contact/find_contacts.hpp"
#include "tests/core/contact/pair_sets.hpp"

// Contacts over one face of a box or a hull, against a hyperplane in the face's place.
namespace tesserae {
namespace {

enum class Kind { kBox, kCapsule, kHull };

Polychoron cube(double side) {
    Polychoron shape;
    shape.regular = RegularPolychoron::k8Cell, shape.radius = side;
    complete(shape);
    return shape;
}

/// A large box and a small body that stands on its face, turned by little against it.
struct Standing {
    Shape ground, body;
    Vec4 ground_at, body_at;
    Rotor ground_turn, body_turn;
    Hyperplane face;  ///< of the ground, where the body is

    Standing(RandomGeometry& random, Kind kind, bool on_hull, double side) {
        const double size = random.uniform(0.5, 2);
        Hyperbox box;
        box.size = side * Vec4::Ones();
        ground = on_hull ? Shape(cube(side)) : Shape(box);
        ground_at = random.in_box(Vec4::Constant(10));
        ground_turn = random_rotor(random);
        const auto little = [&] { return random.uniform(-0.01, 0.01); };
        body_turn = ground_turn * exp({little(), little(), little(), little(), little(), little()});
        double height = 0.5 * size;
        if (kind == Kind::kHull) {
            body = cube(size);
        } else if (kind == Kind::kBox) {
            Hyperbox standing;
            for (double& s : standing.size) s = size * random.uniform(0.5, 2);
            height = 0.5 * standing.size[0];
            body = standing;
        } else {
            body = Hypercapsule{0.5 * size, size};
        }
        face.normal = rotate(ground_turn, Vec4::UnitX());
        face.offset = face.normal.dot(ground_at) + 0.5 * side;
        Vec4 across = random.in_box(Vec4::Constant(1));
        across[0] = 0.5 * side + height - 0.05 * size;
        body_at = ground_at + rotate(ground_turn, across);
    }

    /// As bodies 0 and 1, the ground first or second.
    std::vector<Contact> over_face(bool ground_first) const {
        std::vector<Contact> list;
        const Pose g{ground_at, ground_turn}, b{body_at, body_turn};
        if (ground_first)
            find_contacts_over_face(0, ground, g, 1, body, b, false, face.normal, 0.1, list);
        else
            find_contacts_over_face(0, body, b, 1, ground, g, true, face.normal, 0.1, list);
        return list;
    }
    std::vector<Contact> on_plane() const {
        std::vector<Contact> list;
        find_contacts(0, body, {body_at, body_turn}, 1, face, {body_at, body_turn}, 0.1, list);
        return list;
    }
};

void expect_those_with_a_hyperplane(int faces) {
    RandomGeometry random(1);
    for (int i = 0; i < faces; ++i) {
        const auto kind = static_cast<Kind>(i % 3);
        const bool on_hull = i % 2 == 1, ground_first = i % 4 < 2;
        const Standing s(random, kind, on_hull, 100);
        const std::vector<Contact> own = s.over_face(ground_first);
        std::vector<Contact> plane = s.on_plane();
        const Vec4 outward = Vec4::UnitX();
        for (Contact& c : plane)
            c.feature = ground_first
                            ? feature_over_face(s.ground, s.body, false, outward, c.feature)
                            : feature_over_face(s.body, s.ground, true, outward, c.feature);
        std::sort(plane.begin(), plane.end(),
                  [](const Contact& c, const Contact& d) { return c.feature < d.feature; });
        ASSERT_EQ(own.size(), plane.size()) << i;
        ASSERT_GE(own.size(), kind == Kind::kCapsule ? 1u : 4u) << i;
        for (std::size_t k = 0; k < own.size(); ++k) {
            EXPECT_EQ(own[k].feature, plane[k].feature) << i;
            EXPECT_NEAR(own[k].separation, plane[k].separation, 1e-12) << i;
            EXPECT_LT((own[k].point - plane[k].point).norm(), 1e-12) << i;
            EXPECT_LT((own[k].normal - (ground_first ? 1 : -1) * s.face.normal).norm(), 1e-14);
        }
    }
}

TEST(ContactsOverFace, AreThoseWithAHyperplaneThereAndHaveTheirNames) {
    expect_those_with_a_hyperplane(1000);
}
TEST(ContactsOverFaceSlow, AreThoseWithAHyperplaneThereAndHaveTheirNames) {
    expect_those_with_a_hyperplane(4000);
}

/// Where the face ends under the body: points of both surfaces, one above the other.
void expect_contacts_over_the_face(int faces) {
    RandomGeometry random(2);
    int points = 0;
    for (int i = 0; i < faces; ++i) {
        const Standing s(random, static_cast<Kind>(i % 3), i % 2 == 1, random.uniform(0.3, 2));
        for (const Contact& c : s.over_face(false)) {
            ++points;
            EXPECT_LE(c.separation, 0.1);
            const Vec4 on_body = c.point - 0.5 * c.separation * c.normal;
            const Vec4 on_face = c.point + 0.5 * c.separation * c.normal;
            const auto distance = [](const Shape& shape, const Vec4& at, const Rotor& turn,
                                     const Vec4& point) {
                const Vec4 own = rotate(reverse(turn), point - at);
                return std::visit([&](const auto& of) { return signed_distance(of, own); }, shape);
            };
            // A capsule that leans by 0.02 is lower than under its core by 2e-4 of its radius.
            EXPECT_NEAR(distance(s.body, s.body_at, s.body_turn, on_body), 0, 2e-4) << i;
            EXPECT_NEAR(distance(s.ground, s.ground_at, s.ground_turn, on_face), 0, 1e-9) << i;
        }
    }
    EXPECT_GT(points, 2 * faces);
}

TEST(ContactsOverFace, LieOverTheFace) { expect_contacts_over_the_face(1000); }
TEST(ContactsOverFaceSlow, LieOverTheFace) { expect_contacts_over_the_face(4000); }

}  // namespace
}  // namespace tesserae
