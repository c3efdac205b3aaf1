// SPDX-License-Identifier: Apache-2.0
#include "core/contact/hypercapsule_hyperbox.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/contact/capsule_core.hpp"

namespace tesserae {
namespace {

/// A normal with this much of a cell's has a second point over that cell (25 degrees).
constexpr double kCellPart = 0.9;
/// The cell is larger by this part for the clipping of the core, so that a capsule that lies along
/// its border does not lose and win points by rounding.
constexpr double kBorder = 1e-10;
constexpr std::uint32_t kBetween = 10;

/// The core and the box, in the box's frame.
struct Relation {
    CapsuleCore core;
    Vec4 half;
    Mat4 rotation;  ///< of the box

    Relation(const Hypercapsule& capsule, const Pose& pose, const Hyperbox& box,
             const Pose& box_pose)
        : half(0.5 * box.size), rotation(to_matrix(box_pose.rotor)) {
        const CapsuleCore world = core_of(capsule, pose);
        core = {rotation.transpose() * (world.centre - box_pose.position),
                rotation.transpose() * world.axis, world.half};
    }

    /// From the box's closest point to the core's point at t.
    Vec4 excess(double t) const {
        const Vec4 point = core.at(t);
        return point - point.cwiseMin(half).cwiseMax(-half);
    }
    double rounding() const {
        return kCoreRounding * ((core.centre.cwiseAbs() + half).maxCoeff() + core.half);
    }
};

/// Where the core is closest to the box or overlaps it least.
struct Closest {
    double t;         ///< along the core
    Vec4 normal;      ///< unit, out of the box
    double distance;  ///< of the core along the normal, negative when it meets the box
};

/// Half the derivative of the squared distance along the core.
class Slope {
  public:
    explicit Slope(const Relation& relation) : relation_(relation) {
        const CapsuleCore& core = relation.core;
        for (int i = 0; i < 4; ++i) {
            const double side = std::copysign(relation.half[i], core.axis[i]);
            enter_[i] = (-side - core.centre[i]) / core.axis[i];
            leave_[i] = (side - core.centre[i]) / core.axis[i];
        }
    }
    /// Where the core crosses the cell hyperplanes, and its ends, ascending.
    std::array<double, 10>::iterator fill(std::array<double, 10>& breaks) const {
        auto end = breaks.begin();
        *end++ = -relation_.core.half;
        for (const Vec4* crossings : {&enter_, &leave_})
            for (double t : *crossings)
                if (std::abs(t) < relation_.core.half) *end++ = t;
        *end++ = relation_.core.half;
        std::sort(breaks.begin(), end);
        return end;
    }
    /// An axis that the core crosses counts from its crossing: exactly 0 there. Its rounding could
    /// hide the slope that another axis has at a very small angle.
    double at(double t) const {
        const CapsuleCore& core = relation_.core;
        const Vec4 excess = relation_.excess(t);
        double slope = 0;
        for (int i = 0; i < 4; ++i) {
            const double u = core.axis[i];
            const double crossing = t < enter_[i] ? enter_[i] : leave_[i];
            if (t >= enter_[i] && t <= leave_[i]) continue;
            slope += std::abs(crossing) < core.half ? u * (u * (t - crossing)) : u * excess[i];
        }
        return slope;
    }

