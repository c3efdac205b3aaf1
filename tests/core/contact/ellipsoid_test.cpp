// SPDX-License-Identifier: Apache-2.0
// What a new shape costs: an ellipsoid's room, with what any convex body can be given for its
// distance and rim, and its view for the general pair function. Nothing else knows of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/contact/convex_views.hpp"
#include "core/shape/convex_rim.hpp"
#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

/// The points with |x / half axes| <= 1.
struct Ellipsoid {
    static constexpr const char* kName = "ellipsoid";
    static constexpr bool kBounded = true;
    Vec4 half = Vec4::Ones();

    friend bool operator==(const Ellipsoid& a, const Ellipsoid& b) { return a.half == b.half; }
    template <class Self, class Visit>
    static void parameters(Self& self, Visit&& visit) {
        visit({"half", "m", "The half axes have these lengths."}, self.half, Rule::kPositive);
    }
};

void complete(Ellipsoid&) {}
double volume(const Ellipsoid& s) { return 0.5 * M_PI * M_PI * s.half.prod(); }
Vec4 second_moments(const Ellipsoid& s, double mass) {
    return mass / 6 * s.half.cwiseProduct(s.half);
}
double bounding_radius(const Ellipsoid& s) { return s.half.maxCoeff(); }
double half_extent_along(const Ellipsoid& s, const Vec4& d) {
    return s.half.cwiseProduct(d).norm();
}
Vec4 half_extents(const Ellipsoid& s, const Mat4& rotation) {
    return (rotation * s.half.asDiagonal()).rowwise().norm();
}
Vec4 support(const Ellipsoid& s, const Vec4& d) {
    const Vec4 scaled = s.half.cwiseProduct(d);
    return scaled.isZero(0) ? Vec4(Vec4::Zero()) : s.half.cwiseProduct(scaled.normalized());
}
ConvexSeparation separation_from(const Ellipsoid& s, const Vec4& point) {
    const auto surface = [&](const Vec4& d) { return support(s, d); };
    const auto there = [&](const Vec4&) { return point; };
    return separation_of(surface, there, point.isZero(0) ? Vec4(Vec4::UnitY()) : point,
                         bounding_radius(s));
}
double signed_distance(const Ellipsoid& s, const Vec4& p) { return separation_from(s, p).distance; }
Vec4 normal(const Ellipsoid& s, const Vec4& p) { return separation_from(s, p).normal; }
/// Both roots of |(o + t d) / half| = 1.
std::pair<double, double> roots(const Ellipsoid& s, const Vec4& o, const Vec4& d) {
    const Vec4 p = o.cwiseQuotient(s.half), v = d.cwiseQuotient(s.half);
    const double middle = -p.dot(v) / v.squaredNorm();
    const double square = (1 - (p + middle * v).squaredNorm()) / v.squaredNorm();
    if (!(square >= 0)) return {kMiss, -kMiss};
    return {middle - std::sqrt(square), middle + std::sqrt(square)};
}
double ray_hit(const Ellipsoid& s, const Vec4& o, const Vec4& d) {
    const auto [enter, leave] = roots(s, o, d);
    return leave < 0 ? kMiss : std::max(0.0, enter);
}
double ray_exit(const Ellipsoid& s, const Vec4& o, const Vec4& d) {
    return std::max(0.0, roots(s, o, d).second);
}
Rim rim(const Ellipsoid& s, const Vec4& o, const Vec4& d, const RimRange& range) {
    return convex_rim(s, o, d, range);
}
static_assert(ShapeRoom<Ellipsoid>);

// For the general pair function: a point where it looks along a direction.
double core_radius(const Ellipsoid&) { return 0; }
Vec4 core_support(const Ellipsoid& s, const Vec4& d) { return support(s, d); }
void piece_along(const Ellipsoid& s, const Vec4& direction, SurfacePiece& piece) {
    piece.vertices = {support(s, direction)};
    piece.names = {0};
}

Rotor any_turn(RandomGeometry& random) {
    return exp(Bivector{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3),
                        random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)});
}

template <class B>
Contact touch(const Ellipsoid& a, const Rotor& turn, const B& b, const Vec4& at,
              const Rotor& other_turn) {
    std::vector<Contact> list;
    PairContacts out{0, 1, false, list};
    general_contacts(a, {Vec4::Zero(), turn}, b, {at, other_turn}, kMiss, out);
    return *std::min_element(list.begin(), list.end(), [](const Contact& p, const Contact& q) {
        return p.separation < q.separation;
    });
}

/// Of equal half axes it is a ball: the distance of the ball's centre from the other body.
TEST(Ellipsoid, OfEqualAxesTouchesAsABallDoes) {
    RandomGeometry random(71);
    for (int i = 0; i < 300; ++i) {
        const Hyperbox box = random_shape<Hyperbox>(random);
        const double radius = random.log_uniform(0.3, 3);
        const double reach = bounding_radius(box) + radius;
        const Vec4 at = random.uniform(0.7, 1.2) * reach * random.direction();
        const Rotor turn = any_turn(random);
        const double centre = signed_distance(box, to_matrix(turn).transpose() * -at);
        if (centre < 0.1 * radius) continue;
        const Contact c = touch(Ellipsoid{Vec4::Constant(radius)}, any_turn(random), box, at, turn);
        // In overlap a round body's least is found to kRoundOverlapAccuracy.
        const double accuracy = centre > radius ? kRoundAccuracy : kRoundOverlapAccuracy;
        EXPECT_NEAR(c.separation, centre - radius, accuracy * reach) << i;
    }
}

/// No plane tells the bodies apart by more, and the contact's own does by as much.
TEST(Ellipsoid, IsAsFarApartAsTheWidestGap) {
    RandomGeometry random(72);
    for (int i = 0; i < 200; ++i) {
        const Ellipsoid a{{random.log_uniform(0.3, 3), random.log_uniform(0.3, 3),
                           random.log_uniform(0.3, 3), random.log_uniform(0.3, 3)}};
        const Duocylinder b = random_shape<Duocylinder>(random);
        const Rotor turn_a = any_turn(random), turn_b = any_turn(random);
        const double reach = bounding_radius(a) + bounding_radius(b);
        const Vec4 at = random.uniform(0.5, 1.2) * reach * random.direction();
        const auto gap = [&](const Vec4& n) {
            return n.dot(at) - half_extent_along(a, to_matrix(turn_a).transpose() * n) -
                   half_extent_along(b, to_matrix(turn_b).transpose() * n);
        };
        const Contact c = touch(a, turn_a, b, at, turn_b);
        EXPECT_NEAR(gap(c.normal), c.separation, 1e-12 * reach) << i;
        if (c.separation < 0) continue;
        for (int k = 0; k < 2000; ++k) EXPECT_LE(gap(random.direction()), c.separation + 1e-12);
        for (int k = 0; k < 500; ++k) {
            const Vec4 near = (c.normal + 1e-3 * random.direction()).normalized();
            EXPECT_LE(gap(near), c.separation + 1e-12 * reach) << i;
        }
    }
}

}  // namespace
}  // namespace tesserae
