#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

/// FORMULAS 3: a bounded shape is the points sum t_k g_k with |t_k| <= 1, widened by rho. Its
/// distance is found by descent on the t_k one at a time, not by the rooms' clamping.
struct Oracle {
    std::vector<LVec> generators;
    long double rho = 0;
    double size;  ///< what the accuracies in room.hpp are relative to

    explicit Oracle(const Hypersphere& s) : rho(s.radius), size(bounding_radius(s)) {}
    explicit Oracle(const Hypercapsule& s)
        : generators{LVec(0, s.height / 2.0L, 0, 0)}, rho(s.radius), size(bounding_radius(s)) {}
    explicit Oracle(const Hyperbox& s) : size(bounding_radius(s)) {
        for (int i = 0; i < 4; ++i) generators.push_back(LVec::Unit(i) * (s.size[i] / 2.0L));
    }

    /// max of d . x over the shape
    long double support(const LVec& d) const {
        long double sum = rho * d.norm();
        for (const LVec& g : generators) sum += std::abs(g.dot(d));
        return sum;
    }
    /// Distance of a point outside; 0 inside.
    long double outside(LVec p) const {
        std::vector<long double> t(generators.size(), 0);
        for (int sweep = 0; sweep < 3; ++sweep)
            for (std::size_t k = 0; k < t.size(); ++k) {
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
    /// Exact inside too: the depth is the least of support(n) - n . p over all unit n. For a box
    /// one of its cell normals has it; for a ball about a core it is at most rho, the radial one's.
    long double signed_distance(const LVec& p) const {
        if (const long double distance = outside(p); distance > 0) return distance;
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

/// All odd shapes, then random ones, `count` in all.
template <class S>
std::vector<S> sample_shapes(RandomGeometry& random, std::size_t count) {
    std::vector<S> shapes = odd_shapes<S>();
    while (shapes.size() < count) shapes.push_back(random_shape<S>(random));
    return shapes;
}

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
