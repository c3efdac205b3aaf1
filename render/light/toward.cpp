// SPDX-License-Identifier: Apache-2.0
#include "render/light/toward.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

namespace tesserae::render {
namespace {

using std::numbers::pi;
using Vec3 = Eigen::Vector3d;

/// One of two numbers: which part of [0, 1) it was in decides, the place within it goes on.
/// @param part   of the first
bool take_first(double part, double& u) {
    const bool first = u < part;
    u = first ? u / part : (u - part) / (1 - part);
    u = std::min(u, 1 - 1e-16);
    return first;
}

/// The directions from a point to a ball that does not hold it.
class BallCap {
  public:
    BallCap() = default;
    BallCap(const Vec4& to_centre, double radius) : distance_(to_centre.norm()) {
        is_outside_ = distance_ > radius;
        if (!is_outside_) return;
        toward_ = to_centre / distance_;
        const double sine = radius / distance_;
        squared_sine_ = sine * sine;
        // 2 (1 - cosine), which keeps the digits of small angles.
        chord_ = 2 * squared_sine_ / (1 + std::sqrt((1 - sine) * (1 + sine)));
        cap_ = Cap(std::asin(sine));
    }
    bool is_outside() const { return is_outside_; }
    double solid_angle() const { return is_outside_ ? cap_.solid_angle() : 0; }
    double squared_sine() const { return squared_sine_; }
    Vec4 direction(const Uniform3& u) const {
        return TangentFrame(toward_).to_world(cap_.direction(u));
    }
    double density() const { return 1 / cap_.solid_angle(); }
    bool holds(const Vec4& direction) const {
        return is_outside_ && (direction - toward_).squaredNorm() <= chord_;
    }

  private:
    Vec4 toward_ = Vec4::Zero();
    double distance_ = 0;
    Cap cap_;
    double squared_sine_ = 0, chord_ = 0;  ///< chord_: squared, of the angle
    bool is_outside_ = false;
};

/// The directions that look past the nearest point of a shape: half of all, and all that meet it.
template <class S>
std::optional<Cap> half_toward(const S& shape, const Vec4& origin) {
    if (!S::kBounded || !(signed_distance(shape, origin) > 0)) return {};
    return Cap(0.5 * pi);
}

// Any shape: its bounding ball, and inside that half of all directions.
template <class S>
std::optional<Toward> sample(const S& shape, const Vec4& origin, const Uniform3& u) {
    const BallCap ball(-origin, bounding_radius(shape));
    if (ball.is_outside()) return Toward{ball.direction(u), ball.density()};
    const auto half = half_toward(shape, origin);
    if (!half) return {};
    const TangentFrame frame(-normal(shape, origin));
    return Toward{frame.to_world(half->direction(u)), 1 / half->solid_angle()};
}
template <class S>
double density(const S& shape, const Vec4& origin, const Vec4&) {
    const BallCap ball(-origin, bounding_radius(shape));
    if (ball.is_outside()) return ball.density();
    const auto half = half_toward(shape, origin);
    return half ? 1 / half->solid_angle() : 0;
}

/// A number of [0, 1] with a density that goes evenly from a to b (of any scale), and that density.
struct Ramp {
    double at, density;
};
Ramp sample_ramp(double a, double b, double u) {
    const double root = std::sqrt(a * a + u * (b * b - a * a));
    const double at = std::min(1.0, u * (a + b) / (a + root));
    return {at, 2 * (a + at * (b - a)) / (a + b)};
}

/// The cells of a box that face a point. How much of the directions a piece of a cell fills, by its
/// content, goes with the cosine over the cube of the distance: that is worked out at the corners
/// and taken to be trilinear between them, which leaves the squares of the angles that a cell
/// spans.
class FacingCells {
  public:
    FacingCells(const Hyperbox& box, const Vec4& origin) : half_(0.5 * box.size), origin_(origin) {
        for (int axis = 0; axis < 4; ++axis) {
            const double height = std::abs(origin[axis]) - half_[axis];
            if (!(height > 0)) continue;
            Cell& cell = cells_[count_++];
            cell.axis = axis, cell.height = height;
            double mean = 0;
            for (std::size_t corner = 0; corner < 8; ++corner) {
                const double squared = (point(cell, place_of(corner)) - origin).squaredNorm();
                mean += cell.seen[corner] = height / (squared * squared);
            }
            cell.content = box.size.prod() / box.size[axis];
            sum_ += cell.all = cell.content * mean / 8;
        }
        // Far beyond a length of 1e-75 or 1e75 of each other there are no numbers for it.
        if (!(sum_ > 0 && std::isfinite(sum_))) count_ = 0;
    }

