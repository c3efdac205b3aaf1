// SPDX-License-Identifier: Apache-2.0
// Stills of regular polychora as they are declared, whose slice at w = 0 two cells share in whole
// faces: one normal a face, however the vertices are listed and however rays are followed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

struct Tied {
    RegularPolychoron which;
    std::size_t vertices;
    double part;  ///< of a still's pixels on it that two cells share, at least
};
const Tied kTied[] = {{RegularPolychoron::k16Cell, 8, 0.999},
                      {RegularPolychoron::k24Cell, 24, 0.2},
                      {RegularPolychoron::k120Cell, 600, 0.05},
                      {RegularPolychoron::k600Cell, 120, 0.15}};

Image still_of(const Polychoron& shape, Intersector intersector) {
    TestScene scene;
    scene.add(shape, Vec4::Zero());
    scene.camera.position = {1.4, 1.1, -2.9, 0};
    scene.camera.look_at = Vec4::Zero();
    scene.camera.field_of_view = 42;
    scene.lights.suns.push_back({Vec4(0.3, -1, 0.5, 0.1).normalized(), Color::Ones(), 1});
    scene.settings.width = scene.settings.height = 180;
    scene.settings.samples = 1;
    scene.settings.intersector = intersector;
    scene.settings.channels.position = true;
    return picture_of(scene);
}

Vec4 four_of(const Image& image, const std::string& layer, int x, int y) {
    return {image.at(layer + ".X", x, y), image.at(layer + ".Y", x, y),
            image.at(layer + ".Z", x, y), image.at(layer + ".W", x, y)};
}

/// Cells that a point of the surface lies on, but for a float's rounding.
std::size_t cells_at(const Hull& hull, const Vec4& point) {
    return static_cast<std::size_t>(
        std::count_if(hull.cells.begin(), hull.cells.end(), [&](const HullCell& cell) {
            return std::abs(cell.plane.normal.dot(point) - cell.plane.offset) < 1e-6;
        }));
}

TEST(PolychoraPicture, HasOneNormalAFaceWhereCellsTie) {
    for (const Tied& tied : kTied) {
        Polychoron regular;
        regular.regular = tied.which;
        complete(regular);
        // The same by points in another order.
        Polychoron shuffled;
        shuffled.regular = RegularPolychoron::kNone;
        shuffled.vertices = regular_vertices(tied.which);
        ASSERT_EQ(shuffled.vertices.size(), tied.vertices);
        Random random(5);
        std::shuffle(shuffled.vertices.begin(), shuffled.vertices.end(), random);
        complete(shuffled);

        const Image first = still_of(regular, Intersector::kAnalytic);
        const Image other = still_of(shuffled, Intersector::kAnalytic);
        const Image traced = still_of(regular, Intersector::kTrace);
        int seen = 0, shared = 0, differ = 0;
        std::set<std::vector<long>> normals;
        for (int y = 0; y < first.height; ++y)
            for (int x = 0; x < first.width; ++x) {
                if (first.id(x, y) == 0) continue;
                ++seen;
                const Vec4 n = four_of(first, "N", x, y);
                for (const Image* image : {&other, &traced})
                    differ += (four_of(*image, "N", x, y) - n).norm() > 1e-5;
                normals.insert({std::lround(1e3 * n[0]), std::lround(1e3 * n[1]),
                                std::lround(1e3 * n[2]), std::lround(1e3 * n[3])});
                // Two mirror images across w = 0 have a mean in it.
                if (cells_at(regular.body->hull, four_of(first, "P", x, y)) < 2) continue;
                ++shared;
                EXPECT_NEAR(n[3], 0, 1e-6);
            }
        EXPECT_GT(seen, 8000);
        EXPECT_GT(shared, tied.part * seen);
        // At the edges of faces rounding may tell either.
        EXPECT_LT(differ, 0.002 * seen);
        // One a face of the slice, and few more on edges; specks would be hundreds.
        EXPECT_LT(normals.size(), tied.vertices + 20) << tied.vertices;
    }
}

}  // namespace
}  // namespace tesserae::render
