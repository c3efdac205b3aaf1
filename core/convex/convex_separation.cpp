// SPDX-License-Identifier: Apache-2.0
#include "core/convex/convex_separation.hpp"

#include <Eigen/LU>
#include <limits>

#include "core/convex/expanding_polytope.hpp"
#include "core/convex/simplex.hpp"

namespace tesserae {
namespace {

/// Multiples of rounding: bounds of a distance that agree to this are equal.
constexpr double kEqual = 3;
/// Multiples of rounding: what is nearer than this touches, and its direction is looked for as if
/// it overlapped.
constexpr double kMeets = 4;
/// Distances below this [units] are looked at as overlaps too if their bounds do not agree.
constexpr double kNearlyTouching = 1e-6;
/// Polytopes take 5 to 15 rounds, spheres 10 to 30; a support that contradicts itself might take
/// all.
constexpr int kMaxRounds = 200;
/// After so many rounds without any gain it is over. Round bodies pause: a step may only exchange
/// points.
constexpr int kMaxIdle = 6;
/// How far outside of the difference the point is whose nearest point polishes an overlap [units].
/// The normal's rounding is inverse to it; each round of polishing removes a part of the error
/// that is the smaller the smaller it is.
constexpr double kOutside = 1.0 / 64;
/// Rounds of polishing. Polytopes take one, in which nothing changes; spheres two or three.
constexpr int kMaxPolishing = 40;

/// A direction, and how far the bodies are apart along it: a lower bound of their distance.
struct KnownGap {
    Vec4 normal = Vec4::Zero();
    double gap = -std::numeric_limits<double>::infinity();  ///< along the normal [units]
};

/// The simplex goes to the point of the difference nearest to its target. Returns the direction
/// from there to the target with the greatest gap between the two; none if they coincide.
/// @param enough   a gap above this ends it [units]
KnownGap approach_target(const MinkowskiDifference& difference, Simplex& simplex,
                         double enough = std::numeric_limits<double>::infinity()) {
    const double rounding = difference.rounding();
    KnownGap best;
    double least = std::numeric_limits<double>::infinity();
    int idle = 0;
    for (int round = 0; round < kMaxRounds && idle < kMaxIdle; ++round, ++idle) {
        if (simplex.contains_target()) break;
        const double distance = simplex.nearest().norm();
        if (distance <= kMeets * rounding) break;
        const Vec4 normal = simplex.nearest() / -distance;
        const DifferencePoint p = difference.support(normal);
        const double gap = -normal.dot(p.at - simplex.target());
        if (gap > best.gap || distance < least - rounding) idle = 0;
        if (gap > best.gap) best = {normal, gap};
        least = std::min(least, distance);
        if (distance - gap <= kEqual * rounding || gap > enough) break;
        if (!simplex.add(p, best.gap - kMeets * rounding) && !simplex.refine()) break;
        if (idle == kMaxIdle / 2) simplex.refine();
    }
    return best;
}

/// Five points that span a simplex, or fewer and a direction in which the difference is flat.
struct FullSimplex {
    std::array<DifferencePoint, 5> point;
    int count = 0;
    Vec4 flat;
};

/// A unit vector orthogonal to n < 4 orthonormal ones.
Vec4 orthogonal_to_all(const Vec4* q, int n) {
    Vec4 best = Vec4::Zero();
    for (int axis = 0; axis < 4; ++axis) {
        const Vec4 rest = orthogonal_part(Vec4::Unit(axis), q, n);
        if (rest.squaredNorm() > best.squaredNorm()) best = rest;
    }
    return orthogonal_part(best.normalized(), q, n).normalized();
}

/// The farther of both farthest points along a line through a point of the difference.
DifferencePoint farther_along(const MinkowskiDifference& difference, const Vec4& line,
                              const Vec4& from) {
    const DifferencePoint p = difference.support(line), q = difference.support(-line);
    return line.dot(p.at - from) >= -line.dot(q.at - from) ? p : q;
}

FullSimplex filled_up(const MinkowskiDifference& difference, const Simplex& simplex) {
    // A difference that is no thicker than this [rounding] is flat: what overlaps is rounding.
    constexpr double kThin = 8;
    const double thin = kThin * difference.rounding();
    FullSimplex full;
    full.point[0] = simplex.point(0);
    full.count = 1;
    Vec4 q[4];
    const auto add = [&](const DifferencePoint& p) {
        const Vec4 own = orthogonal_part(p.at - full.point[0].at, q, full.count - 1);
        const double height = own.norm();
        if (!(height > thin)) return false;
        q[full.count - 1] = own / height;
        full.point[static_cast<std::size_t>(full.count++)] = p;
        return true;
    };
    for (int i = 1; i < simplex.count(); ++i) add(simplex.point(i));
    while (full.count < 5) {
        full.flat = orthogonal_to_all(q, full.count - 1);
        if (!add(farther_along(difference, full.flat, full.point[0].at))) break;
    }
    return full;
}

double gap_along(const MinkowskiDifference& difference, const Vec4& normal) {
    return -normal.dot(difference.support(normal).at);
}

/// Goes to a least overlap near a given one, and to the points that show it. The point of the
/// difference that is nearest to a point above the surface, normal (depth + kOutside), has a
/// supporting hyperplane between the two: the overlap along the new direction is no larger.
class Polishing {
  public:
    Polishing(const MinkowskiDifference& difference, const KnownGap& start)
        : difference_(difference), best_(start) {}

