// SPDX-License-Identifier: Apache-2.0
// Meshes of bodies' sections, held against what their shapes say of themselves.
#include "scenes/export/section.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>

#include "scenes/export/convex_section.hpp"
#include "scenes/load/load.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

using Rng = std::mt19937_64;

double uniform(Rng& rng, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(rng);
}

Vec4 random_unit(Rng& rng) {
    std::normal_distribution<double> normal;
    return Vec4(normal(rng), normal(rng), normal(rng), normal(rng)).normalized();
}

Rotor random_rotor(Rng& rng) {
    const auto angle = [&] { return uniform(rng, -2, 2); };
    return exp(Bivector{angle(), angle(), angle(), angle(), angle(), angle()});
}

/// A body alone in the world, as a scene file has it.
Bodies body_of(const std::string& keys) { return load_text("[[body]]\n" + keys + "\n").bodies; }

/// A camera that looks anywhere.
render::Camera random_camera(Rng& rng) {
    render::CameraDescription description;
    description.position = uniform(rng, 0, 8) * random_unit(rng);
    description.look_at = description.position + random_unit(rng);
    description.up = random_unit(rng);
    description.fourth = random_unit(rng);
    return {description, 64, 48};
}

/// A point of the film's space, which is the slice of a camera that is the first, in the world.
Vec4 to_world(const render::Camera& camera, const Vec3& p) {
    return camera.origin() + p.x() * camera.right() + p.y() * camera.forward() +
           p.z() * camera.up();
}

/// Every edge is passed once in either direction, and each corner is used.
void expect_closed(const Mesh& mesh, const std::string& what) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> passed;
    std::vector<bool> is_used(mesh.vertices.size());
    for (std::size_t f = 0; f < mesh.faces(); ++f) {
        const auto corner = mesh.face(f);
        ASSERT_GE(corner.size(), 3u) << what;
        for (std::size_t i = 0; i < corner.size(); ++i) {
            ++passed[{corner[i], corner[(i + 1) % corner.size()]}];
            is_used[corner[i]] = true;
        }
    }
    for (const auto& [edge, count] : passed) {
        EXPECT_EQ(count, 1) << what;
        EXPECT_EQ(passed.count({edge.second, edge.first}), 1u) << what;
    }
    EXPECT_EQ(std::count(is_used.begin(), is_used.end(), false), 0) << what;
    // Of a sphere's kind: vertices - edges + faces = 2.
    EXPECT_EQ(mesh.vertices.size() + mesh.faces(), passed.size() / 2 + 2) << what;
    EXPECT_GT(volume_of(mesh), 0) << what;
}

/// Each polygon is flat, and no corner of the mesh is beyond it.
void expect_convex(const Mesh& mesh, double size, const std::string& what) {
    double worst = 0;
    for (std::size_t f = 0; f < mesh.faces(); ++f) {
        const auto corner = mesh.face(f);
        Vec3 area = Vec3::Zero();
        for (std::size_t i = 2; i < corner.size(); ++i)
            area += (mesh.vertices[corner[i - 1]] - mesh.vertices[corner[0]])
                        .cross(mesh.vertices[corner[i]] - mesh.vertices[corner[0]]);
        // Of a sliver rounding turns the normal.
        if (area.norm() < 1e-6 * size * size) continue;
        for (const Vec3& v : mesh.vertices)
            worst = std::max(worst, area.normalized().dot(v - mesh.vertices[corner[0]]));
    }
    EXPECT_LE(worst, 1e-8 * size) << what;
}

/// A body that a random slice cuts, with its section.
struct Cut {
    Bodies bodies;
    render::Camera camera;
    Mesh mesh;
    double size;

