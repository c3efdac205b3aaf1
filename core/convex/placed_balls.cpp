// SPDX-License-Identifier: Apache-2.0
#include "core/convex/placed_balls.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tesserae {
namespace {

/// A product of balls in its own frame: what belongs to a group stands at each of its axes.
class GroupedBody {
  public:
    GroupedBody(const PlacedBalls& body, double scale) {
        for (int i = 0; i < 4; ++i) {
            const auto own = body.group[static_cast<std::size_t>(i)];
            radius_[i] = scale * body.radius[own];
            for (int j = 0; j < 4; ++j)
                is_one_(i, j) = body.group[static_cast<std::size_t>(j)] == own ? 1 : 0;
        }
    }
    const Vec4& radius() const { return radius_; }
    /// 1 where two axes are of one group.
    const Mat4& is_one() const { return is_one_; }
    /// The lengths of a vector's parts in the groups.
    Vec4 lengths(const Vec4& v) const { return (is_one_ * v.cwiseAbs2()).cwiseSqrt(); }
    Vec4 support(const Vec4& direction) const {
        const Vec4 length = lengths(direction);
        Vec4 point;
        for (int i = 0; i < 4; ++i)
            point[i] = length[i] > 0 ? direction[i] * (radius_[i] / length[i]) : rim(i);
        return point;
    }
    double height(const Vec4& direction) const { return direction.dot(support(direction)); }
    /// What of a direction lies in an axis' group; zero for all but the group's first axis.
    Vec4 group_part(const Vec4& direction, int axis) const {
        if (!is_first(axis)) return Vec4::Zero();
        return is_one_.col(axis).cwiseProduct(direction);
    }

  private:
    bool is_first(int axis) const { return is_one_.col(axis).head(axis).isZero(0); }
    double rim(int axis) const { return is_first(axis) ? radius_[axis] : 0; }

    Vec4 radius_;
    Mat4 is_one_;
};

/// One body's share in a step of Newton's method.
struct NewtonShare {
    Vec4 point;  ///< of the body, about its centre
    Vec4 there;  ///< where the smoothed support function has its point for the present normal
    Mat4 bend;   ///< what it changes by as the normal does

    /// Of point * sqrt(|u|^2 + mu^2) = r u, with the point and u as unknowns.
    void linearise(const GroupedBody& body, const Vec4& u, double mu) {
        const Vec4 inverse =
            (body.is_one() * u.cwiseAbs2() + Vec4::Constant(mu * mu)).cwiseSqrt().cwiseInverse();
        const Vec4 bend_of_radius = body.radius().cwiseProduct(inverse);
        const Vec4 of_point = point.cwiseProduct(inverse), of_u = u.cwiseProduct(inverse);
        there = bend_of_radius.cwiseProduct(u);
        bend = -body.is_one().cwiseProduct(of_point * of_u.transpose());
        bend.diagonal() += bend_of_radius;
    }
    /// The point is kept in the body.
    void move(const GroupedBody& body, const Vec4& change) {
        point = there + bend * change;
        const Vec4 length = body.lengths(point);
        for (int i = 0; i < 4; ++i)
            if (length[i] > body.radius()[i]) point[i] *= body.radius()[i] / length[i];
    }
};

/// Five equations in five unknowns, the right side last, by elimination; false if singular.
bool solve_five(double (&m)[5][6], double (&x)[5]) {
    for (int k = 0; k < 5; ++k) {
        int pivot = k;
        for (int i = k + 1; i < 5; ++i)
            if (std::abs(m[i][k]) > std::abs(m[pivot][k])) pivot = i;
        if (!(std::abs(m[pivot][k]) > 0)) return false;
        for (int j = k; j < 6 && pivot != k; ++j) std::swap(m[k][j], m[pivot][j]);
        const double inverse = 1 / m[k][k];
        for (int i = k + 1; i < 5; ++i) {
            const double factor = m[i][k] * inverse;
            for (int j = k + 1; j < 6; ++j) m[i][j] -= factor * m[k][j];
        }
    }
    for (int k = 5; k-- > 0;) {
        double sum = m[k][5];
        for (int j = k + 1; j < 5; ++j) sum -= m[k][j] * x[j];
        x[k] = sum / m[k][k];
    }
    return std::isfinite(x[0] + x[1] + x[2] + x[3]);
}

/// Looks for the normal along which the gap is greatest, in a's frame and in units in which the
/// bodies and their distance are at most about 1.
class GreatestGap {
  public:
    GreatestGap(const PlacedBalls& a, const PlacedBalls& b, double scale)
        : a_(a, scale),
          b_(b, scale),
          turn_(a.turn.transpose() * b.turn),
          between_(a.turn.transpose() * (scale * (b.centre - a.centre))) {}

