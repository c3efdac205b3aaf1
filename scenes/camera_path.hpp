// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/description.hpp"
#include "scenes/camera_orbit.hpp"
#include "scenes/carried_up.hpp"

namespace tesserae::scenes {

/// What a [[camera.key]] says: parts of the view at a time.
struct CameraKey {
    double time = 0;  ///< [s]
    std::optional<Vec4> position, look_at;
    std::optional<Vec4> up, fourth;  ///< unit; no two that follow each other are opposite
    std::optional<double> field_of_view;
    std::optional<CameraOrbit> orbit;  ///< instead of a position: how it comes from the key before
    Ease ease = Ease::kLinear;         ///< how the orbit goes through its time
};

/// The camera at any time: each part goes smoothly through the keys that name it (ascending in
/// time), stands still between equal ones and before the first and after the last, and stays as in
/// `still` where none does. A part with two keys moves evenly. Directions turn on the sphere.
///
/// Cubic Bezier arcs whose slopes at a key are those of the parabola through it and its neighbours
/// (Catmull-Rom for uneven times), by de Casteljau's construction, which on the sphere takes great
/// arcs for segments (Shoemake 1985). An orbit is a circle instead; what meets it has its slope.
/// Where the view comes near to looking along `up`, see CarriedUp.
class CameraPath {
  public:
    /// @param closed   the path goes on round: after the last key, which must be as the first is
    ///                 (see open_ends()), comes the first, and each part goes smoothly through it
    CameraPath(const render::CameraDescription& still, std::span<const CameraKey> keys,
               bool closed = false);

    /// In a time that grows with the logarithm of the number of keys.
    /// @param time   [s]
    render::CameraDescription at(double time) const;

  private:
    template <class T>
    struct Knot {
        double time;
        T value;
        std::optional<T> slope = {};  ///< of the orbit that begins or ends here
    };
    /// The keys that name a part.
    template <class T>
    using Knots = std::vector<Knot<T>>;
    struct Flat;
    struct Sphere;

    template <class T>
    static Knots<T> knots_of(std::span<const CameraKey> keys, std::optional<T> CameraKey::*part);
    template <class Space, class T>
    static T slope(const Knots<T>& knots, std::size_t i, std::size_t neighbour);
    template <class Space, class T>
    static T value_at(const Knots<T>& knots, const T& still, double time);

    void add_positions(std::span<const CameraKey> keys);
    /// Repeats knots before the first key and after the last.
    template <class T>
    void close(Knots<T>& knots) const;
    /// A time between the first key and the last.
    double wrapped(double time) const;
    Vec4 position_at(double time) const;
    /// As the keys say, without the law of CarriedUp.
    render::CameraDescription keyed_at(double time) const;
    /// Those of the keys, and between them so many that no spline or orbit goes round unseen; none
    /// if the view does not turn.
    std::vector<double> moments(std::span<const CameraKey> keys) const;

    render::CameraDescription still_;
    Knots<Vec4> position_, look_at_, up_, fourth_;
    Knots<double> field_of_view_;
    std::vector<CameraArc> arcs_;    ///< ascending in time
    double first_ = 0, period_ = 0;  ///< of a closed path, else 0 [s]
    CarriedUp carried_up_;
};

/// What keeps a path through these keys from being closed, in words; empty: nothing.
std::string open_ends(const render::CameraDescription& still, std::span<const CameraKey> keys);

}  // namespace tesserae::scenes
