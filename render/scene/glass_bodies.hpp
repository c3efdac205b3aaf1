#pragma once

#include <cstdint>
#include <vector>

#include "render/scene/intersect.hpp"

namespace tesserae::render {

/// The insides of bodies of glass. Where several overlap, the one with the lowest number rules: a
/// point's medium is the lowest glass body that holds it, and the others' surfaces are not there.
/// A ray inside a glass body leaves it before it can meet anything that does not reach into it, so
/// each has a list of the bodies that do.
class GlassBodies {
  public:
    /// No medium: empty space, index 1.
    static constexpr std::uint32_t kNone = kNoBody;

    /// @param picture, placed   must outlive it
    GlassBodies(const Picture& picture, const PlacedBodies& placed);

    double refractive_index(std::uint32_t medium) const;

    struct Event {
        Hit hit;
        bool is_exit = false;  ///< out of the medium, through its own surface
    };
    /// What a ray inside the glass body `medium` meets next: a body in the glass, a glass that
    /// rules there, or the medium's own surface from inside (in closed form, whatever the
    /// intersector). No hit: it never leaves (an infinite half-space).
    /// @param ray   its limit does not count; if it is `on` the medium, it leaves by the far side
    Event next(std::uint32_t medium, Ray ray, FrameStats& stats) const;

    /// The medium just outside a glass body, at a point of its surface.
    std::uint32_t medium_beyond(std::uint32_t body, const Vec4& point) const;

  private:
    bool is_glass(std::uint32_t body) const { return slot_[body] != kNone; }
    bool reach_each_other(std::uint32_t a, std::uint32_t b) const;
    void find_neighbours();

    const Picture& picture_;
    const PlacedBodies& placed_;
    std::vector<std::uint32_t> slot_;  ///< by body: which list is its own, or kNone
    std::vector<std::vector<std::uint32_t>> neighbours_;  ///< ascending
};

}  // namespace tesserae::render
