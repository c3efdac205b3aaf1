// SPDX-License-Identifier: Apache-2.0
#include "scenes/carried_up.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "core/error.hpp"
#include "render/camera/camera.hpp"

namespace tesserae::scenes {
namespace {

using render::CameraDescription;

/// Sine of the angle to the pole within which a path has a passage, and of where one begins and
/// ends: 3 and 15 degrees. The nearer they are to each other the faster turns what is left.
constexpr double kNear = 0.05233595624294383, kPassage = 0.25881904510252074;
/// Sine of the angle to the pole below which a camera has no up of its own (Camera's own bound is
/// 1e-8).
constexpr double kNoUp = 1e-7;
/// Moments of a path are so near to each other that the view turns by less between them [rad]...
constexpr double kSmallTurn = 0.03;
/// ...or they have been halved this often: the view turns at once.
constexpr int kMostHalvings = 12;
/// A view that turns less than this in all is still but for rounding [rad].
constexpr double kStill = 1e-9;
/// Halvings that find where a passage begins, to the last bits of the time.
constexpr int kBoundaryHalvings = 50;

/// What a camera sees along and across: `forward`, `fourth`, orthonormal; zero where it has none.
struct View {
    Vec4 forward = Vec4::Zero(), fourth = Vec4::Zero();

