// SPDX-License-Identifier: Apache-2.0
#include "core/contact/box_distance.hpp"

#include <cmath>

namespace tesserae {
namespace {

using Real = long double;
using Wide = Eigen::Matrix<Real, 4, 1>;

/// Closer than this the boxes touch: the direction of b - a is then rounding, and the separating
/// axis takes its place. Also how far rounding may take a distance from the gap of its axis.
constexpr double kTouching = 1e-13;

/// Freeing a coordinate must turn b - a by more than this [rad], plus what rounding turns it by.
constexpr Real kTurn = 1e-17L, kRounding = 1e-19L;

/// Each step frees or fixes one of eight coordinates and shortens b - a; ten are usual, and the
/// bound only stops a cycle of steps that are zero by rounding, where any is as good.
constexpr int kMostSteps = 1000;

/// Unit vectors orthogonal to each other that span those added.
struct Basis {
    std::array<Wide, 4> unit;
    int count = 0;

    Wide remove_from(Wide v) const {
        for (int i = 0; i < count; ++i) v -= unit[i].dot(v) * unit[i];
        return v;
    }
};

/// b - a as a function of eight coordinates: those of a's point, then those of b's.
class ClosestOffset {
  public:
    ClosestOffset(const BoxPair& pair, const Vec4& start) : offset_(pair.offset.cast<Real>()) {
        for (int i = 0; i < 4; ++i) {
            motion_[i] = -Wide::Unit(i);
            motion_[4 + i] = pair.rotation.col(i).cast<Real>();
            limit_[i] = pair.half_a[i];
            limit_[4 + i] = pair.half_b[i];
            side_[i] = side_of(start[i]);
            side_[4 + i] = static_cast<signed char>(-side_of(start.dot(pair.rotation.col(i))));
        }
        for (int v = 0; v < 8; ++v) t_[v] = side_[v] * limit_[v];
        update_between();
    }

    void solve() {
        for (int step = 0; step < kMostSteps && free_count_ < 4; ++step) {
            const int entering = steepest();
            if (entering < 0) return;
            side_[entering] = 0;
            free_[free_count_++] = entering;
            for (bool moved = false; !moved && free_count_ > 0 && step < kMostSteps;) {
                moved = move_free();
                if (!moved) ++step;
            }
        }
    }

    BoxWitness witness() const {
        BoxWitness w;
        w.distance = static_cast<double>(between_.norm());
        if (w.distance > 0) w.normal = direction().cast<double>();
        for (int i = 0; i < 4; ++i) {
            w.on_a[i] = static_cast<double>(t_[i]);
            w.on_b[i] = static_cast<double>(t_[4 + i]);
            w.face_a[i] = side_[i];
            w.face_b[i] = side_[4 + i];
        }
        return w;
    }

  private:
    void update_between() {
        between_ = offset_;
        for (int v = 0; v < 8; ++v) between_ += t_[v] * motion_[v];
    }

    /// What the free coordinates span; factors(k, i) are free motion k's components in it.
    Basis span(Real (&factors)[4][4]) const {
        Basis basis;
        for (int k = 0; k < free_count_; ++k) {
            Wide rest = motion_[free_[k]];
            for (int i = 0; i < k; ++i) {
                factors[k][i] = basis.unit[i].dot(rest);
                rest -= factors[k][i] * basis.unit[i];
            }
            factors[k][k] = rest.norm();
            basis.unit[basis.count++] = rest / factors[k][k];
        }
        return basis;
    }

    /// b - a made unit; twice orthogonal to what is free, since the first time only makes it so
    /// relative to the size of the boxes.
    Wide direction() const {
        Real factors[4][4];
        const Basis basis = span(factors);
        const Wide once = basis.remove_from(between_.normalized()).normalized();
        return basis.remove_from(once).normalized();
    }

    /// The fixed coordinate along which b - a shortens fastest when freed, or -1.
    int steepest() const {
        const Real length = between_.norm();
        if (!(length > 0)) return -1;
        const Wide unit = direction();
        Real best = kTurn + kRounding / length;
        int entering = -1;
        for (int v = 0; v < 8; ++v) {
            const Real slope = side_[v] * motion_[v].dot(unit);
            if (slope > best) best = slope, entering = v;
        }
        return entering;
    }

    /// Moves the free coordinates to where b - a is shortest, or until one of them reaches its
    /// limit, which fixes it. Returns whether they arrived.
    bool move_free() {
        Real factors[4][4], change[4];
        const Basis basis = span(factors);
        for (int k = free_count_ - 1; k >= 0; --k) {
            Real component = -basis.unit[k].dot(between_);
            for (int later = k + 1; later < free_count_; ++later)
                component -= factors[later][k] * change[later];
            change[k] = component / factors[k][k];
        }
        Real fraction = 1;
        int blocking = -1;
        for (int k = 0; k < free_count_; ++k) {
            const int v = free_[k];
            const Real bound = change[k] < 0 ? -limit_[v] : limit_[v];
            if (std::abs(t_[v] + change[k]) <= limit_[v] || change[k] == 0) continue;
            const Real until = std::max(Real(0), (bound - t_[v]) / change[k]);
            if (until < fraction) fraction = until, blocking = k;
        }
        for (int k = 0; k < free_count_; ++k) {
            const int v = free_[k];
            t_[v] = std::clamp(t_[v] + fraction * change[k], -limit_[v], limit_[v]);
        }
        if (blocking >= 0) {
            const int v = free_[blocking];
            side_[v] = change[blocking] < 0 ? -1 : 1;
            t_[v] = side_[v] * limit_[v];
            for (int k = blocking; k + 1 < free_count_; ++k) free_[k] = free_[k + 1];
            --free_count_;
        }
        update_between();
        return blocking < 0;
    }

    Wide offset_, between_;
    std::array<Wide, 8> motion_;  ///< of b - a, per coordinate
    std::array<Real, 8> limit_, t_;
    std::array<signed char, 8> side_;  ///< limit that the coordinate is at, 0 if free
    std::array<int, 4> free_{};
    int free_count_ = 0;
};

}  // namespace

BoxWitness closest_points(const BoxPair& pair, const Vec4& normal) {
    ClosestOffset closest(pair, normal);
    closest.solve();
    return closest.witness();
}

BoxSeparation separation_of(const BoxPair& pair, const SeparatingAxes& axes) {
    BoxSeparation s;
    s.value = axes.gap();
    if (s.value <= 0) return s;
    const Vec4 normal = best_normal(pair, axes);
    s.witness = closest_points(pair, normal);
    if (s.witness.distance <= kTouching) s.witness.normal = normal;
    s.is_axis = s.witness.spans_axis() && s.witness.distance <= s.value + kTouching;
    if (!s.is_axis) s.value = s.witness.distance;
    return s;
}

}  // namespace tesserae
