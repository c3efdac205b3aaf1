// SPDX-License-Identifier: Apache-2.0
#include "core/contact/hypercapsule_hypercapsule.hpp"

#include <algorithm>
#include <cmath>

#include "core/contact/branchless.hpp"
#include "core/contact/capsule_core.hpp"

namespace tesserae {
namespace {

/// Two cores as their relation sees them.
struct Cores {
    CapsuleCore a, b;
    Vec4 between;     ///< of the centres, from a to b
    double cosine;    ///< of the axes
    Vec4 across;      ///< b's axis without its part along a's
    double centre_b;  ///< b's centre along a's axis, from a's centre
    double centre_a;  ///< a's centre along b's axis, from b's centre
    double sine2;     ///< |across|^2

    Cores(const Hypercapsule& first, const Pose& pose_a, const Hypercapsule& second,
          const Pose& pose_b)
        : a(core_of(first, pose_a)),
          b(core_of(second, pose_b)),
          between(b.centre - a.centre),
          cosine(a.axis.dot(b.axis)),
          across(b.axis - cosine * a.axis),
          centre_b(a.axis.dot(between)),
          centre_a(-b.axis.dot(between)) {
        across -= a.axis.dot(across) * a.axis;  // for a small angle the first time was not enough
        sine2 = across.squaredNorm();
    }

    Vec4 gap(double s, double t) const { return between + t * b.axis - s * a.axis; }
    /// The point of b's core nearest to a's at s.
    double on_b(double s) const { return std::clamp(centre_a + cosine * s, -b.half, b.half); }
    double length() const { return stable_norm(between) + a.half + b.half; }
};

struct ClosestPoints {
    double s, t;  ///< on a's and b's core
    Vec4 gap;     ///< from a's point to b's
    bool inside;  ///< neither is an end
};

/// Unbounded optimum, clamped on b, then on a, then on b again (Ericson, Real-Time Collision
/// Detection, 2005, section 5.1.9). Unlike there the optimum comes from the axis's part across the
/// other, which loses nothing for small angles; and a gap that has to be orthogonal to a core is
/// made so, since a small one is mostly rounding otherwise.
ClosestPoints closest_points(const Cores& cores) {
    const CapsuleCore &a = cores.a, &b = cores.b;
    const Vec4 apart = cores.between - cores.centre_b * a.axis;
    double t = cores.sine2 > 0 ? -cores.across.dot(apart) / cores.sine2 : 0;
    t = std::clamp(t, -b.half, b.half);
    const double wanted = cores.centre_b + cores.cosine * t;
    const double s = std::clamp(wanted, -a.half, a.half);
    const double again = cores.on_b(s);
    t = s != wanted ? again : t;

    // What the gap has along a core, or at an end back along it, is rounding. Which of these cases
    // it is nobody can predict, so they are told apart by factors rather than branches.
    Vec4 gap = cores.gap(s, t);
    const double along_a = a.axis.dot(gap), along_b = b.axis.dot(gap);
    const bool inside_a = std::abs(s) < a.half, inside_b = std::abs(t) < b.half;
    const bool across_a = either(inside_a, along_a * s < 0);
    const double part_a = across_a ? along_a : 0;
    const bool across_b = either(inside_b, (along_b - cores.cosine * part_a) * t > 0);
    const double part_b = both(across_b, !across_a) ? along_b : 0;
    gap -= part_a * a.axis + part_b * b.axis;
    if (both(both(across_b, across_a), cores.sine2 > 0)) {
        const double sine = std::sqrt(cores.sine2), along = cores.across.dot(gap) / sine;
        if (std::abs(along) <= kCoreRounding * cores.length()) gap -= along / sine * cores.across;
    }
    return {s, t, gap, inside_a && inside_b};
}

Vec4 orthogonal_to_both(const Cores& cores, const Mat4& rotation_a) {
    int best = 0;
    const Vec4 parts = (rotation_a.transpose() * cores.across).cwiseAbs();
    for (int i : {2, 3})
        if (parts[i] < parts[best]) best = i;
    const Vec4 axis = rotation_a.col(best);
    if (cores.sine2 == 0) return axis;
    return (axis - cores.across.dot(axis) / cores.sine2 * cores.across).normalized();
}

}  // namespace

void contacts_between(const Hypercapsule& a, const Pose& pose_a, const Hypercapsule& b,
                      const Pose& pose_b, double margin, PairContacts& out) {
    const double radii = a.radius + b.radius;
    const double reach = radii + 0.5 * (a.height + b.height) + margin;
    if (!((pose_b.position - pose_a.position).squaredNorm() <= reach * reach)) return;

    const Cores cores(a, pose_a, b, pose_b);
    const ClosestPoints closest = closest_points(cores);
    const double distance = stable_norm(closest.gap);
    if (!(distance - radii <= margin)) return;
    const Vec4 normal = distance > kCoreRounding * cores.length()
                            ? stable_normalized(closest.gap)
                            : orthogonal_to_both(cores, to_matrix(pose_a.rotor));

    const auto add = [&](std::uint32_t feature, double s, double separation, const Vec4& gap) {
        if (!(separation <= margin)) return;
        out.add(feature, normal, separation,
                cores.a.at(s) + 0.5 * (gap + (a.radius - b.radius) * normal));
    };

    // The stretch that both cores share, along a's.
    const double shadow = std::abs(cores.cosine) * cores.b.half;
    const double low = std::max(-cores.a.half, cores.centre_b - shadow);
    const double high = std::min(cores.a.half, cores.centre_b + shadow);
    const double stretch = high - low, radius = std::min(a.radius, b.radius);
    if (!(stretch > kShortStretch * radius &&
          std::sqrt(cores.sine2) * stretch <= kSideBySide * radius))
        return add(2, closest.s, distance - radii, closest.gap);

    // Where an end decides, it is the closest point itself that stands for it.
    const bool low_is_closest = !closest.inside && closest.s - low < high - closest.s;
    const bool high_is_closest = !closest.inside && !low_is_closest;
    const auto add_end = [&](std::uint32_t feature, double s, bool is_closest) {
        if (is_closest) return add(feature, closest.s, distance - radii, closest.gap);
        const Vec4 gap = cores.gap(s, cores.on_b(s));
        add(feature, s, normal.dot(gap) - radii, gap);
    };
    add_end(0, low, low_is_closest);
    add_end(1, high, high_is_closest);
}

}  // namespace tesserae
