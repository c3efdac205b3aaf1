// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <random>
#include <tuple>
#include <variant>
#include <vector>

#include "core/shape/shape.hpp"

// What the property tests of all rooms share: random shapes, odd shapes, and an oracle that knows a
// shape only as a set, in long double.
namespace tesserae {

using LVec = Eigen::Matrix<long double, 4, 1>;

struct RandomGeometry {
    std::mt19937_64 engine;
    explicit RandomGeometry(std::uint64_t seed) : engine(seed) {}

    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }
    double log_uniform(double low, double high) {
        return std::exp(uniform(std::log(low), std::log(high)));
    }
    Vec4 in_box(const Vec4& half) {
        return {uniform(-half[0], half[0]), uniform(-half[1], half[1]), uniform(-half[2], half[2]),
                uniform(-half[3], half[3])};
    }
    Vec4 direction() {
        std::normal_distribution<double> gauss;
        return Vec4(gauss(engine), gauss(engine), gauss(engine), gauss(engine)).normalized();
    }
};

/// The bounded ones of a list of shapes, as types of a test suite.
template <class... S>
auto bounded_of(const std::variant<S...>&) {
    const auto types = []<class... B>(std::tuple<B...>) { return ::testing::Types<B...>{}; };
    return types(std::tuple_cat(std::conditional_t<S::kBounded, std::tuple<S>, std::tuple<>>{}...));
}
/// A shape that joins the list joins every property suite.
using BoundedShapes = decltype(bounded_of(Shape{}));

/// The point of a hull nearest to the origin, by Wolfe's method (1976) in long double.
LVec nearest_of_hull(const std::vector<LVec>& points);

struct LeastOfConvex {
    long double at, value;
};
/// The least of a convex function from `low` to `high`, by so many golden sections.
template <class Function>
LeastOfConvex least_of_convex(long double low, long double high, int sections,
                              const Function& function) {
    const long double golden = 0.6180339887498948482L;
    long double a = high - golden * (high - low), b = low + golden * (high - low);
    long double at_a = function(a), at_b = function(b);
    const long double at_low = function(low), at_high = function(high);
    LeastOfConvex least =
        at_low < at_high ? LeastOfConvex{low, at_low} : LeastOfConvex{high, at_high};
    for (int i = 0; i < sections; ++i) {
        if (at_a < least.value) least = {a, at_a};
        if (at_b < least.value) least = {b, at_b};
        if (at_a < at_b) {
            high = b, b = a, at_b = at_a;
            a = high - golden * (high - low), at_a = function(a);
        } else {
            low = a, a = b, at_a = at_b;
            b = low + golden * (high - low), at_b = function(b);
        }
    }
    return least;
}

/// core/FORMULAS.md 3: a bounded shape is the points sum t_k g_k with |t_k| <= 1, widened by rho.
/// Its distance is found by descent on the t_k one at a time, not by the rooms' clamping. A
/// polychoron is the hull of its points. A product of balls is what is in a ball along some axes
/// and in another along the others.
struct Oracle {
    struct Ball {
        std::vector<int> axes;
        long double radius;

        long double part_of(const LVec& p) const {
            long double squares = 0;
            for (const int axis : axes) squares += p[axis] * p[axis];
            return std::sqrt(squares);
        }
    };
    std::vector<LVec> generators;
    std::vector<LVec> points;                          ///< of a hull
    std::vector<std::pair<LVec, long double>> planes;  ///< of its cells
    std::vector<Ball> balls;                           ///< of a product
    long double rho = 0;
    double size;  ///< what the accuracies in room.hpp are relative to

    explicit Oracle(const Hypersphere& s) : rho(s.radius), size(bounding_radius(s)) {}
    explicit Oracle(const Hypercapsule& s)
        : generators{LVec(0, s.height / 2.0L, 0, 0)}, rho(s.radius), size(bounding_radius(s)) {}
    explicit Oracle(const Hyperbox& s) : size(bounding_radius(s)) {
        for (int i = 0; i < 4; ++i) generators.push_back(LVec::Unit(i) * (s.size[i] / 2.0L));
    }

    explicit Oracle(const Spherinder& s)
        : balls{{{0, 2, 3}, s.radius}, {{1}, s.height / 2.0L}}, size(bounding_radius(s)) {}
    explicit Oracle(const Cubinder& s)
        : balls{{{0, 1}, s.radius}, {{2}, s.size[0] / 2.0L}, {{3}, s.size[1] / 2.0L}},
          size(bounding_radius(s)) {}
    explicit Oracle(const Duocylinder& s)
        : balls{{{0, 1}, s.radii[0]}, {{2, 3}, s.radii[1]}}, size(bounding_radius(s)) {}