    explicit View(const CameraDescription& camera) {
        const Vec4 way = camera.look_at - camera.position;
        if (!(way.stableNorm() > 0)) return;
        forward = way.stableNormalized();
        const Vec4 across = camera.fourth.stableNormalized();
        const Vec4 rest = across - across.dot(forward) * forward;
        if (rest.norm() > kNoUp) fourth = rest.normalized();
    }
    bool exists() const { return !fourth.isZero(0); }
    /// Sine of the angle between the camera's up and the plane of forward and fourth.
    double height(const CameraDescription& camera) const {
        const Vec4 up = camera.up.stableNormalized();
        return (up - up.dot(forward) * forward - up.dot(fourth) * fourth).norm();
    }
    double turn_to(const View& other) const {
        return std::hypot((other.forward - forward).norm(), (other.fourth - fourth).norm());
    }
};

/// The camera with another up, made orthogonal to its view: what is nearest to it. One that lies
/// in the view leaves the camera as it is.
CameraDescription with_up(CameraDescription camera, const Vec4& up) {
    const Vec4 own = std::exchange(camera.up, up);
    const bool is_up = View(camera).height(camera) > kNoUp;
    camera.up = is_up ? render::Camera(camera, 1, 1).up() : own;
    return camera;
}

bool is_near(const CameraDescription& camera, double sine) {
    const View view(camera);
    return view.exists() && view.height(camera) < sine;
}

/// Turned about the view: positive from up toward right.
Vec4 rolled(const CameraDescription& camera, double angle) {
    return std::cos(angle) * camera.up + std::sin(angle) * render::Camera(camera, 1, 1).right();
}

double smooth_step(double t) { return t * t * (3 - 2 * t); }

struct TimedView {
    double time;
    View view;
};

/// Adds moments after `a` to `b`, so many that the view turns little between them.
void refine(const CarriedUp::Path& path, const TimedView& a, const TimedView& b, int halvings,
            std::vector<double>& times) {
    const double time = 0.5 * (a.time + b.time);
    if (halvings < kMostHalvings && a.time < time && time < b.time &&
        a.view.turn_to(b.view) > kSmallTurn) {
        const TimedView middle = {time, View(path(time))};
        refine(path, a, middle, halvings + 1, times);
        refine(path, middle, b, halvings + 1, times);
    } else {
        times.push_back(b.time);
    }
}

/// Where between two moments the path comes within a passage's distance of the pole.
double boundary(const CarriedUp::Path& path, double outside, double inside) {
    for (int i = 0; i < kBoundaryHalvings; ++i) {
        const double middle = 0.5 * (outside + inside);
        (is_near(path(middle), kPassage) ? inside : outside) = middle;
    }
    return outside;
}

}  // namespace

CarriedUp::CarriedUp(const Path& path, std::span<const double> given) {
    if (given.empty()) return;
    first_ = given.front(), last_ = given.back();
    std::vector<double> times = {first_};
    TimedView before = {first_, View(path(first_))};
    for (const double time : given.subspan(1)) {
        const TimedView at = {time, View(path(time))};
        refine(path, before, at, 0, times);
        before = at;
    }
    for (std::size_t i = 0; i < times.size();) {
        std::size_t end = i;
        bool is_passage = false;
        for (; end < times.size() && is_near(path(times[end]), kPassage); ++end)
            is_passage = is_passage || is_near(path(times[end]), kNear);
        if (is_passage) {
            const bool enters = i > 0, leaves = end < times.size();
            std::vector<double> inside;
            if (enters) inside.push_back(boundary(path, times[i - 1], times[i]));
            inside.insert(inside.end(), times.begin() + i, times.begin() + end);
            if (leaves) inside.push_back(boundary(path, times[end], times[end - 1]));
            add(path, inside, enters, leaves);
        }
        i = std::max(end, i + 1);
    }
}

void CarriedUp::add(const Path& path, std::span<const double> times, bool enters, bool leaves) {
    Passage passage = {times.front(), times.back(), {}};
    std::vector<Moment>& moments = passage.moments;
    const double sign = passages_.empty() ? 1 : passages_.back().sign_after;
    for (const double time : times) {
        const CameraDescription camera = path(time);
        if (View(camera).exists() && (moments.empty() || !(camera == moments.back().camera)))
            moments.push_back({time, camera, 0});
    }
    if (moments.empty()) return;
    moments.front().time = passage.begin;

    // Its up at the beginning, carried back from the first moment that has one of its own.
    std::size_t own = !enters && leaves ? moments.size() - 1 : 0;
    while (own < moments.size() && !(View(moments[own].camera).height(moments[own].camera) > kNoUp))
        ++own;
    if (own == moments.size()) return;
    Vec4 up = sign * moments[own].camera.up;
    for (std::size_t i = own + 1; i-- > 0;) up = with_up(moments[i].camera, up).up;
    const Vec4 own_after = sign * moments.back().camera.up;

    for (std::size_t i = 0; i < moments.size(); ++i) {
        if (i > 0)
            moments[i].length = moments[i - 1].length +
                                View(moments[i - 1].camera).turn_to(View(moments[i].camera));
        up = (moments[i].camera = with_up(moments[i].camera, up)).up;
    }
    // A view that does not turn needs nothing carried.
    if (!(passage.turned() > kStill)) return;
    passage.sign_after = sign;
    if (leaves) {
        const render::Camera after(with_up(moments.back().camera, own_after), 1, 1);
        const render::Camera carried(moments.back().camera, 1, 1);
        const double angle =
            std::atan2(after.up().dot(carried.right()), after.up().dot(carried.up()));
        const double half_turns = std::round(angle / std::numbers::pi);
        passage.roll = angle - std::numbers::pi * half_turns;
        if (half_turns != 0) passage.sign_after = -sign;
    }
    passages_.push_back(std::move(passage));
}

Vec4 CarriedUp::at(double time, const CameraDescription& camera) const {
    time = std::clamp(time, first_, last_);
    const View view(camera);
    const auto after =
        std::upper_bound(passages_.begin(), passages_.end(), time,
                         [](double t, const Passage& passage) { return t < passage.begin; });
    if (!view.exists()) return camera.up;
    if (after == passages_.begin() || time > std::prev(after)->end) {
        const double sign = after == passages_.begin() ? 1 : std::prev(after)->sign_after;
        if (!(view.height(camera) > kNoUp)) return camera.up;
        return with_up(camera, sign * camera.up).up;
    }
    const Passage& passage = *std::prev(after);
    const Moment& before = *std::prev(
        std::upper_bound(passage.moments.begin(), passage.moments.end(), time,
                         [](double t, const Moment& moment) { return t < moment.time; }));
    const CameraDescription carried = with_up(camera, before.camera.up);
    if (passage.roll == 0) return carried.up;
    const double length = before.length + View(before.camera).turn_to(view);
    return rolled(carried, passage.roll * smooth_step(std::min(1.0, length / passage.turned())));
}

}  // namespace tesserae::scenes
