// SPDX-License-Identifier: Apache-2.0
#include "core/convex/simplex.hpp"

#include <Eigen/LU>

namespace tesserae {
namespace {

/// Takes what lies along up to three edges out of v, and adds how much of each to the parts, by the
/// inverse of their scalar products. False: they are not well apart in direction.
template <int N>
bool project_upright(const Vec4* e, Vec4& v, double* part) {
    // Of the square of the sine between edges, or of the like for three: below this the inverse
    // loses more digits than a second solution brings back.
    constexpr double kUpright = 1e-3;
    double inverse[N][N];
    const double aa = e[0].squaredNorm();
    if constexpr (N == 1) {
        if (!(aa > 0)) return false;
        inverse[0][0] = 1 / aa;
    } else {
        const double bb = e[1].squaredNorm(), ab = e[0].dot(e[1]), of_two = aa * bb - ab * ab;
        if constexpr (N == 2) {
            if (!(of_two > kUpright * aa * bb)) return false;
            const double scale = 1 / of_two;
            inverse[0][0] = scale * bb;
            inverse[0][1] = inverse[1][0] = -scale * ab;
            inverse[1][1] = scale * aa;
        } else {
            const double cc = e[2].squaredNorm(), ac = e[0].dot(e[2]), bc = e[1].dot(e[2]);
            const double first = bb * cc - bc * bc, second = ac * bc - ab * cc,
                         third = ab * bc - ac * bb;
            const double of_three = aa * first + ab * second + ac * third;
            if (!(of_three > kUpright * aa * bb * cc)) return false;
            const double scale = 1 / of_three;
            inverse[0][0] = scale * first;
            inverse[0][1] = inverse[1][0] = scale * second;
            inverse[0][2] = inverse[2][0] = scale * third;
            inverse[1][1] = scale * (aa * cc - ac * ac);
            inverse[1][2] = inverse[2][1] = scale * (ab * ac - aa * bc);
            inverse[2][2] = scale * of_two;
        }
    }
    // The second time: what is left is orthogonal to rounding of itself.
    for (int pass = 0; pass < 2; ++pass) {
        double along[N];
        for (int i = 0; i < N; ++i) along[i] = e[i].dot(v);
        for (int i = 0; i < N; ++i) {
            double sum = 0;
            for (int j = 0; j < N; ++j) sum -= inverse[i][j] * along[j];
            part[i] += sum;
            v += sum * e[i];
        }
    }
    return true;
}

/// The parts of four edges that lead from a base to the target. False: they are nearly dependent.
bool solve_full(const Vec4& base, const Vec4* e, double* part) {
    // Of the base, squared: what the first solution may leave.
    constexpr double kLeft = 1e-20;
    Mat4 columns;
    for (int k = 0; k < 4; ++k) columns.col(k) = e[k];
    const Mat4 inverse = columns.inverse();
    const Vec4 first = -(inverse * base), rest = base + columns * first;
    if (!(rest.squaredNorm() <= kLeft * base.squaredNorm())) return false;
    const Vec4 all = first - inverse * rest;
    for (int k = 0; k < 4; ++k) part[k] = all[k];
    return true;
}

}  // namespace

Vec4 orthogonal_part(const Vec4& v, const Vec4* directions, int n) {
    // Less than this of the square left: the rounding of what went is too much for it.
    constexpr double kMostWent = 0.1;
    Vec4 rest = v;
    for (int k = 0; k < n; ++k) rest -= directions[k].dot(rest) * directions[k];
    if (rest.squaredNorm() > kMostWent * v.squaredNorm()) return rest;
    for (int k = 0; k < n; ++k) rest -= directions[k].dot(rest) * directions[k];
    return rest;
}

void Simplex::start(const Vec4& target, const DifferencePoint& point) {
    target_ = target;
    points_[0] = point;
    seen_[0] = nearest_ = point.at - target;
    weight_[0] = 1;
    count_ = 1;
    contains_target_ = is_careful_ = false;
}

void Simplex::start(const Vec4& target, std::span<const DifferencePoint> points) {
    start(target, points[0]);
    if (points.size() == 1) return;
    for (std::size_t i = 1; i < points.size(); ++i) {
        points_[i] = points[i];
        seen_[i] = points[i].at - target;
        weight_[i] = 0;
    }
    count_ = static_cast<int>(points.size());
    double weight[kMaxPoints];
    Vec4 nearest;
    if (find_affine_nearest(weight, nearest) && is_inside(weight)) {
        take(weight, nearest);
        return;
    }
    // One after the other.
    count_ = 1;
    for (std::size_t i = 1; i < points.size() && !contains_target_; ++i) add(points[i], 0);
}

bool Simplex::add(const DifferencePoint& point, double at_least) {
    if (count_ == kMaxPoints) return false;
    for (int i = 0; i < count_; ++i)
        if (points_[static_cast<std::size_t>(i)].at == point.at) return false;
    const auto last = static_cast<std::size_t>(count_++);
    points_[last] = point;
    seen_[last] = point.at - target_;
    weight_[last] = 0;
    // Every round but the last drops a point.
    while (true) {
        double weight[kMaxPoints];
        Vec4 nearest;
        if (!find_affine_nearest(weight, nearest)) {
            merge_last();
            continue;
        }
        const bool inside = is_inside(weight);
        if (inside && nearest.norm() < at_least) {
            merge_last();
            continue;
        }
        if (inside) {
            take(weight, nearest);
            return true;
        }
        step_toward(weight);
    }
}

bool Simplex::is_inside(const double* weight) const {
    bool inside = true;
    for (int i = 0; i < count_; ++i) inside = inside && weight[i] > 0;
    return inside;
}

void Simplex::take(const double* weight, const Vec4& nearest) {
    for (int i = 0; i < count_; ++i) weight_[static_cast<std::size_t>(i)] = weight[i];
    nearest_ = nearest;
    contains_target_ = count_ == kMaxPoints;
}

Simplex::Edges Simplex::edges_from_heaviest() const {
    // The base's weight is what the others leave of 1, which rounds where little is left.
    std::size_t base = 0;
    const auto count = static_cast<std::size_t>(count_);
    for (std::size_t i = 1; i < count; ++i)
        if (weight_[i] > weight_[base]) base = i;
    Edges edges;
    edges.base = static_cast<int>(base);
    edges.count = count_ - 1;
    for (std::size_t k = 0; k + 1 < count; ++k)
        edges.edge[k] = seen_[k < base ? k : k + 1] - seen_[base];
    return edges;
}

/// False: the edges are not well apart in direction.
bool Simplex::find_upright(Edges& edges, Vec4& nearest) const {
    if (edges.count == kMaxPoints - 1) {
        nearest.setZero();
        return solve_full(seen_[static_cast<std::size_t>(edges.base)], edges.edge.data(),
                          edges.part.data());
    }
    nearest = seen_[static_cast<std::size_t>(edges.base)];
    edges.part.fill(0);
    const Vec4* e = edges.edge.data();
    if (edges.count == 1) return project_upright<1>(e, nearest, edges.part.data());
    if (edges.count == 2) return project_upright<2>(e, nearest, edges.part.data());
    if (edges.count == 3) return project_upright<3>(e, nearest, edges.part.data());
    return true;
}

/// False: the points are affinely dependent.
bool Simplex::find_orthonormal(Edges& edges, Vec4& nearest) const {
    // Of an edge that lies in the span of the others, this much is left by rounding.
    constexpr double kDependent = 2e-15;
    const auto n = static_cast<std::size_t>(edges.count);
    std::array<Vec4, kMaxPoints - 1> q;
    q.fill(Vec4::Zero());
    double upper[kMaxPoints - 1][kMaxPoints - 1], along[kMaxPoints - 1];
    Vec4 rest = seen_[static_cast<std::size_t>(edges.base)];
    for (std::size_t k = 0; k < n; ++k) {
        const Vec4& edge = edges.edge[k];
        const Vec4 own = orthogonal_part(edge, q.data(), static_cast<int>(k));
        const double square = own.squaredNorm();
        if (!(square > kDependent * kDependent * (1 + edge.squaredNorm()))) return false;
        upper[k][k] = std::sqrt(square);
        q[k] = own / upper[k][k];
        for (std::size_t i = 0; i < k; ++i) upper[i][k] = q[i].dot(edge);
        along[k] = -q[k].dot(rest);
        rest += along[k] * q[k];
    }
    // Orthogonal to the edges also where it is much smaller than the points are far.
    nearest =
        n == kMaxPoints - 1 ? Vec4(Vec4::Zero()) : orthogonal_part(rest, q.data(), edges.count);
    for (std::size_t k = n; k-- > 0;) {
        double sum = along[k];
        for (std::size_t j = k + 1; j < n; ++j) sum -= upper[k][j] * edges.part[j];
        edges.part[k] = sum / upper[k][k];
    }
    return true;
}

/// The weights, whose sum is 1, of the point of the affine hull that is nearest to the target.
/// False: the points are affinely dependent.
bool Simplex::find_affine_nearest(double* weight, Vec4& nearest) const {
    Edges edges = edges_from_heaviest();
    if ((is_careful_ || !find_upright(edges, nearest)) && !find_orthonormal(edges, nearest))
        return false;
    double left = 1;
    for (int k = 0; k < edges.count; ++k) {
        const double part = edges.part[static_cast<std::size_t>(k)];
        weight[k < edges.base ? k : k + 1] = part;
        left -= part;
    }
    weight[edges.base] = left;
    return true;
}

/// Moves the weights toward the given ones until the first is 0, and drops its point.
void Simplex::step_toward(const double* weight) {
    double step = 2;
    int first = 0;
    for (int i = 0; i < count_; ++i) {
        if (weight[i] > 0) continue;
        const double own = weight_[static_cast<std::size_t>(i)];
        const double until = own == 0 ? 0 : own / (own - weight[i]);
        if (until < step) step = until, first = i;
    }
    for (int i = 0; i < count_; ++i) {
        double& own = weight_[static_cast<std::size_t>(i)];
        own += step * (weight[i] - own);
        own = std::max(own, 0.0);
    }
    drop(first);
}

void Simplex::drop(int i) {
    // Order is kept: the newest point remains the last.
    for (auto k = static_cast<std::size_t>(i); k + 1 < static_cast<std::size_t>(count_); ++k) {
        points_[k] = points_[k + 1];
        seen_[k] = seen_[k + 1];
        weight_[k] = weight_[k + 1];
    }
    --count_;
}

bool Simplex::refine() {
    if (is_careful_) return false;
    is_careful_ = true;
    double weight[kMaxPoints];
    Vec4 nearest;
    if (!find_affine_nearest(weight, nearest) || !is_inside(weight)) return false;
    take(weight, nearest);
    return true;
}

/// The last point takes the place of the one next to it, of which rounding cannot tell it apart.
void Simplex::merge_last() {
    const auto last = static_cast<std::size_t>(count_ - 1);
    std::size_t next = 0;
    for (std::size_t i = 1; i < last; ++i)
        if ((seen_[i] - seen_[last]).squaredNorm() < (seen_[next] - seen_[last]).squaredNorm())
            next = i;
    weight_[last] += weight_[next];
    drop(static_cast<int>(next));
}

Vec4 Simplex::nearest_on_a() const {
    Vec4 sum = Vec4::Zero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i)
        sum += weight_[i] * points_[i].on_a;
    return sum;
}

}  // namespace tesserae