    bool any() const { return count_ > 0; }

    std::optional<Toward> sample(Uniform3 u) const {
        const Cell* cell = cells_.data();
        for (double left = sum_; cell < &cells_[count_ - 1]; left -= cell++->all)
            if (take_first(std::min(1.0, cell->all / left), u[0])) break;
        // One coordinate after the other, each by what the corners sum to on its two sides.
        const auto& f = cell->seen;
        const Ramp x = sample_ramp(f[0] + f[2] + f[4] + f[6], f[1] + f[3] + f[5] + f[7], u[0]);
        const auto at_x = [&](std::size_t k) { return f[k] + x.at * (f[k + 1] - f[k]); };
        const Ramp y = sample_ramp(at_x(0) + at_x(4), at_x(2) + at_x(6), u[1]);
        const auto at_y = [&](std::size_t k) { return at_x(k) + y.at * (at_x(k + 2) - at_x(k)); };
        const Ramp z = sample_ramp(at_y(0), at_y(4), u[2]);
        const Vec4 to_point = point(*cell, {x.at, y.at, z.at}) - origin_;
        const double distance = to_point.norm();
        return Toward{to_point / distance, density(*cell, {x.at, y.at, z.at}, distance)};
    }

    /// Of a direction that enters the box: through the last of the planes of facing cells.
    double density_of(const Vec4& direction) const {
        const Cell* last = nullptr;
        double farthest = 0;
        for (const Cell& cell : std::span(cells_).first(count_)) {
            if (!(direction[cell.axis] * origin_[cell.axis] < 0)) return 0;
            const double distance = cell.height / std::abs(direction[cell.axis]);
            if (distance > farthest) farthest = distance, last = &cell;
        }
        if (!last) return 0;
        const Vec4 met = origin_ + farthest * direction;
        Vec3 place;
        for (int i = 0, k = 0; i < 4; ++i)
            if (i != last->axis) place[k++] = std::clamp(0.5 * (met[i] / half_[i] + 1), 0.0, 1.0);
        return density(*last, place, farthest);
    }

  private:
    struct Cell {
        int axis;
        double height;  ///< of the point above the cell's plane [m]
        double content, all;
        std::array<double, 8> seen;  ///< at the corners, the first free axis fastest
    };

    static Vec3 place_of(std::size_t corner) {
        return {static_cast<double>(corner & 1u), static_cast<double>(corner >> 1 & 1u),
                static_cast<double>(corner >> 2)};
    }
    /// @param place   within the cell, 0 to 1 along its three axes
    Vec4 point(const Cell& cell, const Vec3& place) const {
        Vec4 p;
        for (int i = 0, k = 0; i < 4; ++i)
            p[i] = i == cell.axis ? std::copysign(half_[i], origin_[i])
                                  : half_[i] * (2 * place[k++] - 1);
        return p;
    }
    double density(const Cell& cell, const Vec3& place, double distance) const {
        double seen = 0;
        for (std::size_t corner = 0; corner < 8; ++corner) {
            const Vec3 off = Vec3::Ones() - (place_of(corner) - place).cwiseAbs();
            seen += off.prod() * cell.seen[corner];
        }
        const double squared = distance * distance;
        return seen / sum_ * (squared * squared / cell.height);
    }

