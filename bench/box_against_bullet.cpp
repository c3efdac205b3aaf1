// SPDX-License-Identifier: Apache-2.0
// A box that moves in w = 0 is a 3D box: its path beside that of Bullet's, at smaller and smaller
// steps. CSV on standard output; exits with 1 if the engines differ by more than their own errors.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "bench/box_in_bullet.hpp"
#include "bench/box_in_tesserae.hpp"

namespace tesserae::bench {
namespace {

/// Coarsest to finest [1/s], each twice the one before; multiples of 20 for the samples.
constexpr int kCoarsest = 240, kFinest = 7680;

/// How much of the two engines' own errors, added up, they may differ by at the finest step. The
/// errors are estimates: exact as h goes to 0 if they are of first order and smooth, as Bullet's
/// fall is, where the quotient tends to 1. FastBodies fall somewhere within a step.
constexpr double kFactor = 1.5;
/// What rounding adds up to at most, whatever the step [m, rad]: the solver works in single
/// precision (6e-8 of a few m/s and rad/s), and the box moves and turns for seconds at such an
/// error.
constexpr double kRounding = 1e-6;

/// The largest distances over the samples.
struct Distance {
    double position = 0;  ///< [m]
    double rotation = 0;  ///< angle [rad], for small ones
};

Distance distance(const BoxPath& a, const BoxPath& b) {
    Distance d;
    for (std::size_t i = 0; i < a.size(); ++i) {
        d.position = std::max(d.position, (a[i].position - b[i].position).norm());
        d.rotation = std::max(d.rotation, (a[i].rotation - b[i].rotation).norm() / std::sqrt(2));
    }
    return d;
}

/// Where a path of first order tends to as the step goes to 0.
BoxPath extrapolated(BoxPath fine, const BoxPath& coarse) {
    for (std::size_t i = 0; i < fine.size(); ++i) {
        fine[i].position += fine[i].position - coarse[i].position;
        fine[i].rotation += fine[i].rotation - coarse[i].rotation;
    }
    return fine;
}

/// An engine's paths of one motion.
struct Engine {
    BoxPath path, coarser;
    Distance change, last_change;  ///< by halving the step, this time and the time before

    void refine(BoxPath next) {
        coarser = std::exchange(path, std::move(next));
        if (coarser.empty()) return;
        last_change = change;
        change = distance(path, coarser);
    }
    /// Of first order or higher: no larger than the last change or half of the one before.
    Distance error() const {
        return {std::max(change.position, last_change.position / 2),
                std::max(change.rotation, last_change.rotation / 2)};
    }
};

/// What remains to the exact distance at the end, or nothing.
std::string from_exact(const BoxMotion& motion, const BoxPath& path) {
    if (!motion.travel) return "";
    const double travel = (path.back().position - motion.position).norm();
    return fmt::format("{:.2e}", std::abs(travel - *motion.travel));
}

void print(const BoxMotion& motion, int steps_per_second, const Engine& ours,
           const Engine& bullet) {
    const Distance own = ours.error(), theirs = bullet.error();
    const Distance between = distance(ours.path, bullet.path);
    const Distance limit = distance(ours.path, extrapolated(bullet.path, bullet.coarser));
    double w = 0, w_turned = 0;
    for (const BoxPlace& place : ours.path) {
        w = std::max(w, place.w);
        w_turned = std::max(w_turned, place.w_turned);
    }
    fmt::print("{},{},{:.2e},{:.2e},{:.2e},{:.2e},", motion.name, steps_per_second, own.position,
               theirs.position, between.position, limit.position);
    fmt::print("{:.2e},{:.2e},{:.2e},{:.2e},", own.rotation, theirs.rotation, between.rotation,
               limit.rotation);
    fmt::print("{},{},{:.2e},{:.2e}\n", from_exact(motion, ours.path),
               from_exact(motion, bullet.path), w, w_turned);
}

/// Whether the engines agree, within a factor of their own errors.
bool agree(const BoxMotion& motion, const Engine& ours, const Engine& bullet) {
    const Distance own = ours.error(), theirs = bullet.error();
    const Distance between = distance(ours.path, bullet.path);
    const Distance allowed = {kFactor * (own.position + theirs.position) + kRounding,
                              kFactor * (own.rotation + theirs.rotation) + kRounding};
    if (between.position <= allowed.position && between.rotation <= allowed.rotation) return true;
    fmt::print(stderr, "{}: {:.2e} m and {:.2e} rad apart, allowed {:.2e} m and {:.2e} rad\n",
               motion.name, between.position, between.rotation, allowed.position, allowed.rotation);
    return false;
}

bool compare(const BoxMotion& motion) {
    Engine ours, bullet;
    for (int n = kCoarsest; n <= kFinest; n *= 2) {
        ours.refine(path_in_tesserae(motion, n));
        bullet.refine(path_in_bullet(motion, n));
        if (n > kCoarsest) print(motion, n, ours, bullet);
    }
    return agree(motion, ours, bullet);
}

bool run() {
    fmt::print(
        "motion,steps_per_second,own_error_m,bullet_error_m,distance_m,distance_extrapolated_m,"
        "own_error_rad,bullet_error_rad,distance_rad,distance_extrapolated_rad,from_exact_m,"
        "bullet_from_exact_m,w_m,w_rad\n");
    bool all_agree = true;
    for (const BoxMotion& motion : box_motions()) all_agree = compare(motion) && all_agree;
    return all_agree;
}

}  // namespace
}  // namespace tesserae::bench

int main() {
    try {
        return tesserae::bench::run() ? 0 : 1;
    } catch (const std::exception& e) {
        fmt::print(stderr, "box_against_bullet: {}\n", e.what());
        return 1;
    }
}