    /// Ends with the points of the best direction in the simplex.
    const KnownGap& run(Simplex& simplex, const std::array<DifferencePoint, 4>& facet, int known,
                        bool is_round) {
        aim(simplex, difference_.support(best_.normal));
        for (int i = 0; i < known; ++i)
            simplex.add(facet[static_cast<std::size_t>(i)], kOutside / 2);
        for (int round = 0; round < kMaxPolishing; ++round) {
            if (round > 0) aim(simplex, difference_.support(best_.normal));
            const KnownGap found = approach_target(difference_, simplex);
            const bool nearer = !found.normal.isZero(0) && improve(found.normal);
            if (!(is_round && descend()) && !nearer) break;
        }
        return best_;
    }

  private:
    void aim(Simplex& simplex, const DifferencePoint& first) const {
        simplex.start(best_.normal * (kOutside - best_.gap), first);
    }

    /// False: the direction is no better, but for rounding.
    bool improve(const Vec4& normal) {
        const double gap = gap_along(difference_, normal);
        const double enough = kEqual * difference_.rounding();
        if (!(gap > best_.gap + enough)) return false;
        best_ = {normal, gap};
        return true;
    }

    /// How the farthest point moves as the direction turns: its change for a unit.
    struct Turn {
        Vec4 mean, change;
    };
    Turn turn_toward(const Vec4& tangent) const {
        constexpr double kStep = 1e-4;
        const Vec4 ahead = difference_.support(best_.normal + kStep * tangent).at;
        const Vec4 behind = difference_.support(best_.normal - kStep * tangent).at;
        return {(ahead + behind) / 2, (ahead - behind) / (2 * kStep)};
    }

    /// The directions in which the farthest point jumps: no body of our size is so little bent.
    /// There the overlap has an edge, which the nearest point has found already.
    int find_jumps(Vec4* q) const {
        constexpr double kLargestRadius = 16;
        Vec4 probe[4] = {best_.normal};
        int n = 1;
        for (int j = 1; j < 4; ++j) {
            probe[j] = orthogonal_to_all(probe, j);
            const Vec4 own = orthogonal_part(turn_toward(probe[j]).change, q, n);
            const double length = own.norm();
            if (n < 4 && length > kLargestRadius) q[n++] = own / length;
        }
        return n;
    }

    /// A Newton step of the overlap h over the directions in which it is smooth, by differences of
    /// supports, which are its gradients: its second derivative is theirs, less h for the bend of
    /// the unit sphere. False: that is no better.
    bool descend() {
        constexpr double kFarthest = 10;
        Vec4 q[4] = {best_.normal};
        const int first = find_jumps(q);
        if (first == 4) return false;
        Eigen::Matrix3d bend = Eigen::Matrix3d::Identity();
        Eigen::Vector3d slope = Eigen::Vector3d::Zero();
        for (int j = first; j < 4; ++j) q[j] = orthogonal_to_all(q, j);
        for (int j = first; j < 4; ++j) {
            const Turn turn = turn_toward(q[j]);
            for (int i = first; i < 4; ++i) bend(i - 1, j - 1) = q[i].dot(turn.change);
            bend(j - 1, j - 1) += best_.gap;
            slope[j - 1] = q[j].dot(turn.mean);
        }
        Eigen::Vector3d way = -bend.inverse() * slope;
        if (!(way.norm() < kFarthest)) return false;
        for (int attempt = 0; attempt < 3; ++attempt, way *= 0.25) {
            Vec4 normal = best_.normal;
            for (int j = first; j < 4; ++j) normal += way[j - 1] * q[j];
            if (improve(normal.normalized())) return true;
        }
        return false;
    }