    explicit Oracle(const HullShape& s) : size(bounding_radius(s)) {
        const Hull& hull = s.body->hull;
        for (const Vec4& vertex : hull.vertices) points.push_back(vertex.cast<long double>());
        for (const HullCell& cell : hull.cells) {
            // The normal again, orthogonal to all edges from the first vertex.
            const LVec first = points[cell.vertices[0]];
            LVec n = cell.plane.normal.cast<long double>(), mean = LVec::Zero();
            std::vector<LVec> edges;
            for (const auto i : cell.vertices) {
                edges.push_back((points[i] - first) / size);
                mean += points[i] / static_cast<long double>(cell.vertices.size());
            }
            for (int dimension = 0; dimension < 3; ++dimension) {
                const LVec longest =
                    std::max_element(edges.begin(), edges.end(), [](const LVec& a, const LVec& b) {
                        return a.norm() < b.norm();
                    })->normalized();
                for (LVec& edge : edges) edge -= longest.dot(edge) * longest;
                n -= longest.dot(n) * longest;
            }
            n.normalize();
            planes.push_back({n, n.dot(mean)});
        }
    }

    /// max of d . x over the shape
    long double support(const LVec& d) const {
        if (!points.empty()) {
            long double most = points[0].dot(d);
            for (const LVec& p : points) most = std::max(most, p.dot(d));
            return most;
        }
        long double sum = rho * d.norm();
        for (const LVec& g : generators) sum += std::abs(g.dot(d));
        for (const Ball& ball : balls) sum += ball.radius * ball.part_of(d);
        return sum;
    }
    /// Distance of a point outside; 0 inside.
    long double outside(LVec p) const {
        if (!balls.empty()) {
            LVec nearest = p;
            for (const Ball& ball : balls)
                if (const long double part = ball.part_of(p); part > ball.radius)
                    for (const int axis : ball.axes) nearest[axis] *= ball.radius / part;
            const long double distance = (p - nearest).norm();
            return distance > 1e-18L * (size + p.norm()) ? distance : 0;
        }
        if (!points.empty()) {
            const long double deepest = deepest_plane(p);
            if (deepest <= 0) return 0;
            std::vector<LVec> seen;
            for (const LVec& q : points) seen.push_back((q - p) / size);
            return std::max(deepest, nearest_of_hull(seen).norm() * size);
        }
        std::array<long double, 4> t = {};
        for (int sweep = 0; sweep < 3; ++sweep)
            for (std::size_t k = 0; k < generators.size(); ++k) {
                const LVec& g = generators[k];
                const long double square = g.squaredNorm();
                if (square == 0) continue;
                const long double wanted = std::clamp(t[k] + p.dot(g) / square, -1.0L, 1.0L);
                p -= (wanted - t[k]) * g;
                t[k] = wanted;
            }
        // The descent's own rounding, well below double's, is no distance.
        const long double distance = p.norm() - rho;
        return distance > 1e-18L * size ? distance : 0;
    }
    bool holds(const LVec& p) const {
        return points.empty() ? !(outside(p) > 0) : deepest_plane(p) <= 0;
    }
    /// Exact inside too: the depth is the least of support(n) - n . p over all unit n. For a box
    /// one of its cell normals has it; for a ball about a core it is at most rho, the radial one's.
    long double signed_distance(const LVec& p) const {
        if (const long double distance = outside(p); distance > 0) return distance;
        if (!points.empty()) return deepest_plane(p);
        if (!balls.empty()) {
            // Along a ball's part the surface is as far as its radius leaves; nowhere is it nearer.
            long double deepest = -size;
            for (const Ball& ball : balls)
                deepest = std::max(deepest, ball.part_of(p) - ball.radius);
            return deepest;
        }
        if (rho == 0) {
            long double deepest = -support(LVec::UnitX());
            for (const LVec& g : generators)
                for (const LVec& n : {LVec(g.normalized()), LVec(-g.normalized())})
                    deepest = std::max(deepest, n.dot(p) - support(n));
            return deepest;
        }
        LVec radial = p;
        for (const LVec& g : generators)
            if (g.norm() > 0) radial -= std::clamp(p.dot(g) / g.squaredNorm(), -1.0L, 1.0L) * g;
        return radial.norm() - rho;
    }
    long double deepest_plane(const LVec& p) const {
        long double deepest = -std::numeric_limits<long double>::infinity();
        for (const auto& [normal, offset] : planes)
            deepest = std::max(deepest, normal.dot(p) - offset);
        return deepest;
    }
};

