// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

#include "core/contact/box_distance.hpp"
#include "core/contact/find_contacts.hpp"
#include "core/contact/hyperbox_hyperbox.hpp"

// Boxes to test with and what is true of them, in long double and by brute force. Nothing here
// knows separating axes, active sets or clipping by name.
namespace tesserae::box_oracle {

using Real = long double;
using Wide = Eigen::Matrix<Real, 4, 1>;

struct Random {
    std::mt19937_64 engine;
    explicit Random(std::uint64_t seed) : engine(seed) {}

    double uniform(double a, double b) { return std::uniform_real_distribution<>(a, b)(engine); }
    double exponent(double a, double b) { return std::pow(10, uniform(a, b)); }
    int below(int n) { return std::uniform_int_distribution<>(0, n - 1)(engine); }
    double normal() { return std::normal_distribution<>()(engine); }
    Vec4 direction() { return Vec4(normal(), normal(), normal(), normal()).normalized(); }
    Bivector bivector(double size) {
        return {size * normal(), size * normal(), size * normal(),
                size * normal(), size * normal(), size * normal()};
    }
    Rotor rotor() { return exp(bivector(2)); }
    Vec4 sizes(double a, double b) {
        return {exponent(a, b), exponent(a, b), exponent(a, b), exponent(a, b)};
    }
};

struct PlacedBox {
    Hyperbox box;
    Vec4 position = Vec4::Zero();
    Rotor rotor;