    double gap(const Vec4& n) const {
        return between_.dot(n) - a_.height(n) - b_.height(turn_.transpose() * n);
    }
    Vec4 between_centres() const {
        return between_.isZero(0) ? Vec4(Vec4::UnitX()) : stable_normalized(between_);
    }
    /// The best of what costs little: between the centres, and radially out of every group.
    Vec4 first_guess() const {
        Vec4 best = between_centres();
        double most = gap(best);
        const auto consider = [&](const Vec4& direction) {
            if (direction.isZero(0)) return;
            const Vec4 n = stable_normalized(direction);
            if (const double found = gap(n); found > most) most = found, best = n;
        };
        const Vec4 seen_by_b = turn_.transpose() * between_;
        for (int axis = 0; axis < 4; ++axis) {
            consider(a_.group_part(between_, axis));
            consider(turn_ * b_.group_part(seen_by_b, axis));
        }
        return best;
    }

    /// False: it did not come to an end.
    bool run(const Vec4& start) {
        // The last one is about the distance's error.
        constexpr double kFirstMu = 0.1, kLeastMu = 1e-13, kFall = 0.003;
        constexpr int kMostSteps = 40;
        // The last step's change of the normal, whose square is the distance's error, and how far
        // the points are from having the distance between them.
        constexpr double kTurned = 1e-9, kOff = 1e-12;
        // Where two bodies' groups are orthogonal to the normal but for as little, the distance's
        // error is the change itself: some steps more, while there is one.
        constexpr double kConverged = 1e-13;
        constexpr int kMoreSteps = 4;
        normal_ = start;
        of_a_.point.setZero();
        of_b_.point.setZero();
        double mu = kFirstMu;
        distance_ = gap(start);
        last_ = 1;
        for (int step = 0; step < kMostSteps; ++step) {
            const double turned = take_step(mu);
            if (!(turned >= 0)) return false;
            last_ = std::max(turned, off_);
            if (mu <= kLeastMu && turned < kTurned && off_ < kOff) {
                for (int more = 0; more < kMoreSteps && last_ > kConverged; ++more) {
                    const double again = take_step(mu);
                    if (!(again >= 0)) return false;
                    last_ = std::max(again, off_);
                }
                return true;
            }
            // After a long step groups may be others.
            if (turned > 0.1 && step > 2) mu = std::max(mu, 0.01 * turned);
            if (turned < kLongestNewtonStep) mu = std::max(kLeastMu, kFall * mu);
        }
        return false;
    }
    const Vec4& normal() const { return normal_; }
    Vec4 point_of_a() const { return of_a_.point; }
    Vec4 point_of_b() const { return of_b_.point; }

  private:
    static constexpr double kLongestNewtonStep = 0.5;

    /// The equations: point_a + point_b + distance normal = between, |normal| = 1. Returns by how
    /// much the normal turned; negative: they are singular.
    double take_step(double mu) {
        of_a_.linearise(a_, normal_, mu);
        of_b_.linearise(b_, turn_.transpose() * normal_, mu);
        const Vec4 rest = between_ - of_a_.there - turn_ * of_b_.there - distance_ * normal_;
        const Mat4 bend = of_a_.bend + turn_ * of_b_.bend * turn_.transpose();
        Vec4 change = Vec4::Zero();
        bool is_solved = solve(bend, last_ < kNear ? distance_ : damped_distance(), rest, change);
        // So far from so near: toward the greatest overlap along an edge.
        if (last_ < kNear && distance_ < 0 && !(change.norm() < 10 * kNear))
            is_solved = solve(bend, -distance_, rest, change);
        if (!is_solved) return -1;
        const double turned = change.norm();
        if (turned > kLongestNewtonStep) change *= kLongestNewtonStep / turned;
        of_a_.move(a_, change);
        of_b_.move(b_, turn_.transpose() * change);
        normal_ = (normal_ + change).normalized();
        const Vec4 left = between_ - of_a_.point - turn_ * of_b_.point;
        distance_ = normal_.dot(left);
        off_ = (left - distance_ * normal_).norm();
        return turned;
    }
    /// Below this a step is one of the last, and is not damped.
    static constexpr double kNear = 5e-3;

