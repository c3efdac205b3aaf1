// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>

#include "scenes/export/round_section.hpp"

namespace tesserae::scenes {
namespace {

/// Parts of an icosahedron's edge, usual 3 to 12; more than kFinestTolerance asks for.
constexpr int kMostParts = 256;

/// A unit ball's mesh and how far its faces' planes come to the centre at least.
struct GeodesicBall {
    Mesh mesh;
    double gap = 1;
};

/// The icosahedron's corners and faces, counter-clockwise seen from outside.
struct Icosahedron {
    std::vector<Vec3> corners;
    std::vector<std::array<int, 3>> faces;

    Icosahedron() {
        const double phi = 0.5 * (1 + std::sqrt(5.0));
        for (const double a : {-1.0, 1.0})
            for (const double b : {-phi, phi})
                for (int axis = 0; axis < 3; ++axis) {
                    Vec3 corner = Vec3::Zero();
                    corner[axis] = a, corner[(axis + 1) % 3] = b;
                    corners.push_back(corner);
                }
        // Neighbours are 2 apart, all others more.
        const auto are_near = [&](int i, int j) { return (corners[i] - corners[j]).norm() < 2.5; };
        for (int i = 0; i < 12; ++i)
            for (int j = i + 1; j < 12; ++j)
                for (int k = j + 1; k < 12; ++k) {
                    if (!are_near(i, j) || !are_near(j, k) || !are_near(i, k)) continue;
                    const bool is_outward = corners[i].dot(corners[j].cross(corners[k])) > 0;
                    faces.push_back(is_outward ? std::array{i, j, k} : std::array{i, k, j});
                }
    }
};

/// Every face cut into parts^2 triangles whose corners are moved out to the sphere.
GeodesicBall divided(int parts) {
    const Icosahedron ico;
    GeodesicBall ball;
    // A point by the corners that it lies between and its shares of them: faces that meet share it.
    using Shares = std::array<std::pair<int, int>, 3>;
    std::map<Shares, std::uint32_t> known;
    const auto point = [&](const std::array<int, 3>& face, int i, int j) {
        Shares shares = {{{face[0], parts - i - j}, {face[1], i}, {face[2], j}}};
        for (auto& share : shares)
            if (share.second == 0) share.first = -1;
        std::sort(shares.begin(), shares.end());
        const auto [at, is_new] =
            known.try_emplace(shares, static_cast<std::uint32_t>(ball.mesh.vertices.size()));
        if (is_new) {
            Vec3 sum = Vec3::Zero();
            for (const auto& [corner, share] : shares)
                if (corner >= 0) sum += share * ico.corners[static_cast<std::size_t>(corner)];
            ball.mesh.vertices.push_back(sum.normalized());
        }
        return at->second;
    };
    double nearest = 1;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        ball.mesh.add_face(std::array{a, b, c});
        const auto& v = ball.mesh.vertices;
        nearest = std::min(nearest, (v[b] - v[a]).cross(v[c] - v[a]).normalized().dot(v[a]));
    };
    for (const auto& face : ico.faces)
        for (int i = 0; i < parts; ++i)
            for (int j = 0; i + j < parts; ++j) {
                add(point(face, i, j), point(face, i + 1, j), point(face, i, j + 1));
                if (i + j + 2 <= parts)
                    add(point(face, i + 1, j), point(face, i + 1, j + 1), point(face, i, j + 1));
            }
    ball.gap = 1 - nearest;
    return ball;
}

/// Made once each; the same whoever asks first.
const GeodesicBall& geodesic_ball(int parts) {
    static std::mutex mutex;
    static std::map<int, std::unique_ptr<const GeodesicBall>> balls;
    const std::lock_guard lock(mutex);
    auto& ball = balls[parts];
    if (!ball) ball = std::make_unique<const GeodesicBall>(divided(parts));
    return *ball;
}

/// The coarsest that is within the tolerance of the unit ball.
const GeodesicBall& ball_within(double tolerance) {
    // The gap falls with the square of the parts; an icosahedron's own is 0.2054.
    int parts = std::clamp(static_cast<int>(std::sqrt(0.15 / tolerance)), 1, kMostParts);
    while (geodesic_ball(parts).gap > tolerance && parts < kMostParts) ++parts;
    return geodesic_ball(parts);
}

}  // namespace

Mesh ball_mesh(const Vec3& centre, double radius, double tolerance) {
    Mesh mesh = ball_within(tolerance / radius).mesh;
    for (Vec3& v : mesh.vertices) v = centre + radius * v;
    return mesh;
}

}  // namespace tesserae::scenes
