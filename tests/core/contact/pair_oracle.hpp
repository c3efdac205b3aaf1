// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/contact/find_contacts.hpp"
#include "tests/core/shape/oracle.hpp"

// Separations by another road than the pair functions: bounded shapes as zonotopes widened by a
// radius (core/FORMULAS.md 3), in long double, every face of every dimension tried.
namespace tesserae {

/// centre + sum t_k g_k with |t_k| <= 1, widened by rho.
struct Zonotope {
    LVec centre;
    std::vector<LVec> generators;
    long double rho;

    template <class S>
    Zonotope(const S& shape, const Vec4& position, const Rotor& rotor)
        : centre(position.cast<long double>()) {
        const Eigen::Matrix<long double, 4, 4> R = to_matrix(rotor).cast<long double>();
        const Oracle body(shape);
        rho = body.rho;
        for (const LVec& g : body.generators) generators.push_back(R * g);
    }
    /// max of d . (x - centre)
    long double extent(const LVec& d) const {
        long double sum = rho * d.norm();
        for (const LVec& g : generators) sum += std::abs(g.dot(d));
        return sum;
    }
    long double size() const {
        long double sum = rho;
        for (const LVec& g : generators) sum += g.norm();
        return sum;
    }
};

/// The least |r + sum t_k g_k| with |t_k| <= 1. The optimum lies inside a face: some t_k are -1 or
/// +1, the others solve a least-squares problem (Gram-Schmidt). All faces are tried, parallel ones
/// after each other; whatever t rounding makes of a badly conditioned one is clamped and so still a
/// point of the set.
class LeastNorm {
  public:
    LeastNorm(const LVec& r, const std::vector<LVec>& generators) : generators_(generators) {
        choose(0, r);
    }
    long double norm() const { return best_.norm(); }

  private:
    /// Which of the generators from k on are free.
    void choose(std::size_t k, const LVec& r) {
        if (k == generators_.size()) return search(0, r);
        fixed_.push_back(k);
        choose(k + 1, r);
        fixed_.pop_back();
        if (!add_free(k)) return;
        choose(k + 1, r);
        --free_count_;
    }
    /// @return whether it is independent of those that are free
    bool add_free(std::size_t k) {
        if (free_count_ == 4) return false;
        const std::size_t n = free_count_;
        const LVec& g = generators_[k];
        q_[n] = g;
        for (std::size_t i = 0; i < n; ++i) {
            upper_[i][n] = q_[i].dot(q_[n]);
            q_[n] -= upper_[i][n] * q_[i];
        }
        upper_[n][n] = q_[n].norm();
        if (upper_[n][n] <= 1e-18L * g.norm()) return false;
        q_[n] /= upper_[n][n];
        free_[free_count_++] = k;
        return true;
    }
    /// The ends of the fixed ones from the i-th on.
    void search(std::size_t i, const LVec& r) {
        if (i == fixed_.size()) return solve(r);
        search(i + 1, r - generators_[fixed_[i]]);
        search(i + 1, r + generators_[fixed_[i]]);
    }
    void solve(const LVec& r) {
        long double t[4];
        LVec rest = r;
        const std::size_t n = free_count_;
        for (std::size_t k = 0; k < n; ++k) {
            t[k] = -q_[k].dot(rest);
            rest += t[k] * q_[k];
        }
        // No point of the face's space is nearer.
        if (!first_ && rest.squaredNorm() > best_.squaredNorm()) return;
        LVec point = r;
        for (std::size_t k = n; k-- > 0;) {
            for (std::size_t j = k + 1; j < n; ++j) t[k] -= upper_[k][j] * t[j];
            t[k] /= upper_[k][k];
        }
        for (std::size_t k = 0; k < n; ++k)
            point += std::clamp(t[k], -1.0L, 1.0L) * generators_[free_[k]];
        if (first_ || point.squaredNorm() < best_.squaredNorm()) best_ = point;
        first_ = false;
    }