    /// The bend of the unit sphere. In overlap it is negative: until the end is near it counts as
    /// positive, or steps along edges go astray. That is the step toward the point of the
    /// difference that is nearest to one above its surface.
    double damped_distance() const {
        constexpr double kPart = 0.1, kMost = 0.05;
        return std::max(std::min(kMost, kPart * last_), std::abs(distance_));
    }
    /// (bend + added) change + x normal = rest, with the change orthogonal to the normal.
    bool solve(const Mat4& bend, double added, const Vec4& rest, Vec4& change) const {
        double m[5][6], x[5];
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j < 4; ++j) m[i][j] = bend(i, j);
            m[i][i] += added;
            m[i][4] = m[4][i] = normal_[i];
            m[i][5] = rest[i];
        }
        m[4][4] = m[4][5] = 0;
        if (!solve_five(m, x)) return false;
        change = Vec4(x[0], x[1], x[2], x[3]);
        return true;
    }

    GroupedBody a_, b_;
    Mat4 turn_;
    Vec4 between_;
    NewtonShare of_a_, of_b_;
    Vec4 normal_;
    double distance_, last_, off_ = 0;
};

double bounding_radius_of(const PlacedBalls& body) {
    Vec4 counted = Vec4::Zero();
    for (const std::uint8_t group : body.group) counted[group] = body.radius[group];
    return stable_norm(counted);
}

}  // namespace

Vec4 support(const PlacedBalls& body, const Vec4& direction) {
    const Vec4 own = body.turn.transpose() * stable_normalized(direction);
    return body.centre + body.turn * GroupedBody(body, 1).support(own);
}

ConvexSeparation separation_of(const PlacedBalls& a, const PlacedBalls& b) {
    const Vec4 between = b.centre - a.centre;
    const double size = bounding_radius_of(a) + bounding_radius_of(b);
    const double largest = std::max(size, between.cwiseAbs().maxCoeff());
    // A power of two rounds nothing; its inverse is finite.
    const double unit = std::ldexp(1.0, std::clamp(std::ilogb(largest), -1000, 1000));
    GreatestGap search(a, b, 1 / unit);
    const Vec4 guess = search.first_guess();

    // The points have the distance between them but for rounding, of which each has its part.
    const auto found = [&](const Vec4& n) -> ConvexSeparation {
        const double distance = unit * search.gap(n);
        const Vec4 normal = a.turn * n;
        const Vec4 on_a = a.centre + a.turn * (unit * search.point_of_a()),
                   on_b = b.centre - b.turn * (unit * search.point_of_b());
        const Vec4 middle = (on_a + on_b) / 2, half = normal * (distance / 2);
        return {normal, distance, middle - half, middle + half};
    };
    ConvexSeparation best;
    const double at_guess = search.gap(guess);
    bool is_found = search.run(guess) || search.run(search.between_centres());
    if (is_found) {
        const double gap = search.gap(search.normal());
        is_found = gap >= at_guess - kPlacedBallsAccuracy;
        // A face's own normal, where that is it.
        best = found(gap > at_guess ? search.normal() : guess);
        if (is_found && best.distance >= -kShallowOverlap * size) return best;
    }

    // The general method finds where to start, or what is less in a deep overlap.
    const auto support_a = [&](const Vec4& n) { return Vec4(support(a, n) - a.centre); };
    const auto support_b = [&](const Vec4& n) { return Vec4(support(b, n) - a.centre); };
    std::optional<ConvexSeparation> deep;
    const auto takes = [&](const Vec4& direction) {
        const Vec4 start = a.turn.transpose() * direction;
        if (!search.run(start) || search.gap(search.normal()) < search.gap(start)) return false;
        deep = found(search.normal());
        return true;
    };
    auto general = separation_unless(support_a, support_b, a.turn * guess, size, takes);
    if (!general) {
        // Of equal ones the one that was found first.
        const bool as_good = best.distance >= deep->distance - kPlacedBallsAccuracy * size;
        return is_found && as_good ? best : *deep;
    }
    general->on_a += a.centre;
    general->on_b += a.centre;
    // Of equal ones that whose points are on the surfaces.
    const double enough = general->distance - kPlacedBallsAccuracy * size;
    if (is_found && best.distance >= enough) return best;
    const Vec4 start = a.turn.transpose() * general->normal;
    if (search.run(start) && unit * search.gap(search.normal()) >= enough)
        return found(search.normal());
    return *general;
}

}  // namespace tesserae
