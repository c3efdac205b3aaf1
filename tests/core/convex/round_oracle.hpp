// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <vector>

#include "core/convex/placed_balls.hpp"
#include "tests/core/shape/oracle.hpp"

// Products of balls, whose support functions have closed forms: what their overlaps are, by another
// road than nearest points, in long double.
namespace tesserae {

using LMat = Eigen::Matrix<long double, 4, 4>;

inline int group_count(const PlacedBalls& body) {
    return *std::max_element(body.group.begin(), body.group.end()) + 1;
}
/// Of the sphere that holds it [m].
inline double reach_of(const PlacedBalls& body) {
    return body.radius.head(group_count(body)).norm();
}
/// The greatest scalar product with a direction, about an origin.
inline long double reach_along(const PlacedBalls& body, const LVec& n, const Vec4& origin) {
    const LVec own = body.turn.transpose().cast<long double>() * n;
    long double sum = n.dot((body.centre - origin).cast<long double>());
    for (int g = 0; g < group_count(body); ++g) {
        long double square = 0;
        for (int i = 0; i < 4; ++i)
            if (body.group[static_cast<std::size_t>(i)] == g) square += own[i] * own[i];
        sum += body.radius[g] * std::sqrt(square);
    }
    return sum;
}

/// The least overlaps of two products of balls. Where the overlap is least, some groups are
/// orthogonal to the normal, which leaves it a subspace in which the overlap is smooth: there
/// Newton finds it.
class RoundOverlap {
  public:
    RoundOverlap(const PlacedBalls& a, const PlacedBalls& b)
        : between_((b.centre - a.centre).cast<long double>()), scale_(reach_of(a) + reach_of(b)) {
        for (const PlacedBalls* body : {&a, &b})
            for (int g = 0; g < group_count(*body); ++g) {
                LMat part = LMat::Zero();
                for (int i = 0; i < 4; ++i)
                    if (body->group[static_cast<std::size_t>(i)] == g)
                        part.row(i) = body->turn.col(i).transpose().cast<long double>();
                terms_.push_back({part, body->radius[g]});
            }
        find_spaces();
    }

    long double along(const LVec& n) const {
        long double sum = -between_.dot(n);
        for (const Term& term : terms_) sum += term.radius * (term.part * n).norm();
        return sum / n.norm();
    }
    /// The least of what is found from a direction's shadows in all subspaces.
    long double least_from(const LVec& start) const {
        long double least = along(start);
        for (const Space& space : spaces_) {
            LVec shadow = space.basis * (space.basis.transpose() * start);
            if (shadow.norm() > 1e-3L * start.norm())
                least = std::min(least, descend(space, shadow));
        }
        return least;
    }
    /// The same near a direction: what a local search ought not to miss.
    long double least_near(const LVec& start, long double reach) const {
        long double least = along(start);
        for (const Space& space : spaces_) {
            LVec n = space.basis * (space.basis.transpose() * start);
            if ((n - start).norm() > reach) continue;
            const long double found = descend(space, n);
            if ((n.normalized() - start).norm() <= reach) least = std::min(least, found);
        }
        return least;
    }

  private:
    struct Term {
        LMat part;  ///< of a direction, in its group
        long double radius;
    };
    struct Space {
        Eigen::Matrix<long double, 4, Eigen::Dynamic> basis;
        std::vector<bool> is_still;  ///< terms that vanish in it
    };

    void find_spaces() {
        for (unsigned still = 0; still < 1u << terms_.size(); ++still) {
            LMat sum = LMat::Zero();
            for (std::size_t t = 0; t < terms_.size(); ++t)
                if (still >> t & 1) sum += terms_[t].part.transpose() * terms_[t].part;
            const Eigen::SelfAdjointEigenSolver<LMat> solver(sum);
            int free = 0;
            while (free < 4 && solver.eigenvalues()[free] < 1e-13L) ++free;
            if (free == 0) continue;
            Space space{solver.eigenvectors().leftCols(free), {}};
            for (const Term& term : terms_)
                space.is_still.push_back((term.part * space.basis).norm() < 1e-6L);
            if (std::none_of(spaces_.begin(), spaces_.end(),
                             [&](const Space& known) { return known.is_still == space.is_still; }))
                spaces_.push_back(space);
        }
    }
    long double along_in(const Space& space, const LVec& n) const {
        long double sum = -between_.dot(n);
        for (std::size_t t = 0; t < terms_.size(); ++t)
            if (!space.is_still[t]) sum += terms_[t].radius * (terms_[t].part * n).norm();
        return sum / n.norm();
    }
    /// Newton on the sphere of the subspace, by gradient where that is no descent.
    long double descend(const Space& space, LVec& n) const {
        n.normalize();
        long double best = along_in(space, n);
        for (int round = 0; round < 60; ++round) {
            LVec slope = -between_;
            LMat bend = LMat::Zero();
            for (std::size_t t = 0; t < terms_.size(); ++t) {
                if (space.is_still[t]) continue;
                const LVec own = terms_[t].part.transpose() * (terms_[t].part * n);
                const long double length = own.norm();
                if (length < 1e-15L) return along(n);
                slope += terms_[t].radius / length * own;
                bend += terms_[t].radius / length *
                        (terms_[t].part.transpose() * terms_[t].part -
                         own * own.transpose() / (length * length));
            }
            const LMat off = LMat::Identity() - n * n.transpose();
            const LMat in = space.basis * space.basis.transpose();
            const LVec tangent = in * (off * (in * slope));
            if (tangent.norm() < 1e-19L * scale_) break;
            const LMat curved = in * off * (bend - best * LMat::Identity()) * off * in;
            const Eigen::SelfAdjointEigenSolver<LMat> solver(curved);
            LVec way = LVec::Zero();
            for (int k = 0; k < 4; ++k) {
                const LVec q = solver.eigenvectors().col(k);
                const long double size =
                    std::max(std::abs(solver.eigenvalues()[k]), 1e-9L * scale_);
                way -= q.dot(tangent) / size * q;
            }
            bool is_less = false;
            for (int half = 0; half < 40 && !is_less; ++half, way /= 2) {
                const LVec next = (n + way).normalized();
                const long double value = along_in(space, next);
                if (value < best) n = next, best = value, is_less = true;
            }
            if (!is_less) break;
        }
        return along(n);
    }

