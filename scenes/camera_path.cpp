// SPDX-License-Identifier: Apache-2.0
#include "scenes/camera_path.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/error.hpp"
#include "scenes/load/effective.hpp"

namespace tesserae::scenes {

/// Points and numbers: straight lines.
struct CameraPath::Flat {
    template <class T>
    static T way(const T& from, const T& to) {
        return to - from;
    }
    template <class T>
    static T moved(const T& from, const T& way) {
        return from + way;
    }
};

/// Unit vectors: great arcs.
struct CameraPath::Sphere {
    /// The tangent at `from` that points to `to`, as long as the arc.
    static Vec4 way(const Vec4& from, const Vec4& to) {
        const Vec4 across = to - from.dot(to) * from;
        const double sine = across.norm();
        if (sine == 0) return Vec4::Zero();
        return std::atan2(sine, from.dot(to)) / sine * across;
    }
    static Vec4 moved(const Vec4& from, const Vec4& way) {
        const double arc = way.norm();
        if (arc == 0) return from;
        return (std::cos(arc) * from + std::sin(arc) / arc * way).normalized();
    }
};

namespace {

bool is_zero(double v) { return v == 0; }
bool is_zero(const Vec4& v) { return v.isZero(0); }

}  // namespace

template <class T>
CameraPath::Knots<T> CameraPath::knots_of(std::span<const CameraKey> keys,
                                          std::optional<T> CameraKey::*part) {
    Knots<T> knots;
    for (const CameraKey& key : keys)
        if (key.*part) knots.push_back({key.time, *(key.*part)});
    return knots;
}

/// Change per second at knot i, as the segment between it and its neighbour has it.
template <class Space, class T>
T CameraPath::slope(const Knots<T>& knots, std::size_t i, std::size_t neighbour) {
    const auto rate = [&](std::size_t to) -> T {
        return Space::way(knots[i].value, knots[to].value) / (knots[to].time - knots[i].time);
    };
    if (knots[i].slope) return is_zero(rate(neighbour)) ? T(0 * *knots[i].slope) : *knots[i].slope;
    if (i == 0) return rate(1);
    if (i + 1 == knots.size()) return rate(i - 1);
    const T before = rate(i - 1), after = rate(i + 1);
    if (is_zero(before) || is_zero(after)) return T(0 * before);
    const double h0 = knots[i].time - knots[i - 1].time, h1 = knots[i + 1].time - knots[i].time;
    return (h1 * before + h0 * after) / (h0 + h1);
}

template <class Space, class T>
T CameraPath::value_at(const Knots<T>& knots, const T& still, double time) {
    if (knots.empty()) return still;
    const auto next = std::upper_bound(knots.begin(), knots.end(), time,
                                       [](double t, const Knot<T>& k) { return t < k.time; });
    if (next == knots.begin()) return knots.front().value;
    if (next == knots.end()) return knots.back().value;
    const auto i = static_cast<std::size_t>(next - knots.begin()) - 1;
    const Knot<T>&from = knots[i], &to = knots[i + 1];
    const double h = to.time - from.time, t = (time - from.time) / h;
    T points[] = {from.value, Space::moved(from.value, T(h / 3 * slope<Space>(knots, i, i + 1))),
                  Space::moved(to.value, T(-h / 3 * slope<Space>(knots, i + 1, i))), to.value};
    for (int count = 3; count > 0; --count)
        for (int k = 0; k < count; ++k)
            points[k] = Space::moved(points[k], T(t * Space::way(points[k], points[k + 1])));
    return points[0];
}

template <class T>
void CameraPath::close(Knots<T>& knots) const {
    if (knots.empty()) return;
    // Two more on either side have the slopes between them as if there were no end.
    constexpr int kMore = 2;
    // The last key is the first again.
    if (knots.size() > 1 && knots.back().time - knots.front().time == period_) {
        if (!knots.front().slope) knots.front().slope = knots.back().slope;
        knots.pop_back();
    }
    const auto count = static_cast<int>(knots.size());
    Knots<T> all;
    for (int i = -kMore; i < count + kMore; ++i) {
        const int round = i < 0 ? (i + 1) / count - 1 : i / count;
        Knot<T> knot = knots[static_cast<std::size_t>(i - round * count)];
        knot.time += round * period_;
        all.push_back(knot);
    }
    knots = std::move(all);
}

double CameraPath::wrapped(double time) const {
    if (period_ == 0 || (time >= first_ && time <= first_ + period_)) return time;
    const double rest = std::fmod(time - first_, period_);
    return first_ + (rest < 0 ? rest + period_ : rest);
}

CameraPath::CameraPath(const render::CameraDescription& still, std::span<const CameraKey> keys,
                       bool closed)
    : still_(still),
      look_at_(knots_of(keys, &CameraKey::look_at)),
      up_(knots_of(keys, &CameraKey::up)),
      fourth_(knots_of(keys, &CameraKey::fourth)),
      field_of_view_(knots_of(keys, &CameraKey::field_of_view)) {
    add_positions(keys);
    if (closed && !keys.empty()) {
        first_ = keys.front().time, period_ = keys.back().time - first_;
        for (Knots<Vec4>* const knots : {&position_, &look_at_, &up_, &fourth_}) close(*knots);
        close(field_of_view_);
    }
    carried_up_ = CarriedUp([this](double time) { return keyed_at(time); }, moments(keys));
}

void CameraPath::add_positions(std::span<const CameraKey> keys) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const CameraKey& key = keys[i];
        if (key.position) position_.push_back({key.time, *key.position});
        if (!key.orbit) continue;
        // Where the key before left the camera.
        const double begin = i > 0 ? keys[i - 1].time : 0;
        if (position_.empty() || position_.back().time < begin)
            position_.push_back(
                {begin, position_.empty() ? still_.position : position_.back().value});
        const CameraArc arc = {begin, key.time, position_.back().value, *key.orbit, key.ease};
        position_.back().slope = arc.velocity(begin);
        position_.push_back({key.time, arc.at(key.time), arc.velocity(key.time)});
        arcs_.push_back(arc);
    }
}

