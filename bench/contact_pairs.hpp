// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <vector>

#include "core/contact/find_contacts.hpp"

// Random pairs of bodies in 4D, and one call that finds their contacts.
namespace tesserae::bench {

using Random = std::mt19937_64;

/// Sides, heights and diameters [m].
constexpr double kLeastSize = 0.5, kLargestSize = 1.5;

inline double uniform(Random& random, double least, double largest) {
    return std::uniform_real_distribution<>(least, largest)(random);
}
inline double random_size(Random& random) { return uniform(random, kLeastSize, kLargestSize); }

inline Vec4 random_normals(Random& random) {
    std::normal_distribution<> normal;
    Vec4 v;
    for (double& component : v) component = normal(random);
    return v;
}

inline void randomize(Random& random, Hypersphere& s) { s.radius = 0.5 * random_size(random); }
inline void randomize(Random& random, Hypercapsule& s) {
    s.radius = 0.5 * random_size(random);
    s.height = random_size(random);
}
inline void randomize(Random& random, Hyperbox& s) {
    for (double& side : s.size) side = random_size(random);
}
/// A 24-cell; not one of the pairs of contacts.cpp: see convex.cpp.
inline void randomize(Random& random, Polychoron& s) {
    s.regular = RegularPolychoron::k24Cell;
    s.radius = 0.5 * random_size(random);
    complete(s);
}
inline void randomize(Random& random, Hyperplane& s) {
    s.normal = random_normals(random).normalized();
}
/// Every other shape: each size anew.
template <class S>
void randomize(Random& random, S& shape) {
    S::parameters(shape, [&](const Key&, auto& value, Rule rule) {
        if constexpr (requires { value *= 1.0; })
            if (rule == Rule::kPositive) value *= 0.5 * random_size(random);
    });
    complete(shape);
}

/// How deep a resting body lies in the other [m].
constexpr double kRestingDepth = 1e-3;

/// Two bodies whose bounding boxes overlap, as a broad phase hands them on; a body and a plane:
/// up to twice as high as it reaches, so that every second one touches.
class PairsIn4D {
  public:
    struct Body {
        Shape shape;
        Vec4 position = Vec4::Zero();
        Rotor rotor;
    };
    struct Pair {
        Body a, b;
    };

    PairsIn4D(const Shape& a, const Shape& b) : a_(a), b_(b) {}

    Pair random_pair(Random& random) const {
        Pair pair{random_body(a_, random), random_body(b_, random)};
        if (const auto* plane = std::get_if<Hyperplane>(&pair.b.shape)) {
            const Vec4 n = to_matrix(pair.a.rotor).transpose() * plane->normal;
            const double reach =
                std::visit([&](const auto& s) { return half_extent_along(s, n); }, pair.a.shape);
            pair.a.position = uniform(random, 0, 2 * reach) * plane->normal;
        } else {
            const Vec4 reach = half_extents_of(pair.a) + half_extents_of(pair.b);
            for (int i = 0; i < 4; ++i) pair.b.position[i] = uniform(random, -reach[i], reach[i]);
        }
        return pair;
    }

    /// b lies on a's +y side, turned about that axis, its centre above a.
    Pair resting_pair(Random& random) const {
        Pair pair{random_body(a_, random), random_body(b_, random)};
        const auto angle = [&] { return uniform(random, -3, 3); };
        const Rotor turn = exp(Bivector{0, angle(), angle(), 0, 0, angle()});
        pair.b.rotor = pair.a.rotor * turn;
        const Vec4 half_a = half_extents_of({pair.a.shape, Vec4::Zero(), {}});
        const Vec4 half_b = half_extents_of({pair.b.shape, Vec4::Zero(), {}});
        Vec4 offset;
        for (int i = 0; i < 4; ++i) offset[i] = uniform(random, -half_a[i], half_a[i]);
        offset[1] = half_a[1] + half_b[1] - kRestingDepth;
        pair.b.position = rotate(pair.a.rotor, offset);
        return pair;
    }

    void find(const Pair& pair) {
        contacts_.clear();
        find_contacts(0, pair.a.shape, {pair.a.position, pair.a.rotor}, 1, pair.b.shape,
                      {pair.b.position, pair.b.rotor}, 0, contacts_);
    }
    /// What the last find() found.
    std::size_t points() const { return contacts_.size(); }
    bool touching() const { return !contacts_.empty(); }

  private:
    static Body random_body(const Shape& kind, Random& random) {
        Body body{kind, Vec4::Zero(), {}};
        std::visit([&](auto& s) { randomize(random, s); }, body.shape);
        if (!is_bounded(kind)) return body;
        const Vec4 u = 3 * random_normals(random), v = random_normals(random);
        const Vec4 w = 3 * random_normals(random), x = random_normals(random);
        body.rotor = exp(wedge(u, v)) * exp(wedge(w, x));
        return body;
    }
    static Vec4 half_extents_of(const Body& body) {
        const Mat4 axes = to_matrix(body.rotor);
        return std::visit([&](const auto& s) { return half_extents(s, axes); }, body.shape);
    }

    Shape a_, b_;
    std::vector<Contact> contacts_;
};

}  // namespace tesserae::bench