    static Cut random(Rng& rng, const std::string& keys, double tolerance) {
        while (true) {
            Cut cut{body_of(keys), random_camera(rng), {}, 0};
            cut.size = bounding_radius(cut.bodies.types[0].shape);
            cut.bodies.rotor[0] = random_rotor(rng);
            cut.bodies.position[0] =
                cut.camera.origin() + uniform(rng, 0, 1) * cut.size * random_unit(rng);
            cut.mesh = Sections(cut.bodies, {tolerance, 100})
                           .of(cut.bodies, 0, SliceFrame(cut.camera, cut.camera));
            if (!cut.mesh.is_empty()) return cut;
        }
    }
    const Shape& shape() const { return bodies.types[0].shape; }
    Vec4 to_body(const Vec3& p) const {
        return to_matrix(bodies.rotor[0]).transpose() * (to_world(camera, p) - bodies.position[0]);
    }
    Vec4 direction_to_body(const Vec3& d) const {
        return to_matrix(bodies.rotor[0]).transpose() * (to_world(camera, d) - camera.origin());
    }
    double distance(const Vec3& p) const {
        return std::visit([&](const auto& s) { return signed_distance(s, to_body(p)); }, shape());
    }
    /// How far it is to the surface from a point inside, in the slice.
    double exit(const Vec3& from, const Vec3& direction) const {
        return std::visit(
            [&](const auto& s) { return ray_exit(s, to_body(from), direction_to_body(direction)); },
            shape());
    }
    Vec3 middle() const {
        Vec3 sum = Vec3::Zero();
        for (const Vec3& v : mesh.vertices) sum += v;
        return sum / static_cast<double>(mesh.vertices.size());
    }
};

const char* const kPolytopes[] = {
    R"(shape = "hyperbox"
size = [1, 2, 0.3, 1.2])",
    R"(shape = "polychoron"
regular = "5-cell"
radius = 1)",
    R"(shape = "polychoron"
regular = "16-cell"
radius = 1)",
    R"(shape = "polychoron"
regular = "24-cell"
radius = 1)",
    R"(shape = "polychoron"
regular = "120-cell"
radius = 1)",
    R"(shape = "polychoron"
regular = "600-cell"
radius = 1)",
    R"(shape = "duoprism"
polygons = [5, 9]
radii = [1, 0.7])",
    R"(shape = "polychoron"
vertices = [[0, 0, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1], [0.6, 0.7, 0.5, 0.8]])"};

const char* const kRound[] = {R"(shape = "hypersphere"
radius = 0.7)",
                              R"(shape = "hypercapsule"
radius = 0.4
height = 1.3)",
                              R"(shape = "hypercapsule"
radius = 0.4
height = 0)",
                              R"(shape = "spherinder"
radius = 0.6
height = 0.9)",
                              R"(shape = "cubinder"
radius = 0.6
size = [0.9, 0.4])",
                              R"(shape = "duocylinder"
radii = [0.6, 0.35])"};

void expect_sections_of_polytopes(int cuts) {
    Rng rng(1);
    for (const std::string keys : kPolytopes)
        for (int i = 0; i < cuts; ++i) {
            const Cut cut = Cut::random(rng, keys, 0);
            expect_closed(cut.mesh, keys);
            expect_convex(cut.mesh, cut.size, keys);
            for (const Vec3& v : cut.mesh.vertices)
                EXPECT_NEAR(cut.distance(v), 0, 1e-13 * (cut.size + v.norm())) << keys;
            // Flat faces lie in the surface as a whole: their middles too.
            for (std::size_t f = 0; f < cut.mesh.faces(); ++f) {
                Vec3 middle = Vec3::Zero();
                for (const auto c : cut.mesh.face(f)) middle += cut.mesh.vertices[c];
                middle /= static_cast<double>(cut.mesh.face(f).size());
                EXPECT_NEAR(cut.distance(middle), 0, 1e-8 * cut.size) << keys;
            }
        }
}

TEST(Sections, OfPolytopesAreClosedConvexAndOnTheirSurfaces) { expect_sections_of_polytopes(6); }
TEST(SectionsSlow, OfPolytopesAreClosedConvexAndOnTheirSurfaces) {
    expect_sections_of_polytopes(20);
}