  private:
    const Relation& relation_;
    Vec4 enter_, leave_;  ///< along the core; infinite or no number where it is parallel
};

/// The squared distance is convex, and between the core's crossings of the box's eight cell
/// hyperplanes quadratic, so its slope rises linearly there. The first minimum, if there are many.
double closest_on_core(const Relation& relation) {
    const Slope slope(relation);
    std::array<double, 10> breaks;
    const auto end = slope.fill(breaks);
    const auto rising =
        std::partition_point(breaks.begin(), end, [&](double t) { return slope.at(t) < 0; });
    if (rising == breaks.begin()) return -relation.core.half;
    if (rising == end) return relation.core.half;
    const double t0 = *(rising - 1), t1 = *rising;
    const double slope0 = slope.at(t0), slope1 = slope.at(t1);
    return t0 + (t1 - t0) * (slope0 / (slope0 - slope1));
}

/// None if the core meets the box.
std::optional<Closest> closest_apart(const Relation& relation) {
    const double t = closest_on_core(relation);
    Vec4 gap = relation.excess(t);
    if (std::abs(t) < relation.core.half) {
        // What a gap has along the core is rounding, but of a small gap a large part: it goes.
        const Vec4 axis = (gap.array() == 0).select(0, relation.core.axis);
        const double length = stable_norm(axis);
        const double along = length > 0 ? axis.dot(gap) / length : 0;
        if (along != 0 && std::abs(along) <= relation.rounding()) gap -= along / length * axis;
    }
    const double distance = stable_norm(gap);
    if (!(distance > relation.rounding())) return std::nullopt;
    return Closest{t, stable_normalized(gap), distance};
}

/// Where the core passes, along a normal in the plane of the axes i and j, over the box's 2-face on
/// their sides. A core nearly parallel to that face fixes it badly: within the face's borders then.
double point_over_edge(const Relation& relation, const Vec4& normal, int i, int j) {
    const CapsuleCore& core = relation.core;
    const Vec4 &c = core.centre, &u = core.axis, &half = relation.half;
    const double square = u[i] * u[i] + u[j] * u[j];
    double low = -core.half, high = core.half;
    for (int k = 0; k < 4; ++k) {
        if (k == i || k == j || u[k] == 0) continue;
        const double side = std::copysign(half[k], u[k]);
        low = std::max(low, (-side - c[k]) / u[k]);
        high = std::min(high, (side - c[k]) / u[k]);
    }
    const double t = ((sign_of(normal[i]) * half[i] - c[i]) * u[i] +
                      (sign_of(normal[j]) * half[j] - c[j]) * u[j]) /
                     square;
    // Borders that leave nothing by rounding leave the point to the core's ends.
    if (!(low <= high)) low = -core.half, high = core.half;
    return square > 0 ? std::clamp(t, low, high) : low;
}

/// The least overlap over the facets of the Minkowski difference: the cells, and those spanned by
/// the core and two of the box's edges, whose normals lie in the plane of the other two axes.
Closest least_overlap(const Relation& relation) {
    const CapsuleCore& core = relation.core;
    const Vec4 &c = core.centre, &u = core.axis, &half = relation.half;
    const Vec4 depths = half + core.half * u.cwiseAbs() - c.cwiseAbs();
    int cell;
    double depth = depths.minCoeff(&cell);
    const double side = sign_of(c[cell]);
    Closest best{-side * sign_of(u[cell]) * core.half, side * Vec4::Unit(cell), -depth};

    depth -= relation.rounding();  // Edges have to be better by more than that.
    for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j) {
            const double length = std::hypot(u[i], u[j]);
            if (length == 0) continue;
            const double along_i = u[i] / length, along_j = u[j] / length;
            const double height = along_i * c[j] - along_j * c[i], out = sign_of(height);
            const double n_i = -out * along_j, n_j = out * along_i;
            const double overlap =
                half[i] * std::abs(n_i) + half[j] * std::abs(n_j) - std::abs(height);
            if (!(overlap < depth)) continue;
            depth = overlap;
            const Vec4 normal = n_i * Vec4::Unit(i) + n_j * Vec4::Unit(j);
            best = {point_over_edge(relation, normal, i, j), normal, -overlap};
        }
    return best;
}

/// An end of the stretch of the core over a cell.
struct End {
    double t;
    std::uint32_t feature;
};
struct Stretch {
    End low, high;
};

/// Seen along the normal, whose greatest part is across the cell.
Stretch stretch_over_cell(const Relation& relation, const Vec4& normal, int cell) {
    // The core's shadow on the cell's hyperplane.
    const Vec4 along = normal / normal[cell];
    const double height = std::copysign(relation.half[cell], normal[cell]);
    const CapsuleCore& core = relation.core;
    const Vec4 centre = core.centre - (core.centre[cell] - height) * along;
    const Vec4 axis = core.axis - core.axis[cell] * along;

    Stretch stretch{{-core.half, 0}, {core.half, 1}};
    for (int i = 0; i < 4; ++i) {
        if (i == cell) continue;
        const double border = relation.half[i] + kBorder * (relation.half[i] + core.half);
        for (std::uint32_t side : {0u, 1u}) {
            // Inside is where outwards (c + t u) <= border.
            const double outwards = side == 0 ? -1 : 1;
            const double room = border - outwards * centre[i];
            const double speed = outwards * axis[i];
            const End end{room / speed, 2 + 2 * static_cast<std::uint32_t>(i) + side};
            if (speed > 0 && end.t < stretch.high.t) stretch.high = end;
            if (speed < 0 && end.t > stretch.low.t) stretch.low = end;
            if (speed == 0 && room < 0) stretch.low.t = kMiss;
        }
    }
    return stretch;
}

std::uint32_t feature_of(const CapsuleCore& core, double t) {
    return t == -core.half ? 0 : t == core.half ? 1 : kBetween;
}

/// The points along one normal: two where the core passes over the cell that it is near to.
/// @param position   the box's
void report(const Relation& relation, const Closest& closest, double radius, const Vec4& position,
            double margin, PairContacts& out) {
    const CapsuleCore& core = relation.core;
    const Vec4 normal = relation.rotation * closest.normal;
    const auto add = [&](std::uint32_t feature, double t, double distance) {
        const double separation = distance - radius;
        if (!(separation <= margin)) return;
        out.add(feature, -normal, separation,
                position + relation.rotation * core.at(t) - (radius + 0.5 * separation) * normal);
    };

    int cell;
    const double part = closest.normal.cwiseAbs().maxCoeff(&cell);
    Stretch stretch{{kMiss, 0}, {-kMiss, 0}};
    if (part >= kCellPart) stretch = stretch_over_cell(relation, closest.normal, cell);
    const double length = stretch.high.t - stretch.low.t;
    if (!(length >= 0)) return add(feature_of(core, closest.t), closest.t, closest.distance);

    // Along the normal down to the cell. At the closest point that is the distance: straight over a
    // cell both ends of the stretch are such points, else the one near it is put there.
    const double outward = sign_of(closest.normal[cell]);
    const std::size_t near = closest.t - stretch.low.t < stretch.high.t - closest.t ? 0 : 1;
    std::array<End, 2> ends{stretch.low, stretch.high};
    std::array<double, 2> distances;
    for (std::size_t i = 0; i < 2; ++i)
        distances[i] = std::max(  // none is nearer, but for the wider border
            closest.distance, (outward * core.at(ends[i].t)[cell] - relation.half[cell]) / part);
    if (part < 1) {
        ends[near].t = closest.t;
        distances[near] = closest.distance;
    }

    const std::size_t deeper = part < 1 ? near : distances[0] <= distances[1] ? 0 : 1;
    const std::size_t first = ends[0].feature < ends[1].feature ? 0 : 1;
    for (std::size_t i : {first, 1 - first})
        if (i == deeper || length > kShortStretch * radius)
            add(ends[i].feature, ends[i].t, distances[i]);
}

}  // namespace