    const MinkowskiDifference& difference_;
    KnownGap best_;
};

/// Where bodies overlap or touch; or where they are so little apart that the direction is in doubt.
/// @return nothing if the direction was taken
std::optional<KnownGap> deepest_overlap(const MinkowskiDifference& difference, Simplex& simplex,
                                        const KnownGap& apart, const TakesDirection& takes) {
    const bool overlaps = simplex.contains_target();
    const FullSimplex full = filled_up(difference, simplex);
    KnownGap best = apart;
    LeastOverlap least;
    int known = 0;
    if (full.count == 5) {
        const auto offers = [&](const Vec4& n) { return overlaps && !n.isZero(0) && takes(n); };
        const auto found = least_overlap(difference, full.point, offers);
        if (!found) return std::nullopt;
        least = *found;
        if (offers(least.normal)) return std::nullopt;
        known = 4;
        if (-least.depth > best.gap) best = {least.normal, -least.depth};
    } else {
        for (const Vec4& normal : {full.flat, Vec4(-full.flat)}) {
            const double gap = gap_along(difference, normal);
            if (gap > best.gap) best = {normal, gap};
        }
    }
    // No facet was fit to start with: any direction.
    if (best.normal.isZero(0)) best = {Vec4::UnitX(), gap_along(difference, Vec4::UnitX())};
    return Polishing(difference, best)
        .run(simplex, least.facet, known, known > 0 && !least.is_exact);
}

/// The simplex of one point along a direction.
Simplex first_simplex(MinkowskiDifference& difference, const Vec4& guess) {
    const bool is_direction = guess.allFinite() && !guess.isZero(0);
    const DifferencePoint first =
        difference.support(is_direction ? stable_normalized(guess) : Vec4(Vec4::UnitX()));
    difference.note_coordinates(first);
    Simplex simplex;
    simplex.start(Vec4::Zero(), first);
    return simplex;
}

constexpr auto takes_none = [](const Vec4&) { return false; };

/// @return nothing if the direction was taken
std::optional<ConvexSeparation> separation_from(const MinkowskiDifference& difference,
                                                Simplex& simplex, double enough,
                                                const TakesDirection& takes) {
    KnownGap best = approach_target(difference, simplex, enough / difference.unit());
    const double distance = simplex.contains_target() ? 0 : simplex.nearest().norm();
    if (best.normal.isZero(0) || simplex.contains_target() ||
        (distance < kNearlyTouching && distance - best.gap > 2 * kEqual * difference.rounding())) {
        const auto deepest = deepest_overlap(difference, simplex, best, takes);
        if (!deepest) return std::nullopt;
        best = *deepest;
    }

    // The points lie apart along the normal but for a part of the error of round bodies' normals,
    // and there it is along the surfaces.
    const Vec4 on_a = simplex.nearest_on_a();
    const Vec4 on_b = on_a - (simplex.nearest() + simplex.target());
    const Vec4 middle = (on_a + on_b) / 2, half = best.normal * (best.gap / 2);
    const double unit = difference.unit();
    return ConvexSeparation{best.normal, unit * best.gap, unit * (middle - half),
                            unit * (middle + half)};
}

}  // namespace

ConvexSeparation separation_of(const Support& a, const Support& b, const Vec4& guess, double size,
                               double enough) {
    MinkowskiDifference difference(a, b, size);
    Simplex simplex = first_simplex(difference, guess);
    return *separation_from(difference, simplex, enough, takes_none);
}

std::optional<ConvexSeparation> separation_unless(const Support& a, const Support& b,
                                                  const Vec4& guess, double size,
                                                  const TakesDirection& takes) {
    MinkowskiDifference difference(a, b, size);
    Simplex simplex = first_simplex(difference, guess);
    return separation_from(difference, simplex, std::numeric_limits<double>::infinity(), takes);
}

ConvexSeparation separation_of(const Support& a, const Support& b,
                               std::span<const VertexPair> first, double size, double enough) {
    MinkowskiDifference difference(a, b, size);
    std::array<DifferencePoint, 5> points;
    for (std::size_t i = 0; i < first.size(); ++i) points[i] = difference.point_of(first[i]);
    difference.note_coordinates(points[0]);
    Simplex simplex;
    simplex.start(Vec4::Zero(), std::span(points.data(), first.size()));
    return *separation_from(difference, simplex, enough, takes_none);
}

}  // namespace tesserae