/// The content of a body is the integral of its sections' volumes over the height: by Simpson's
/// rule, which is exact between the heights of vertices, and close elsewhere.
TEST(Sections, VolumesOfPolytopesAddUpToTheirContent) {
    Rng rng(2);
    for (const std::string keys : kPolytopes) {
        Bodies bodies = body_of(keys);
        bodies.rotor[0] = random_rotor(rng);
        const Sections sections(bodies, {0, 100});
        const double reach = bounding_radius(bodies.types[0].shape);
        constexpr int kParts = 400;
        double sum = 0;
        for (int i = 0; i <= kParts; ++i) {
            render::CameraDescription at;
            at.position[3] = at.look_at[3] = reach * (2.0 * i / kParts - 1);
            const render::Camera camera(at, 64, 48);
            const double weight = i == 0 || i == kParts ? 1 : i % 2 ? 4 : 2;
            sum += weight * volume_of(sections.of(bodies, 0, SliceFrame(camera, camera)));
        }
        const double content =
            std::visit([](const auto& s) { return volume(s); }, bodies.types[0].shape);
        EXPECT_NEAR(sum * 2 * reach / kParts / 3, content, 1e-4 * content) << keys;
    }
}

/// Slices through vertices, edges and cells: what is degenerate in combinatorics is common in
/// scenes.
TEST(Sections, OfPolytopesInSpecialPlacesAreThePolyhedraOfTheBooks) {
    struct Case {
        const char* keys;
        double height;
        std::size_t vertices, faces;
        double volume;
    };
    const double s = std::sqrt(2.0);
    // A pentagon of edge 1/phi: its area and circumradius.
    const double a = 0.5 * (std::sqrt(5.0) - 1);
    const double pentagon = std::sqrt(25 + 10 * std::sqrt(5.0)) / 4 * a * a;
    const double round = a / (2 * std::sin(std::numbers::pi / 5));
    const Case cases[] = {
        // A tesseract: a cube, also where a cell lies in the slice.
        {"shape = \"hyperbox\"\nsize = [2, 2, 2, 2]", 0, 8, 6, 8},
        {"shape = \"hyperbox\"\nsize = [2, 2, 2, 2]", 1, 8, 6, 8},
        {"shape = \"hyperbox\"\nsize = [2, 2, 2, 2]", 1.01, 0, 0, 0},
        // An octahedron through six of eight vertices.
        {"shape = \"polychoron\"\nregular = \"16-cell\"\nradius = 1", 0, 6, 8, 4.0 / 3},
        {"shape = \"polychoron\"\nregular = \"16-cell\"\nradius = 1", 0.5, 6, 8, 4.0 / 3 / 8},
        // A cuboctahedron with the vertices (+-1, +-1, 0) / sqrt 2 and so on, of edge 1.
        {"shape = \"polychoron\"\nregular = \"24-cell\"\nradius = 1", 0, 12, 14, 5 * s / 3},
        // Through one vertex or one cell only.
        {"shape = \"polychoron\"\nregular = \"16-cell\"\nradius = 1", 1, 0, 0, 0},
        {"shape = \"polychoron\"\nregular = \"24-cell\"\nradius = 1", 1 / s, 6, 8, s / 3},
        // An icosidodecahedron of edge 1/phi, each of its pentagons with a pyramid that ends in the
        // middle of an edge.
        {"shape = \"polychoron\"\nregular = \"600-cell\"\nradius = 1", 0, 42, 80,
         (45 + 17 * std::sqrt(5.0)) / 6 * a * a * a +
             4 * pentagon * (std::sqrt(1 - a * a / 4) - std::sqrt(1 - round * round))},
    };
    for (const Case& c : cases) {
        Bodies bodies = body_of(c.keys);
        render::CameraDescription at;
        at.position[3] = at.look_at[3] = c.height;
        const render::Camera camera(at, 64, 48);
        const Mesh mesh = Sections(bodies, {0, 100}).of(bodies, 0, SliceFrame(camera, camera));
        const std::string what = std::string(c.keys) + " at " + std::to_string(c.height);
        EXPECT_EQ(mesh.vertices.size(), c.vertices) << what;
        EXPECT_EQ(mesh.faces(), c.faces) << what;
        EXPECT_NEAR(volume_of(mesh), c.volume, 1e-12) << what;
        if (!mesh.is_empty()) expect_closed(mesh, what);
    }
}