    Pose pose() const { return {position, rotor}; }
    double reach() const { return 0.5 * box.size.norm(); }
};

struct Two {
    PlacedBox a, b;
    double reach() const { return a.reach() + b.reach(); }
};

/// The four half sides as vectors of the world.
inline std::array<Wide, 4> generators(const PlacedBox& p) {
    const Mat4 axes = to_matrix(p.rotor);
    std::array<Wide, 4> g;
    for (int i = 0; i < 4; ++i) g[i] = axes.col(i).cast<Real>() * (Real(0.5) * p.box.size[i]);
    return g;
}
inline Wide offset(const Two& two) {
    return two.b.position.cast<Real>() - two.a.position.cast<Real>();
}

/// How far the boxes lie apart along a unit direction from a to b: difference of supports.
inline Real gap_along(const Two& two, const Wide& direction) {
    Real gap = direction.dot(offset(two));
    for (const PlacedBox* p : {&two.a, &two.b})
        for (const Wide& g : generators(*p)) gap -= std::abs(direction.dot(g));
    return gap;
}

/// What is left of a unit vector orthogonal to others, made unit; zero if it is rounding. Removed
/// twice: the answer is then exact for a vector 1e-19 beside this one, however small the rest.
inline Wide rest_of(Wide v, std::initializer_list<Wide> others) {
    for (int pass = 0; pass < 2; ++pass) {
        for (const Wide& o : others) v -= o.dot(v) * o;
        const Real length = v.norm();
        if (length < 1e-18L) return Wide::Zero();
        v /= length;
    }
    return v;
}

/// The generalised cross product: orthogonal to three vectors.
inline Wide cross(const Wide& a, const Wide& b, const Wide& c) {
    Wide n;
    for (int i = 0; i < 4; ++i) {
        const int j = (i + 1) % 4, k = (i + 2) % 4, l = (i + 3) % 4;
        const Real minor = a[j] * (b[k] * c[l] - b[l] * c[k]) - a[k] * (b[j] * c[l] - b[l] * c[j]) +
                           a[l] * (b[j] * c[k] - b[k] * c[j]);
        n[i] = i % 2 == 0 ? minor : -minor;
    }
    return n;
}

/// A facet of the Minkowski difference and the one across: their unit normal, and how far from the
/// centre they are.
struct Facets {
    Wide normal;
    Real width;
};
/// Of every three of the eight generators, wherever the boxes are.
inline std::vector<Facets> facets_of(const Two& two) {
    std::vector<Wide> all, unit;
    for (const PlacedBox* p : {&two.a, &two.b})
        for (const Wide& g : generators(*p)) all.push_back(g), unit.push_back(g.normalized());
    std::vector<Facets> facets;
    for (int i = 0; i < 8; ++i)
        for (int j = i + 1; j < 8; ++j)
            for (int k = j + 1; k < 8; ++k) {
                const Wide second = rest_of(unit[j], {unit[i]});
                const Wide third = rest_of(unit[k], {unit[i], second});
                if (second.isZero() || third.isZero()) continue;
                Facets& both = facets.emplace_back(Facets{cross(unit[i], second, third), 0});
                for (const Wide& g : all) both.width += std::abs(both.normal.dot(g));
            }
    return facets;
}
inline Real largest_gap(const std::vector<Facets>& facets, const Wide& offset) {
    Real best = -INFINITY;
    for (const auto& [normal, width] : facets)
        best = std::max(best, std::abs(normal.dot(offset)) - width);
    return best;
}
/// The largest gap over all facet normals of the Minkowski difference. Minus the least overlap
/// where the boxes overlap.
inline Real largest_facet_gap(const Two& two) { return largest_gap(facets_of(two), offset(two)); }

/// The distance by brute force: on every pair of faces with k + l <= 3 the least-squares point of
/// their affine spans, kept if it lies in both. (The least of any feasible points that include the
/// closest ones.) For boxes in general position.
inline Real distance_over_faces(const Two& two) {
    std::array<Wide, 8> g;
    for (int i = 0; i < 4; ++i) {
        g[i] = -generators(two.a)[i];
        g[4 + i] = generators(two.b)[i];
    }
    Real best = INFINITY;
    for (int free = 0; free < 256; ++free) {
        const int dimension = __builtin_popcount(free);
        if (dimension > 3) continue;
        Eigen::Matrix<Real, 4, Eigen::Dynamic, 0, 4, 3> span(4, dimension);
        for (int v = 0, column = 0; v < 8; ++v)
            if ((free >> v & 1) != 0) span.col(column++) = g[v];
        Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> inverse;
        if (dimension > 0) inverse = (span.transpose() * span).inverse();
        for (int sides = 0; sides < 256; ++sides) {
            if ((sides & free) != 0) continue;
            Wide r = offset(two);
            for (int v = 0; v < 8; ++v)
                if ((free >> v & 1) == 0) r += (sides >> v & 1) != 0 ? g[v] : Wide(-g[v]);
            if (dimension > 0) {
                const auto t = (inverse * (span.transpose() * Wide(-r))).eval();
                if (t.cwiseAbs().maxCoeff() > 1) continue;
                r += span * t;
            }
            best = std::min(best, r.norm());
        }
    }
    return best;
}

/// Two boxes of sides 0.2 to 2 at any angle, their centres up to `spread` bounding radii apart.
inline Two random_two(Random& random, double spread) {
    Two two;
    for (PlacedBox* p : {&two.a, &two.b})
        p->box.size = random.sizes(-0.7, 0.3), p->rotor = random.rotor();
    two.a.position = random.uniform(0, 3) * random.direction();
    two.b.position = two.a.position + random.uniform(0, spread) * two.reach() * random.direction();
    return two;
}

/// Slides b along its present direction until the largest gap along a facet is `gap`.
inline void slide_to(Two& two, double gap) {
    Wide direction = offset(two);
    if (direction.norm() == 0) direction = Wide::Unit(0);
    direction.normalize();
    const std::vector<Facets> facets = facets_of(two);
    Real low = 0, high = 3 * two.reach();
    for (int i = 0; i < 60; ++i) {
        const Real middle = 0.5L * (low + high);
        two.b.position = two.a.position + (middle * direction).cast<double>();
        (largest_gap(facets, offset(two)) < gap ? low : high) = middle;
    }
}

/// Pairs in which something is parallel, equal, coincident, thin, tiny, far or just touching.
inline Two degenerate_two(Random& random, std::string& kind) {
    Two two = random_two(random, 1);
    PlacedBox &a = two.a, &b = two.b;
    const int sizes = random.below(4);
    kind = std::to_string(sizes);
    if (sizes == 1) b.box = a.box;
    if (sizes == 2) a.box.size = random.sizes(-4, 0), b.box.size = random.sizes(-4, 0);
    if (sizes == 3) a.box.size *= 1e-3, b.box.size *= 1e3;
    const int angle = random.below(5);
    kind += std::to_string(angle);
    a.rotor = random.below(2) == 0 ? Rotor{} : random.rotor();
    const double turn = random.exponent(-16, -5);
    if (angle == 1) b.rotor = a.rotor;
    if (angle == 2) b.rotor = projected_to_spin4(a.rotor * exp(random.bivector(turn)));
    if (angle == 3) b.rotor = a.rotor * exp({1.2 * random.normal(), 0, 0, 0, 0, 0});
    if (angle == 4)
        b.rotor = a.rotor * exp({random.normal(), random.normal(), turn, random.normal(), 0, 0});
    const int place = random.below(6);
    kind += std::to_string(place);
    Vec4 apart = random.uniform(0, 1) * two.reach() * random.direction();
    if (place == 1) apart.setZero();
    if (place == 2 || place == 3) {  // stacked along an axis of a, exactly or beside
        const int i = random.below(4);
        apart.setZero();
        apart[i] = 0.5 * (a.box.size[i] + b.box.size[i]) + (random.below(3) - 1) * 1e-10;
        if (place == 3)
            apart[(i + 1) % 4] = 0.5 * (a.box.size[(i + 1) % 4] + b.box.size[(i + 1) % 4]);
        apart = to_matrix(a.rotor) * apart;
    }
    if (random.below(4) == 0) a.position = 1e4 * random.direction();
    if (random.below(4) == 0) a.position.setZero();
    b.position = a.position + apart;
    const double tiny[] = {0, 1e-15, -1e-15, 1e-12, -1e-9, 1e-9, 1e-7, 1e-5, 1e-3};
    if (place > 3) slide_to(two, tiny[random.below(9)] * two.reach());
    return two;
}

inline BoxPair pair_of(const Two& two) {
    return box_pair(two.a.box, two.a.position, to_matrix(two.a.rotor), two.b.box, two.b.position,
                    to_matrix(two.b.rotor));
}

/// What the code under test says about the pair, in metres and in the world.
struct Answer {
    double value;
    Vec4 normal;
    BoxSeparation detail;
    SeparatingAxes axes;
};
inline Answer answer_for(const Two& two) {
    const BoxPair pair = pair_of(two);
    Answer answer;
    find_separating_axes(pair, INFINITY, answer.axes);
    answer.detail = separation_of(pair, answer.axes);
    answer.value = pair.unit * answer.detail.value;
    answer.normal = to_matrix(two.a.rotor) * (answer.detail.is_axis ? best_normal(pair, answer.axes)
                                                                    : answer.detail.witness.normal);
    return answer;
}

inline std::vector<Contact> contacts_of(const Two& two, double margin) {
    std::vector<Contact> list;
    PairContacts out{0, 1, false, list};
    contacts_between(two.a.box, two.a.pose(), two.b.box, two.b.pose(), margin, out);
    return list;
}

}  // namespace tesserae::box_oracle