void contacts_between(const Hypercapsule& capsule, const Pose& pose, const Hyperbox& box,
                      const Pose& box_pose, double margin, PairContacts& out) {
    // Nothing if a cell hyperplane separates them.
    const Relation relation(capsule, pose, box, box_pose);
    const CapsuleCore& core = relation.core;
    const Vec4 gaps = core.centre.cwiseAbs() - relation.half - core.half * core.axis.cwiseAbs();
    if (!(gaps.maxCoeff() - capsule.radius <= margin)) return;
    const std::optional<Closest> apart = closest_apart(relation);
    report(relation, apart ? *apart : least_overlap(relation), capsule.radius, box_pose.position,
           margin, out);
}

void contacts_over_face(const Hypercapsule& capsule, const Pose& pose, const Hyperbox& box,
                        const Pose& box_pose, bool, const Vec4& outward, double margin,
                        PairContacts& out) {
    const Relation relation(capsule, pose, box, box_pose);
    const Face face = face_along(box, relation.rotation.transpose() * outward);
    int cell;
    face.normal.cwiseAbs().maxCoeff(&cell);
    const Stretch stretch = stretch_over_cell(relation, face.normal, cell);
    if (!(stretch.low.t <= stretch.high.t)) return;
    const auto height = [&](double t) {
        return face.normal.dot(relation.core.at(t)) - face.offset;
    };
    const double t =
        height(stretch.low.t) <= height(stretch.high.t) ? stretch.low.t : stretch.high.t;
    report(relation, {t, face.normal, height(t)}, capsule.radius, box_pose.position, margin, out);
}

}  // namespace tesserae
