// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <bit>

#include "core/shape/shape.hpp"
#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

TEST(Faces, TheOneAlongADirectionSupportsTheBox) {
    RandomGeometry random(1);
    for (int i = 0; i < 10000; ++i) {
        const auto box = random_shape<Hyperbox>(random);
        Vec4 direction = random.direction();
        if (i % 3 == 0) direction = Vec4::Unit(i % 4) * (i % 2 == 0 ? 1 : -1);
        const Face face = face_along(box, direction);
        // The support along the face's own normal is on it, and no other axis is nearer.
        EXPECT_DOUBLE_EQ(face.normal.dot(support(box, face.normal)), face.offset);
        EXPECT_DOUBLE_EQ(half_extent_along(box, face.normal), face.offset);
        EXPECT_EQ(face.normal.dot(direction), direction.cwiseAbs().maxCoeff());
        EXPECT_EQ(face.normal.squaredNorm(), 1);
    }
}

TEST(Faces, OfAHullSupportItAndMeetAtItsVertices) {
    RandomGeometry random(3);
    for (int i = 0; i < 300; ++i) {
        const auto hull = random_shape<Polychoron>(random);
        const Vec4 direction = random.direction();
        const Face face = face_along(hull, direction);
        const double size = bounding_radius(hull);
        EXPECT_NEAR(face.normal.dot(support(hull, face.normal)), face.offset, 1e-9 * size);
        for (const HullCell& cell : hull.body->hull.cells)
            EXPECT_LE(cell.plane.normal.dot(direction), face.normal.dot(direction));
        for (const Vec4& vertex : hull.body->hull.vertices)
            EXPECT_GE(std::popcount(faces_near(hull, vertex, 1e-9 * size)), 4) << i;
        if (hull.body->hull.cells.size() <= 64) {
            EXPECT_EQ(faces_near(hull, Vec4::Zero(), 0), 0u);
        }
    }
}

TEST(Faces, AreNearAPointOnThem) {
    RandomGeometry random(2);
    for (int i = 0; i < 10000; ++i) {
        const auto box = random_shape<Hyperbox>(random);
        const double depth = 0.1 * box.size.minCoeff();
        // On so many faces at once: 1 inside a cell, 4 at a vertex.
        const int on = i % 5;
        Vec4 point;
        for (int axis = 0; axis < 4; ++axis)
            point[axis] =
                (axis < on ? 0.5 - 0.5 * depth / box.size[axis]
                           : random.uniform(-0.5, 0.5) * (1 - 2.01 * depth / box.size[axis])) *
                box.size[axis];
        const std::uint64_t faces = faces_near(box, point, depth);
        EXPECT_EQ(std::popcount(faces), on);
        EXPECT_EQ(std::popcount(faces & faces_near(box, -point, depth)), 0);
        EXPECT_EQ(std::popcount(faces_near(box, box.size, depth)), 4);
    }
    Hyperplane plane;
    plane.normal = Vec4(0, 0, 0.6, 0.8);
    plane.offset = 3;
    EXPECT_EQ(faces_near(plane, 2.95 * plane.normal, 0.1), 1u);
    EXPECT_EQ(faces_near(plane, 2.85 * plane.normal, 0.1), 0u);
    EXPECT_EQ(face_along(plane, Vec4::UnitX()).normal, plane.normal);
    EXPECT_EQ(face_along(plane, Vec4::UnitX()).offset, 3);
}

}  // namespace
}  // namespace tesserae