/// Vertices are on the surface and the mesh is inside, so all that is between the two is seen along
/// rays from a point inside: the gap along any ray is at least the distance from either surface.
/// The distance of a surface point from the mesh is that from the nearest polygon's plane at least.
void expect_round_sections_within(int coarse, int fine) {
    Rng rng(3);
    for (const std::string keys : kRound)
        for (const double tolerance : {0.02, 2e-3, 3e-4})
            for (int i = 0; i < (tolerance > 1e-3 ? coarse : fine); ++i) {
                const Cut cut = Cut::random(rng, keys, tolerance);
                const std::string what = keys + " within " + std::to_string(tolerance);
                expect_closed(cut.mesh, what);
                if (tolerance > 1e-3) expect_convex(cut.mesh, cut.size, what);
                for (const Vec3& v : cut.mesh.vertices)
                    EXPECT_NEAR(cut.distance(v), 0, 2e-12 * (cut.size + v.norm())) << what;
                // From the mesh: points of polygons along their normals to the surface.
                double farthest = 0;
                for (std::size_t f = 0; f < cut.mesh.faces(); ++f) {
                    const auto corner = cut.mesh.face(f);
                    const Vec3& a = cut.mesh.vertices[corner[0]];
                    for (std::size_t k = 2; k < corner.size(); ++k) {
                        const Vec3 &b = cut.mesh.vertices[corner[k - 1]],
                                   &c = cut.mesh.vertices[corner[k]];
                        const Vec3 across = (b - a).cross(c - a);
                        if (across.norm() < 1e-12) continue;
                        const double u = uniform(rng, 0, 1), v = uniform(rng, 0, 1 - u);
                        for (const Vec3& p : {Vec3((a + b + c) / 3), Vec3(0.5 * (a + c)),
                                              Vec3(a + u * (b - a) + v * (c - a))}) {
                            EXPECT_LE(cut.distance(p), 1e-12 * (cut.size + p.norm())) << what;
                            farthest = std::max(farthest, cut.exit(p, across.normalized()));
                        }
                    }
                }
                EXPECT_LE(farthest, tolerance * (1 + 1e-6)) << what;
            }
}

TEST(Sections, OfRoundBodiesKeepTheToleranceBothWays) { expect_round_sections_within(2, 1); }
TEST(SectionsSlow, OfRoundBodiesKeepTheToleranceBothWays) { expect_round_sections_within(6, 2); }

/// Distance from a point outside a convex mesh, by projecting on all its triangles.
double distance_to_mesh(const Mesh& mesh, const Vec3& p) {
    double nearest = 1e300;
    const auto to_segment = [&](const Vec3& a, const Vec3& b) {
        const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (a + t * (b - a) - p).norm());
    };
    for (std::size_t f = 0; f < mesh.faces(); ++f) {
        const auto corner = mesh.face(f);
        const Vec3& a = mesh.vertices[corner[0]];
        for (std::size_t k = 2; k < corner.size(); ++k) {
            const Vec3 &b = mesh.vertices[corner[k - 1]], &c = mesh.vertices[corner[k]];
            to_segment(a, b), to_segment(b, c), to_segment(c, a);
            const Vec3 n = (b - a).cross(c - a);
            const auto is_within = [&](const Vec3& from, const Vec3& to) {
                return (to - from).cross(p - from).dot(n) >= 0;
            };
            if (n.norm() > 0 && is_within(a, b) && is_within(b, c) && is_within(c, a))
                nearest = std::min(nearest, std::abs((p - a).dot(n)) / n.norm());
        }
    }
    return nearest;
}