    LVec between_;
    long double scale_;
    std::vector<Term> terms_;
    std::vector<Space> spaces_;
};

/// Groups of the axes of a spherinder, a cubinder, a duocylinder, a box and a ball.
constexpr std::array<std::array<std::uint8_t, 4>, 5> kProducts = {
    {{0, 0, 0, 1}, {0, 0, 1, 2}, {0, 0, 1, 1}, {0, 1, 2, 3}, {0, 0, 0, 0}}};

/// A pair whose overlap along one direction is known, and no direction near it has less if it is
/// small against the bodies' radii.
struct RoundPair {
    PlacedBalls a, b;
    Vec4 normal;
};

/// A direction, and a point of the face that it is the normal of.
struct RoundFace {
    Vec4 normal = Vec4::Zero(), point = Vec4::Zero();
};
/// Some groups, not all, are orthogonal to the direction: there the point is anywhere.
/// @param aligned   the direction has one axis' part alone in each group
inline RoundFace random_face(RandomGeometry& random, const PlacedBalls& body, bool aligned) {
    RoundFace face;
    const int groups = group_count(body);
    const int still = static_cast<int>(random.uniform(0, (1 << groups) - 1.001));
    for (int g = 0; g < groups; ++g) {
        const double part = random.uniform(0.1, 1) * (random.uniform(0, 1) < 0.5 ? -1 : 1);
        Vec4 own = Vec4::Zero();
        for (int i = 0; i < 4; ++i)
            if (body.group[static_cast<std::size_t>(i)] == g && !(aligned && !own.isZero(0)))
                own[i] = random.direction()[0];
        own.normalize();
        if (still >> g & 1)
            face.point += body.radius[g] * random.uniform(0, 1) * own;
        else
            face.normal += part * own, face.point += body.radius[g] * sign_of(part) * own;
    }
    face.normal.normalize();
    return face;
}
/// Orthonormal, its first column a direction.
inline Mat4 frame_along(const Vec4& direction) {
    Mat4 frame;
    frame.col(0) = direction;
    int longest;
    direction.cwiseAbs().maxCoeff(&longest);
    for (int i = 0, k = 1; i < 4; ++i) {
        if (i == longest) continue;
        Vec4 rest = Vec4::Unit(i);
        for (int pass = 0; pass < 2; ++pass)
            for (int j = 0; j < k; ++j) rest -= frame.col(j).dot(rest) * frame.col(j);
        frame.col(k++) = rest.normalized();
    }
    return frame;
}
/// @param depth   of the overlap, in parts of the size
/// @param spread  of the radii, powers of ten
inline RoundPair random_round_pair(RandomGeometry& random, int kind_a, int kind_b, double depth,
                                   double spread, bool aligned) {
    RoundPair pair;
    for (PlacedBalls* body : {&pair.a, &pair.b}) {
        body->centre.setZero();
        body->group = kProducts[static_cast<std::size_t>(body == &pair.a ? kind_a : kind_b)];
        for (int g = 0; g < 4; ++g)
            body->radius[g] = aligned && spread < 1 ? 1 : std::pow(10, random.uniform(-spread, 0));
    }
    const RoundFace of_a = random_face(random, pair.a, aligned),
                    of_b = random_face(random, pair.b, aligned);
    Mat4 twist = Mat4::Identity();
    if (!aligned)
        twist.bottomRightCorner<3, 3>() = frame_along(random.direction())
                                              .bottomRightCorner<3, 3>()
                                              .householderQr()
                                              .householderQ();
    twist(0, 0) = -1;
    pair.a.turn =
        aligned
            ? Mat4(Mat4::Identity())
            : Mat4(frame_along(random.direction()) * frame_along(random.direction()).transpose());
    pair.b.turn =
        pair.a.turn * frame_along(of_a.normal) * twist * frame_along(of_b.normal).transpose();
    pair.normal = pair.a.turn * of_a.normal;
    pair.b.centre = pair.a.turn * of_a.point - pair.b.turn * of_b.point -
                    depth * (reach_of(pair.a) + reach_of(pair.b)) * pair.normal;
    return pair;
}

}  // namespace tesserae