template <class S>
S random_shape(RandomGeometry& random);
template <>
inline Hypersphere random_shape(RandomGeometry& random) {
    return {random.log_uniform(0.1, 10)};
}
template <>
inline Hypercapsule random_shape(RandomGeometry& random) {
    const double radius = random.log_uniform(0.1, 10);
    return {radius, random.uniform(0, 1) < 0.1 ? 0.0 : random.log_uniform(0.01, 100)};
}
template <>
inline Hyperbox random_shape(RandomGeometry& random) {
    Hyperbox box;
    for (double& side : box.size) side = random.log_uniform(0.1, 10);
    return box;
}

inline Polychoron hull_shape(std::vector<Vec4> vertices) {
    Polychoron shape;
    shape.regular = RegularPolychoron::kNone;
    shape.vertices = std::move(vertices);
    complete(shape);
    return shape;
}
inline Polychoron regular_shape(RegularPolychoron which, double radius) {
    Polychoron shape;
    shape.regular = which;
    shape.radius = radius;
    complete(shape);
    return shape;
}
/// A regular one, or the hull of points that are stretched along the axes.
template <>
inline Polychoron random_shape(RandomGeometry& random) {
    if (random.uniform(0, 1) < 0.3)
        return regular_shape(static_cast<RegularPolychoron>(random.uniform(1, 5)),
                             random.log_uniform(0.1, 10));
    Vec4 half;
    for (double& h : half) h = random.log_uniform(0.1, 10);
    std::vector<Vec4> points(static_cast<std::size_t>(random.uniform(5, 25)));
    for (Vec4& p : points) p = random.in_box(half);
    return hull_shape(points);
}

template <>
inline Duoprism random_shape(RandomGeometry& random) {
    Duoprism shape;
    for (auto& sides : shape.polygons) sides = static_cast<std::int64_t>(random.uniform(3, 6));
    for (double& radius : shape.radii) radius = random.log_uniform(0.1, 10);
    complete(shape);
    return shape;
}
inline Spherinder spherinder(double radius, double height) {
    Spherinder shape;
    shape.radius = radius, shape.height = height;
    complete(shape);
    return shape;
}
inline Cubinder cubinder(double radius, const Vec2& size) {
    Cubinder shape;
    shape.radius = radius, shape.size = size;
    complete(shape);
    return shape;
}
inline Duocylinder duocylinder(const Vec2& radii) {
    Duocylinder shape;
    shape.radii = radii;
    complete(shape);
    return shape;
}
template <>
inline Spherinder random_shape(RandomGeometry& random) {
    return spherinder(random.log_uniform(0.1, 10), random.log_uniform(0.1, 10));
}
template <>
inline Cubinder random_shape(RandomGeometry& random) {
    return cubinder(random.log_uniform(0.1, 10),
                    {random.log_uniform(0.1, 10), random.log_uniform(0.1, 10)});
}
template <>
inline Duocylinder random_shape(RandomGeometry& random) {
    return duocylinder({random.log_uniform(0.1, 10), random.log_uniform(0.1, 10)});
}

/// Tiny, huge, stretched 1e4 to 1, without a core.
template <class S>
std::vector<S> odd_shapes();
template <>
inline std::vector<Hypersphere> odd_shapes() {
    return {{1}, {1e-6}, {1e6}, {1e-150}, {1e150}};
}
template <>
inline std::vector<Hypercapsule> odd_shapes() {
    return {{1, 0},     {1, 1e4},         {1, 1e-4},     {1e-6, 1e-6},
            {1e6, 1e6}, {1e-150, 1e-150}, {1e150, 1e150}};
}
template <>
inline std::vector<Hyperbox> odd_shapes() {
    return {{{1, 1, 1, 1}},          {{1e4, 1, 1, 1}},           {{1, 1e-4, 1, 1}},
            {{1, 1e4, 1, 1e4}},      {{1e-6, 1e-6, 2e-6, 1e-6}}, {{1e6, 1e6, 1e6, 2e6}},
            {1e-150 * Vec4::Ones()}, {1e150 * Vec4::Ones()}};
}