    Vec4 half_, origin_;
    std::array<Cell, 4> cells_{};
    std::size_t count_ = 0;
    double sum_ = 0;
};

std::optional<Toward> sample(const Hyperbox& box, const Vec4& origin, const Uniform3& u) {
    const FacingCells cells(box, origin);
    return cells.any() ? cells.sample(u) : std::nullopt;
}
double density(const Hyperbox& box, const Vec4& origin, const Vec4& direction) {
    return FacingCells(box, origin).density_of(direction);
}

/// The integral of the squared cosine up to an angle.
double squared_cosines(double angle) { return 0.5 * (angle + std::sin(angle) * std::cos(angle)); }

/// The angle between two up to which it is a given part of the integral between them.
double angle_at(double low, double high, double part) {
    const double from = squared_cosines(low), to = squared_cosines(high);
    const double wanted = from + part * (to - from);
    double angle = low + part * (high - low);
    for (int i = 0; i < 30 && low < high; ++i) {
        const double beyond = squared_cosines(angle) - wanted;
        (beyond > 0 ? high : low) = angle;
        const double slope = std::cos(angle) * std::cos(angle);
        double next = slope > 0 ? angle - beyond / slope : low;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (std::abs(next - angle) < 1e-15) break;
        angle = next;
    }
    return angle;
}

/// A side that spans less [rad] has no digits left; rays find it.
constexpr double kLeastSpan = 1e-9;

/// A capsule seen from outside it, nearly evenly in solid angle: the outer halves of its ends'
/// caps, its side between them, and two rims. In the plane of the capsule's axis and the point, a
/// direction has an angle from the perpendicular to the axis; at an angle t the side fills a disc
/// of sine squared r^2 cos^2 t/(D^2 - r^2 + r^2 cos^2 t) about the axis, for the radius r and the
/// axis D away. So t is chosen by cos^2, and then a point of the disc. As a ray at the disc's edge
/// passes the axis before it crosses it, there is a rim of the side beyond the angle of an end,
/// around the end's cap.
class CapsuleView {
  public:
    CapsuleView(const Hypercapsule& capsule, const Vec4& origin)
        : radius_(capsule.radius), inward_(-origin) {
        const double half = 0.5 * capsule.height;
        inward_[1] = 0;
        distance_ = inward_.norm();
        const Vec4 low = -half * Vec4::UnitY() - origin, high = half * Vec4::UnitY() - origin;
        if (!(distance_ > radius_)) {  // within the axis' tube the near end hides the rest
            near_.emplace(std::abs(low[1]) < std::abs(high[1]) ? low : high, radius_);
            sum_ = near_->solid_angle();
            return;
        }
        inward_ /= distance_;
        over_ = (distance_ - radius_) * (distance_ + radius_);
        ends_ = {end_of(low, -1), end_of(high, 1)};
        const double span = ends_[1].at - ends_[0].at;
        cosines_ = squared_cosines(ends_[1].at) - squared_cosines(ends_[0].at);
        if (span > kLeastSpan)
            side_ =
                pi * radius_ * radius_ * cosines_ / (over_ + radius_ * radius_ * cosines_ / span);
        sum_ = side_;
        for (const End& end : ends_) sum_ += 0.5 * end.cap.solid_angle() + end.rim;
    }

    bool any() const { return sum_ > 0 && std::isfinite(sum_); }

    Vec4 direction(Uniform3 u) const {
        if (near_) return near_->direction(u);
        double left = sum_;
        if (takes(side_, left, u[0])) {
            const double angle = angle_at(ends_[0].at, ends_[1].at, u[0]);
            return direction_at(angle, u[1] * disc(angle), u[2]);
        }
        for (const End& end : ends_) {
            if (!takes(end.rim, left, u[0])) continue;
            const double angle = end.at + u[0] * end.beyond, inner = cap_disc(end, angle);
            return direction_at(angle, inner + u[1] * (disc(angle) - inner), u[2]);
        }
        const End& end = ends_[takes(0.5 * ends_[0].cap.solid_angle(), left, u[0]) ? 0 : 1];
        const Vec4 d = end.cap.direction(u);
        if (end.is_passed(angle_of(d))) return d;
        const Vec4 across = std::cos(end.at) * Vec4::UnitY() - std::sin(end.at) * inward_;
        return d - 2 * across.dot(d) * across;
    }