Vec4 CameraPath::position_at(double time) const {
    const auto next =
        std::upper_bound(arcs_.begin(), arcs_.end(), time,
                         [](double t, const CameraArc& arc) { return t < arc.begin; });
    if (next != arcs_.begin() && time < std::prev(next)->end) return std::prev(next)->at(time);
    return value_at<Flat>(position_, still_.position, time);
}

std::vector<double> CameraPath::moments(std::span<const CameraKey> keys) const {
    // Parts of a segment: a cubic does not go round in one, an orbit not in this angle [degrees].
    constexpr double kParts = 16, kAngle = 10;
    if (std::max({position_.size(), look_at_.size(), up_.size(), fourth_.size()}) < 2) return {};
    std::vector<double> ends;
    if (keys.front().orbit) ends.push_back(0);
    for (const CameraKey& key : keys) ends.push_back(key.time);
    std::vector<double> times = {ends.front()};
    for (std::size_t i = 1; i < ends.size(); ++i) {
        const CameraKey& key = keys[i + keys.size() - ends.size()];
        const double begin = times.back(), angle = key.orbit ? std::abs(key.orbit->angle) : 0;
        const double parts = std::max(kParts, std::ceil(angle / kAngle));
        for (double part = 1; part < parts; ++part)
            times.push_back(begin + part / parts * (key.time - begin));
        times.push_back(key.time);
    }
    return times;
}

render::CameraDescription CameraPath::at(double time) const {
    time = wrapped(time);
    render::CameraDescription camera = keyed_at(time);
    if (!carried_up_.is_empty()) camera.up = carried_up_.at(time, camera);
    return camera;
}

render::CameraDescription CameraPath::keyed_at(double time) const {
    render::CameraDescription camera = still_;
    camera.position = position_at(time);
    camera.look_at = value_at<Flat>(look_at_, still_.look_at, time);
    camera.up = value_at<Sphere>(up_, still_.up, time);
    camera.fourth = value_at<Sphere>(fourth_, still_.fourth, time);
    camera.field_of_view = value_at<Flat>(field_of_view_, still_.field_of_view, time);
    return camera;
}

namespace {

/// What the last key must say as the first does is as near to it as this, relative.
constexpr double kSameEnd = 1e-9;

bool ends_alike(const Vec4& a, const Vec4& b) {
    return (a - b).norm() <= kSameEnd * (1 + a.norm());
}
bool ends_alike(double a, double b) { return std::abs(a - b) <= kSameEnd * (1 + std::abs(a)); }

template <class T>
std::string difference_of_ends(const char* part, const std::optional<T>& first,
                               const std::optional<T>& last) {
    if (!first || !last || ends_alike(*first, *last)) return {};
    return fmt::format(
        "the path ends with the {0} {1} and begins with {2}; expected a last [[camera.key]] that "
        "has the {0} of the first",
        part, toml_text(*last), toml_text(*first));
}

}  // namespace

std::string open_ends(const render::CameraDescription& still, std::span<const CameraKey> keys) {
    if (keys.size() < 2)
        return "the path goes through its keys and back to the first; expected two [[camera.key]] "
               "or more, the last as the first";
    const CameraKey &first = keys.front(), &last = keys.back();
    if (first.orbit)
        return "the first [[camera.key]] is an orbit; expected one with the position where the "
               "path begins and ends";
    std::optional<Vec4> end = last.position;
    if (last.orbit) end = CameraPath(still, keys).at(last.time).position;
    for (const std::string& what :
         {difference_of_ends("position", first.position, end),
          difference_of_ends("look_at", first.look_at, last.look_at),
          difference_of_ends("up", first.up, last.up),
          difference_of_ends("fourth", first.fourth, last.fourth),
          difference_of_ends("field_of_view", first.field_of_view, last.field_of_view)})
        if (!what.empty()) return what;
    return {};
}

}  // namespace tesserae::scenes