    const std::vector<LVec>& generators_;
    std::vector<std::size_t> fixed_;
    std::size_t free_[4], free_count_ = 0;
    LVec q_[4];
    long double upper_[4][4];
    LVec best_;
    bool first_ = true;
};

/// Unit, by cofactors of what Gram-Schmidt makes of the three (twice: they may be nearly parallel).
/// Zero if they span no hyperplane.
inline LVec orthogonal_to(LVec a, LVec b, LVec c) {
    a.normalize();
    b.normalize();
    c.normalize();
    for (int pass = 0; pass < 2; ++pass) {
        b -= a.dot(b) * a;
        if (b.norm() < 1e-15L) return LVec::Zero();
        b.normalize();
        c -= a.dot(c) * a;
        c -= b.dot(c) * b;
        if (c.norm() < 1e-15L) return LVec::Zero();
        c.normalize();
    }
    LVec n;
    for (int i = 0; i < 4; ++i) {
        Eigen::Matrix<long double, 3, 3> minor;
        for (int j = 0, row = 0; j < 4; ++j)
            if (j != i) minor.row(row++) << a[j], b[j], c[j];
        n[i] = (i % 2 ? -1 : 1) * minor.determinant();
    }
    return n;
}

/// Apart: the distance. Cores that meet: the least overlap over all facets of their Minkowski
/// difference, and its width 0 if it has no inside. Less the two radii.
inline long double true_separation(const Zonotope& a, const Zonotope& b) {
    std::vector<LVec> g = a.generators;
    g.insert(g.end(), b.generators.begin(), b.generators.end());
    std::erase_if(g, [](const LVec& v) { return v.isZero(0); });
    const LVec r = b.centre - a.centre;
    const long double radii = a.rho + b.rho, distance = LeastNorm(r, g).norm();
    // Badly conditioned faces leave a small distance where the cores meet: the facets decide.
    if (g.size() < 4 || distance > 1e-9L * (r.norm() + a.size() + b.size()))
        return distance - radii;
    long double overlap = std::numeric_limits<long double>::infinity();
    for (std::size_t i = 0; i < g.size(); ++i)
        for (std::size_t j = i + 1; j < g.size(); ++j)
            for (std::size_t k = j + 1; k < g.size(); ++k) {
                const LVec n = orthogonal_to(g[i], g[j], g[k]);
                if (n.isZero(0)) continue;
                long double width = 0;
                for (const LVec& v : g) width += std::abs(v.dot(n));
                overlap = std::min(overlap, (width - std::abs(n.dot(r))) / n.norm());
            }
    return (overlap >= 0 ? -overlap : distance) - radii;
}

/// Of one zonotope from a point; exact inside too for a box (core/FORMULAS.md 3).
inline long double true_distance(const Zonotope& body, const LVec& point) {
    const long double outside = LeastNorm(point - body.centre, body.generators).norm() - body.rho;
    if (body.generators.size() < 4 || outside > 0) return outside;
    long double deepest = -std::numeric_limits<long double>::infinity();
    for (const LVec& g : body.generators)
        deepest = std::max(deepest, std::abs(g.normalized().dot(point - body.centre)) - g.norm());
    return deepest;
}

/// A body of a pair under test.
template <class S>
struct Placed {
    S shape;
    Vec4 position = Vec4::Zero();
    Rotor rotor = {};

    Zonotope zonotope() const { return {shape, position, rotor}; }
};

constexpr double kAlways = 1e200;  // a margin within which everything is

template <class A, class B>
std::vector<Contact> contacts_of(const Placed<A>& a, const Placed<B>& b, double margin = kAlways) {
    std::vector<Contact> list;
    find_contacts(3, Shape(a.shape), {a.position, a.rotor}, 8, Shape(b.shape),
                  {b.position, b.rotor}, margin, list);
    return list;
}

inline const Contact& deepest(const std::vector<Contact>& list) {
    return *std::min_element(list.begin(), list.end(), [](const Contact& p, const Contact& q) {
        return p.separation < q.separation;
    });
}

/// The worst errors of a set of pairs, relative to the pair's size: the distance of the centres
/// plus both bounding radii.
struct PairErrors {
    double separation = 0;  ///< of the deepest point against the truth
    double touch = 0;       ///< what is left when B is moved by the separation along the normal
    double surface = 0;     ///< of the deepest point's ends from the two surfaces
    double outside = 0;     ///< of the other points' ends from the two bodies

    void print(const char* set) const {
        printf("[ errors   ] %s: separation %.2g, touch %.2g, surface %.2g, outside %.2g\n", set,
               separation, touch, surface, outside);
    }
};

/// @param list   what was found for the pair
template <class A, class B>
void measure(const Placed<A>& a, const Placed<B>& b, const std::vector<Contact>& list,
             PairErrors& errors) {
    // Seen from A: at 1e4 m even a long double has no digits to spare.
    Zonotope za = a.zonotope(), zb = b.zonotope();
    const LVec origin = za.centre;
    zb.centre -= origin;
    za.centre.setZero();
    const long double size = zb.centre.norm() + za.size() + zb.size();
    ASSERT_FALSE(list.empty());
    for (std::size_t i = 0; i < list.size(); ++i) {
        ASSERT_NEAR(list[i].normal.norm(), 1, 1e-15);
        ASSERT_TRUE(list[i].point.allFinite());
        ASSERT_TRUE(i == 0 || list[i - 1].feature < list[i].feature);
    }
    const auto note = [](double& worst, long double error) {
        worst = std::max(worst, static_cast<double>(error));
    };

    const Contact& deep = deepest(list);
    const LVec n = deep.normal.cast<long double>();
    note(errors.separation, std::abs(deep.separation - true_separation(za, zb)) / size);
    Zonotope moved = zb;
    moved.centre -= static_cast<long double>(deep.separation) * n;
    note(errors.touch, std::abs(true_separation(za, moved)) / size);

    // World coordinates are rounded where the bodies are.
    const long double place = size + origin.norm();
    for (const Contact& c : list) {
        const LVec point = c.point.cast<long double>() - origin, half = 0.5L * c.separation * n;
        const long double to_a = true_distance(za, point - half);
        const long double to_b = true_distance(zb, point + half);
        if (&c == &deep)
            note(errors.surface, std::max(std::abs(to_a), std::abs(to_b)) / place);
        else
            note(errors.outside, std::max(to_a, to_b) / place);
    }
}

template <class A, class B>
void measure(const Placed<A>& a, const Placed<B>& b, PairErrors& errors) {
    measure(a, b, contacts_of(a, b), errors);
}

}  // namespace tesserae