    /// Of a direction that meets the capsule.
    double density_of(const Vec4& direction) const {
        if (near_) return near_->holds(direction) ? 1 / sum_ : 0;
        const double angle = angle_of(direction);
        for (const End& end : ends_) {
            if (!end.is_passed(angle)) continue;
            if (end.cap.holds(direction)) return 1 / sum_;
            const double area = pi * (disc(angle) - cap_disc(end, angle));
            if (!(end.rim > 0) || !(area > 0)) return 0;
            const double part = (angle - end.at) / end.beyond;
            return part <= 1 ? end.rim / std::abs(end.beyond) / area / sum_ : 0;
        }
        if (!(side_ > 0)) return 0;
        const double cosine = std::cos(angle);
        return side_ * (cosine * cosine / cosines_) / (pi * disc(angle)) / sum_;
    }

  private:
    struct End {
        BallCap cap;
        double side = 0;    ///< -1, +1
        double at = 0;      ///< its angle
        double beyond = 0;  ///< by how much its rim goes on, with that sign
        double rim = 0;     ///< how much of the directions that fills, about [sr]

        bool is_passed(double angle) const { return side * angle > side * at; }
    };
    End end_of(const Vec4& to_end, double side) const {
        End end{BallCap(to_end, radius_), side, std::atan2(to_end[1], distance_)};
        const double last = std::atan(to_end[1] * (distance_ / over_));
        if (!end.is_passed(last)) return end;
        end.beyond = last - end.at;
        const double middle = end.at + 0.5 * end.beyond;
        end.rim = pi * std::abs(end.beyond) * std::max(0.0, disc(middle) - cap_disc(end, middle));
        return end;
    }
    /// Whether a choice falls on the first part of what is left, which is then less by it.
    static bool takes(double part, double& left, double& u) {
        const bool taken = left > 0 && take_first(std::min(1.0, part / left), u);
        left -= part;
        return taken;
    }
    double angle_of(const Vec4& direction) const {
        return std::atan2(direction[1], inward_.dot(direction));
    }
    /// The squared sine that the side fills at an angle, and that an end's cap does.
    double disc(double angle) const {
        const double squared = std::pow(radius_ * std::cos(angle), 2);
        return squared / (over_ + squared);
    }
    static double cap_disc(const End& end, double angle) {
        const double off = std::sin(angle - end.at);
        return std::max(0.0, (end.cap.squared_sine() - off * off) / (1 - off * off));
    }
    /// @param out   squared sine off the plane
    Vec4 direction_at(double angle, double out, double u) const {
        const Vec3 inward(inward_[0], inward_[2], inward_[3]);
        int least;
        inward.cwiseAbs().minCoeff(&least);
        const Vec3 first = (Vec3::Unit(least) - inward[least] * inward).normalized();
        const double turn = 2 * pi * u, up = std::sqrt(1 - out);
        const Vec3 off = std::cos(turn) * first + std::sin(turn) * inward.cross(first);
        const Vec3 v = up * std::cos(angle) * inward + std::sqrt(out) * off;
        return {v[0], up * std::sin(angle), v[1], v[2]};
    }

    double radius_;
    Vec4 inward_;  ///< from the point to the axis, unit
    double distance_;
    std::optional<BallCap> near_;
    std::array<End, 2> ends_;
    double over_ = 0;  ///< squared distance less squared radius
    double cosines_ = 0, side_ = 0, sum_ = 0;
};

std::optional<Toward> sample(const Hypercapsule& capsule, const Vec4& origin, const Uniform3& u) {
    const CapsuleView view(capsule, origin);
    if (!view.any() || signed_distance(capsule, origin) <= 0) return {};
    const Vec4 direction = view.direction(u);
    const double density = view.density_of(direction);
    if (!(density > 0)) return {};  // by rounding, at the rim
    return Toward{direction, density};
}
double density(const Hypercapsule& capsule, const Vec4& origin, const Vec4& direction) {
    if (signed_distance(capsule, origin) <= 0) return 0;
    const CapsuleView view(capsule, origin);
    return view.any() ? view.density_of(direction) : 0;
}

}  // namespace

std::optional<Toward> sample_toward(const Shape& shape, const Vec4& origin, const Uniform3& u) {
    return std::visit([&](const auto& s) { return sample(s, origin, u); }, shape);
}

double density_toward(const Shape& shape, const Vec4& origin, const Vec4& direction) {
    return std::visit([&](const auto& s) { return density(s, origin, direction); }, shape);
}

}  // namespace tesserae::render
