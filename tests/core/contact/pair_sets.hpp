// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "tests/core/contact/pair_oracle.hpp"

// Sets of pairs, and the properties that every pair of bounded shapes is held to on them.
namespace tesserae {

inline Rotor random_rotor(RandomGeometry& random) {
    const auto angle = [&] { return random.uniform(-M_PI, M_PI); };
    return exp(Bivector{angle(), angle(), angle(), angle(), angle(), angle()});
}

template <class T>
const T& one_of(RandomGeometry& random, const std::vector<T>& choices) {
    return choices[static_cast<std::size_t>(
        random.uniform(0, static_cast<double>(choices.size()) * (1 - 1e-12)))];
}

/// Any sizes and turns; from one centre inside the other body to well apart.
template <class A, class B>
std::pair<Placed<A>, Placed<B>> random_pair(RandomGeometry& random) {
    const Vec4 place = random.in_box(Vec4::Constant(10));
    Placed<A> a{random_shape<A>(random), place, random_rotor(random)};
    Placed<B> b{random_shape<B>(random), place, random_rotor(random)};
    const double reach = bounding_radius(a.shape) + bounding_radius(b.shape);
    b.position += random.uniform(0, 1.2) * reach * random.direction();
    return {a, b};
}

inline void degenerate_size(RandomGeometry& random, double& size) {
    size = one_of(random, std::vector<double>{1, 1, 1, 2, 0.5, 1e4, 1e-4});
}
inline Hypersphere degenerate_shape(RandomGeometry& random, Hypersphere s) {
    degenerate_size(random, s.radius);
    return s;
}
inline Hypercapsule degenerate_shape(RandomGeometry& random, Hypercapsule s) {
    degenerate_size(random, s.radius);
    degenerate_size(random, s.height);
    if (random.uniform(0, 1) < 0.1) s.height = 0;
    return s;
}
inline Hyperbox degenerate_shape(RandomGeometry& random, Hyperbox s) {
    for (double& side : s.size) degenerate_size(random, side);
    return s;
}
inline void scale(Hypersphere& s, double k) { s.radius *= k; }
inline void scale(Hypercapsule& s, double k) { s.radius *= k, s.height *= k; }
inline void scale(Hyperbox& s, double k) { s.size *= k; }

/// Equal sizes and 1e4 to 1, turned alike or by right angles or by 1e-12 and 1e-9 more, at offsets
/// that are multiples of their half sizes along their axes (coincident, flush, touching), give or
/// take 1e-12; sizes of 1e-3 to 1e3, at the origin and 1e4 from it.
template <class A, class B>
std::pair<Placed<A>, Placed<B>> degenerate_pair(RandomGeometry& random) {
    Placed<A> a{degenerate_shape(random, A{})};
    Placed<B> b{degenerate_shape(random, B{})};
    const std::vector<double> turns{0, 0, M_PI / 2, M_PI, M_PI / 4, 1e-12, 1e-9, -1e-15};
    const auto turn = [&] {
        const auto half = [&] {
            return random.uniform(0, 1) < 0.6 ? 0 : one_of(random, turns) / 2;
        };
        return exp(Bivector{half(), half(), half(), half(), half(), half()});
    };
    if (random.uniform(0, 1) < 0.5) a.rotor = random_rotor(random);
    b.rotor = random.uniform(0, 1) < 0.2 ? random_rotor(random) : turn() * a.rotor;

    // Offsets in multiples of what either body measures along A's axes.
    const Vec4 half_a = half_extents(a.shape, Mat4::Identity());
    const Vec4 half_b = half_extents(b.shape, to_matrix(reverse(a.rotor) * b.rotor));
    const std::vector<double> multiples{0, 0, 0, 1, -1, 0.5};
    const std::vector<double> nudges{0, 0, 1e-12, -1e-12, 1e-9, 1e-6};
    Vec4 offset;
    for (int i = 0; i < 4; ++i)
        offset[i] = one_of(random, multiples) * half_a[i] + one_of(random, multiples) * half_b[i] +
                    one_of(random, nudges) * std::min(half_a[i], half_b[i]);
    b.position = rotate(a.rotor, offset);

    const double size = one_of(random, std::vector<double>{1, 1, 1e-3, 1e3, 0.3});
    scale(a.shape, size);
    scale(b.shape, size);
    b.position *= size;
    if (random.uniform(0, 1) < 0.3) {
        const Vec4 far = 1e4 * random.direction();
        a.position += far;
        b.position += far;
    }
    return {a, b};
}

/// The pair functions' own rounding: some twenty operations on coordinates of the size that the
/// errors are relative to, each to 2^-53, of which worst cases do not add up.
constexpr double kPairAccuracy = 1e-14;
/// Of the points on flush surfaces, which may lie off them by the border of a clipped cell (1e-10).
constexpr double kSideAccuracy = 1e-9;

template <class A, class B>
void expect_exact(std::pair<Placed<A>, Placed<B>> (*draw)(RandomGeometry&), int count,
                  const char* set, double side_accuracy = kSideAccuracy) {
    RandomGeometry random(11);
    PairErrors errors;
    for (int i = 0; i < count; ++i) {
        const auto [a, b] = draw(random);
        SCOPED_TRACE(i);
        measure(a, b, errors);
        if (::testing::Test::HasFatalFailure()) return;
    }
    errors.print(set);
    EXPECT_LT(errors.separation, kPairAccuracy);
    EXPECT_LT(errors.touch, kPairAccuracy);
    EXPECT_LT(errors.surface, side_accuracy);
    EXPECT_LT(errors.outside, side_accuracy);
}

/// The same bodies after an orthogonal map of the whole world; a mirror is one too, since every
/// shape is its own mirror image across its x axis.
template <class S>
Placed<S> mapped(const Placed<S>& body, const Mat4& map, const Vec4& shift) {
    Mat4 own = Mat4::Identity();
    own(0, 0) = map.determinant() < 0 ? -1 : 1;
    return {body.shape, map * body.position + shift, to_rotor(map * to_matrix(body.rotor) * own)};
}

/// A rotation, a permutation of the axes or a mirror.
inline Mat4 random_symmetry(RandomGeometry& random) {
    const double kind = random.uniform(0, 3);
    if (kind < 1) return to_matrix(random_rotor(random));
    Mat4 map = Mat4::Identity();
    if (kind < 2) {
        Eigen::Vector4i order(0, 1, 2, 3);
        std::shuffle(order.begin(), order.end(), random.engine);
        for (int i = 0; i < 4; ++i) map.col(i) = Vec4::Unit(order[i]);
    } else {
        const int axis = one_of(random, std::vector<int>{0, 1, 2, 3});
        map(axis, axis) = -1;
    }
    return map;
}

/// Mapping the world and exchanging the bodies change the answer by rounding only.
template <class A, class B>
void expect_symmetric(std::pair<Placed<A>, Placed<B>> (*draw)(RandomGeometry&), int count) {
    RandomGeometry random(12);
    for (int i = 0; i < count; ++i) {
        const auto [a, b] = draw(random);
        const Mat4 map = random_symmetry(random);
        const Vec4 shift = random.in_box(Vec4::Constant(10));
        const Placed<A> a2 = mapped(a, map, shift);
        const Placed<B> b2 = mapped(b, map, shift);
        const double size = static_cast<double>(a.zonotope().size() + b.zonotope().size()) +
                            (a.position - b.position).norm();
        // The mapped positions are rounded where they are.
        const double error = kPairAccuracy * (size + a.position.norm() + shift.norm());

        const Contact c = deepest(contacts_of(a, b));
        const Contact mapped_c = deepest(contacts_of(a2, b2));
        const Contact swapped = deepest(contacts_of(b, a));
        ASSERT_NEAR(mapped_c.separation, c.separation, error) << i;
        ASSERT_NEAR(swapped.separation, c.separation, error) << i;
        // Cores that are apart have one normal, which turns by rounding over their distance; where
        // they are nearly parallel also by their angle, as the closest point jumps along them.
        if (draw == degenerate_pair<A, B>) continue;
        const double apart =
            static_cast<double>(a.zonotope().rho + b.zonotope().rho) + c.separation;
        if (apart < 1e-3 * size) continue;
        ASSERT_LT((map * c.normal - mapped_c.normal).norm(), 4 * error / apart) << i;
        ASSERT_LT((c.normal + swapped.normal).norm(), 4 * error / apart) << i;
    }
}

/// A separation is 1-Lipschitz in where the bodies are: a nudge moves it by no more than itself.
template <class A, class B>
void expect_no_jump(int count) {
    RandomGeometry random(13);
    constexpr double kNudge = 1e-9;
    for (int i = 0; i < count; ++i) {
        auto [a, b] = degenerate_pair<A, B>(random);
        const double reach = bounding_radius(b.shape);
        const double size = bounding_radius(a.shape) + reach + (a.position - b.position).norm();
        const double before = deepest(contacts_of(a, b)).separation;
        b.position += kNudge * random.direction();
        b.rotor = exp(kNudge / reach * Bivector{0.5, 0, 0, 0, 0, 0.5}) * b.rotor;
        const double after = deepest(contacts_of(a, b)).separation;
        // The turn moves no point by more than the nudge.
        ASSERT_LE(std::abs(after - before), 2 * kNudge + kPairAccuracy * (size + a.position.norm()))
            << i;
    }
}

/// No gap along any of 20,000 directions exceeds the separation.
template <class A, class B>
void expect_bounds_every_gap(int count) {
    RandomGeometry random(14);
    std::vector<LVec> directions;
    for (int i = 0; i < 20000; ++i)
        directions.push_back(random.direction().cast<long double>().normalized());
    for (int i = 0; i < count; ++i) {
        const auto [a, b] = random_pair<A, B>(random);
        const Zonotope za = a.zonotope(), zb = b.zonotope();
        const LVec between = zb.centre - za.centre;
        const long double size = between.norm() + za.size() + zb.size();
        const long double separation = deepest(contacts_of(a, b)).separation;
        for (const LVec& d : directions)
            ASSERT_LE(d.dot(between) - za.extent(d) - zb.extent(d),
                      separation + kPairAccuracy * size)
                << i;
    }
}

/// Contacts, or none, but no NaN: odd shapes at odd places, far beyond what a scene holds.
template <class A, class B>
void expect_no_nan() {
    RandomGeometry random(15);
    for (const A& shape_a : odd_shapes<A>())
        for (const B& shape_b : odd_shapes<B>())
            for (double place : {0.0, 1e-300, 1e-160, 1e-9, 1.0, 1e4, 1e150, 1e300})
                for (int turn = 0; turn < 4; ++turn) {
                    Placed<A> a{shape_a};
                    Placed<B> b{shape_b};
                    if (turn & 1) a.rotor = random_rotor(random);
                    if (turn & 2) b.rotor = random_rotor(random);
                    b.position = place * Vec4(1, 0, -1, 0.5);
                    for (const Contact& c : contacts_of(a, b)) {
                        ASSERT_FALSE(std::isnan(c.separation));
                        ASSERT_NEAR(c.normal.norm(), 1, 1e-15);
                        ASSERT_FALSE(c.point.hasNaN());
                    }
                }
}

/// What lies beyond the margin is left out, and nothing else.
template <class A, class B>
void expect_margin_kept(int count) {
    RandomGeometry random(16);
    for (int i = 0; i < count; ++i) {
        const auto [a, b] = random_pair<A, B>(random);
        const std::vector<Contact> all = contacts_of(a, b);
        const double margin = deepest(all).separation + random.uniform(-0.1, 1);
        const std::vector<Contact> some = contacts_of(a, b, margin);
        std::size_t kept = 0;
        for (const Contact& c : all) {
            if (c.separation > margin) continue;
            ASSERT_LT(kept, some.size()) << i;
            ASSERT_EQ(some[kept].feature, c.feature) << i;
            ASSERT_EQ(some[kept].separation, c.separation) << i;
            ++kept;
        }
        ASSERT_EQ(kept, some.size()) << i;
    }
}

/// All of these on as many pairs as the fast set has time for.
template <class A, class B>
void expect_all_properties(int count) {
    expect_exact<A, B>(random_pair, count, "random");
    expect_exact<A, B>(degenerate_pair, count, "degenerate");
    expect_symmetric<A, B>(random_pair, count);
    expect_symmetric<A, B>(degenerate_pair, count);
    expect_no_jump<A, B>(10 * count);
    expect_bounds_every_gap<A, B>(20);
    expect_no_nan<A, B>();
    expect_margin_kept<A, B>(count);
}

}  // namespace tesserae