TEST(Sections, NoPointOfARoundBodysSurfaceIsFartherFromItsMesh) {
    Rng rng(4);
    for (const std::string keys : kRound)
        for (const double tolerance : {0.02, 3e-3})
            for (int i = 0; i < 6; ++i) {
                const Cut cut = Cut::random(rng, keys, tolerance);
                const Vec3 middle = cut.middle();
                double farthest = 0;
                for (int k = 0; k < 100; ++k) {
                    const Vec3 d = random_unit(rng).head<3>().normalized();
                    farthest = std::max(
                        farthest, distance_to_mesh(cut.mesh, middle + cut.exit(middle, d) * d));
                }
                EXPECT_LE(farthest, tolerance * (1 + 1e-6)) << keys << " within " << tolerance;
            }
}

/// The general way and the special ones agree on the same body.
TEST(Sections, TheGeneralWayMeetsTheSpecialOnes) {
    Rng rng(5);
    for (const std::string keys : kRound)
        for (int i = 0; i < 5; ++i) {
            const Cut cut = Cut::random(rng, keys, 0.01);
            const SliceFrame frame(cut.camera, cut.camera);
            const PlacedShape at = {frame.point_to_frame(cut.bodies.position[0]),
                                    frame.turn_to_frame(to_matrix(cut.bodies.rotor[0]))};
            const Mesh general = convex_section(cut.shape(), at, 0.01);
            expect_closed(general, keys);
            // Both are inside the section by at most the tolerance times its surface.
            EXPECT_NEAR(volume_of(general), volume_of(cut.mesh), 0.01 * 12 * cut.size * cut.size)
                << keys;
        }
}

TEST(Sections, AreEmptyWhereTheSliceMissesTheBody) {
    Rng rng(6);
    for (const auto& list :
         {std::vector<std::string>(std::begin(kRound), std::end(kRound)),
          std::vector<std::string>(std::begin(kPolytopes), std::end(kPolytopes))})
        for (const std::string& keys : list) {
            Bodies bodies = body_of(keys);
            for (int i = 0; i < 50; ++i) {
                bodies.rotor[0] = random_rotor(rng);
                const Vec4 axis = to_matrix(bodies.rotor[0]).transpose() * Vec4::UnitW();
                const double half =
                    std::visit([&](const auto& s) { return support(s, axis).dot(axis); },
                               bodies.types[0].shape);
                const render::Camera camera(render::CameraDescription(), 64, 48);
                const SliceFrame frame(camera, camera);
                const Sections sections(bodies, {0.01, 100});
                bodies.position[0][3] = -half - 1e-6;
                EXPECT_TRUE(sections.of(bodies, 0, frame).is_empty()) << keys;
                bodies.position[0][3] = -half + 1e-2;
                EXPECT_FALSE(sections.of(bodies, 0, frame).is_empty()) << keys;
            }
        }
}

TEST(Sections, OfPlanesFaceTheFreeSideAndEndInTheCube) {
    Rng rng(7);
    for (int i = 0; i < 50; ++i) {
        Bodies bodies = body_of("shape = \"hyperplane\"\nnormal = [1, 0, 0, 0]\noffset = 0");
        auto& plane = std::get<Hyperplane>(bodies.types[0].shape);
        plane.normal = random_unit(rng), plane.offset = uniform(rng, -2, 2);
        const render::Camera camera = random_camera(rng);
        const Mesh mesh = Sections(bodies, {0, 1000}).of(bodies, 0, SliceFrame(camera, camera));
        ASSERT_EQ(mesh.faces(), 1u);
        const auto corner = mesh.face(0);
        for (const Vec3& v : mesh.vertices) {
            EXPECT_NEAR(plane.normal.dot(to_world(camera, v)), plane.offset, 1e-9);
            EXPECT_NEAR(v.cwiseAbs().maxCoeff(), 1000, 1e-9);
        }
        const Vec3 up = (mesh.vertices[corner[1]] - mesh.vertices[corner[0]])
                            .cross(mesh.vertices[corner[2]] - mesh.vertices[corner[1]]);
        EXPECT_GT(plane.normal.dot(to_world(camera, up) - camera.origin()), 0);
    }
}

}  // namespace
}  // namespace tesserae::scenes