/// Also with points inside, on faces and twice, and with all cells alike.
template <>
inline std::vector<Polychoron> odd_shapes() {
    const auto box = [](const Vec4& half) {
        std::vector<Vec4> corners;
        for (unsigned signs = 0; signs < 16; ++signs) {
            corners.push_back(half);
            for (int i = 0; i < 4; ++i)
                if (signs >> i & 1) corners.back()[i] = -half[i];
        }
        return corners;
    };
    std::vector<Vec4> crowded = box(Vec4::Ones());
    crowded.insert(crowded.end(), {{0, 0, 0, 0}, {1, 0, 0, 0}, {1, 1, 0, 0}, {1, 1, 1, 0}});
    crowded.push_back(crowded.front());
    using enum RegularPolychoron;
    return {regular_shape(k24Cell, 1),        regular_shape(k16Cell, 1e-6),
            regular_shape(k5Cell, 1e6),       hull_shape(box({1e4, 1, 1, 1})),
            hull_shape(box({1, 1e-4, 1, 1})), hull_shape(crowded),
            regular_shape(k8Cell, 1e-150),    regular_shape(k24Cell, 1e150)};
}

template <>
inline std::vector<Duoprism> odd_shapes() {
    const auto duoprism = [](std::int64_t p, std::int64_t q, const Vec2& radii) {
        Duoprism shape;
        shape.polygons = {p, q}, shape.radii = radii;
        complete(shape);
        return shape;
    };
    return {duoprism(3, 3, {1, 1}),     duoprism(4, 4, {1, 1}),
            duoprism(3, 9, {1, 1e-3}),  duoprism(3, 5, {1e-6, 1e-6}),
            duoprism(3, 6, {1e6, 1e6}), duoprism(3, 4, {1e150, 1e150})};
}
template <>
inline std::vector<Spherinder> odd_shapes() {
    return {spherinder(1, 1),       spherinder(1, 1e4),         spherinder(1e4, 1),
            spherinder(1e-6, 1e-6), spherinder(1e-150, 1e-150), spherinder(1e150, 1e150)};
}
template <>
inline std::vector<Cubinder> odd_shapes() {
    return {cubinder(1, {1, 1}),
            cubinder(1, {1e4, 1}),
            cubinder(1, {1e-4, 1e-4}),
            cubinder(1e-6, {1e-6, 1e-6}),
            cubinder(1e-150, {1e-150, 1e-150}),
            cubinder(1e150, {1e150, 1e150})};
}
template <>
inline std::vector<Duocylinder> odd_shapes() {
    return {duocylinder({1, 1}),       duocylinder({1, 1e4}),         duocylinder({1, 1e-4}),
            duocylinder({1e-6, 1e-6}), duocylinder({1e-150, 1e-150}), duocylinder({1e150, 1e150})};
}

/// How much of a suite a shape gets whose oracle takes long.
template <class S>
constexpr double kShare = std::is_same_v<S, Duoprism>       ? 0.05
                          : std::derived_from<S, HullShape> ? 0.2
                                                            : 1;

/// All odd shapes, then random ones, that share of `count` in all.
template <class S>
std::vector<S> sample_shapes(RandomGeometry& random, std::size_t count) {
    std::vector<S> shapes = odd_shapes<S>();
    while (static_cast<double>(shapes.size()) < kShare<S> * static_cast<double>(count))
        shapes.push_back(random_shape<S>(random));
    return shapes;
}

/// Makes a shape's parameter so many times as large.
inline void scale_parameter(double& value, double factor) { value *= factor; }
inline void scale_parameter(Vec4& value, double factor) { value *= factor; }
inline void scale_parameter(std::vector<Vec4>& values, double factor) {
    for (Vec4& value : values) value *= factor;
}
inline void scale_parameter(Vec2& value, double factor) { value *= factor; }
inline void scale_parameter(RegularPolychoron&, double) {}
inline void scale_parameter(std::array<std::int64_t, 2>&, double) {}

/// A point in or around the shape: half of them in a box 1.5 times its bounds, the others pulled to
/// the surface or onto the axes, where distances have their edges.
template <class S>
Vec4 sample_point(const S& shape, RandomGeometry& random) {
    const Vec4 half = half_extents(shape, Mat4::Identity());
    Vec4 p = random.in_box(1.5 * half);
    const double kind = random.uniform(0, 1);
    if (kind < 0.2) p -= signed_distance(shape, p) * normal(shape, p);
    if (kind > 0.6)
        for (double& x : p)
            if (random.uniform(0, 1) < 0.3) x = 0;
    return p;
}

}  // namespace tesserae
