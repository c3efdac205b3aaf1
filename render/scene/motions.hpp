// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/bodies/bodies.hpp"
#include "render/picture.hpp"

namespace tesserae::render {

/// Where a moving body is at a time: as PlacedBody has it for those that stand still.
struct Pose {
    Vec4 centre;  ///< relative to the camera's place at the opening, world axes [m]
    Mat4 turn;    ///< world to body
};

/// Whether what a body of a type looks like depends on how it is turned.
bool looks_turned(const Picture& picture, std::uint32_t type);

/// How the visible bodies move while the shutter is open: evenly between the moments of
/// Picture::path, turning as Turning says. Times are since the opening [s].
class Motions {
  public:
    static constexpr std::uint32_t kStill = ~std::uint32_t{0};

    /// @param origin   of all poses: the camera's place at the opening, world [m]
    Motions(const Picture& picture, const Vec4& origin);

    bool is_empty() const { return bodies_.empty(); }
    double end() const { return ends_.empty() ? 0 : ends_.back(); }  ///< when the shutter closes
    /// Of a body: its number here, or kStill.
    std::uint32_t of(BodyId id) const { return of_.empty() ? kStill : of_[id]; }
    Pose pose(std::uint32_t motion, double time) const;

    /// A ball that holds a body all the while.
    struct Sweep {
        Vec4 centre;
        double radius;
    };
    Sweep sweep(std::uint32_t motion, double begin, double end) const;
    /// How far a body moves at most, in parts of its bounding radius.
    double most_travel() const;

  private:
    struct Body {
        double radius;
        bool is_turned;  ///< what it looks like depends on how it is turned
    };
    /// Between two moments.
    struct Part {
        Vec4 from, by;  ///< [m]
        Turning turning;
        bool turns;
    };
    struct Place {
        std::size_t part;
        double done;  ///< of it, 0 to 1
    };
    Place place(double time) const;
    const Part& part_of(std::uint32_t motion, std::size_t part) const {
        return parts_[motion * ends_.size() + part];
    }
    Vec4 centre(std::uint32_t motion, double time) const;

    std::vector<double> ends_;  ///< of the parts, ascending
    std::vector<Body> bodies_;
    std::vector<Part> parts_;        ///< by body, then in their order
    std::vector<std::uint32_t> of_;  ///< by body's number
};

}  // namespace tesserae::render
