// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/scene/intersect.hpp"

namespace tesserae::render {

/// The insides of bodies of glass. Where several overlap, the one that is declared last rules: a
/// point's medium is the glass body of the highest number that holds it, and the others' surfaces
/// are not there. A body that is not of glass is seen in any glass that holds it.
/// A ray inside a glass body leaves it before it can meet anything that does not reach into it, so
/// each has a list of the bodies that do.
class GlassBodies {
  public:
    /// No medium: empty space, index 1.
    static constexpr std::uint32_t kNone = kNoBody;

    /// @param picture, placed   must outlive it
    GlassBodies(const Picture& picture, const PlacedBodies& placed);

    bool is_empty() const { return neighbours_.empty(); }
    bool is_glass(std::uint32_t body) const { return slot_[body] != kNone; }
    double refractive_index(std::uint32_t medium) const;

    /// The bodies of glass that come this near to a point [m], last one first: what medium_at needs
    /// to know of points about it.
    std::vector<std::uint32_t> about(const Vec4& point, double reach) const;
    /// The medium at a point: the first of the bodies that holds it.
    /// @param bodies   of glass, last one first: all that can hold it
    std::uint32_t medium_at(const Vec4& point, std::span<const std::uint32_t> bodies,
                            double time = 0) const;

    struct Event {
        Hit hit;
        bool is_exit = false;  ///< out of the medium, through its own surface
    };
    /// What a ray inside the glass body `medium` meets next: a body in the glass, a glass that
    /// rules there, or the medium's own surface from inside (in closed form, whatever the
    /// intersector). No hit: it never leaves (an infinite half-space), or not before its limit.
    /// @param ray   if it is `on` the medium, it leaves by the far side
    Event next(std::uint32_t medium, Ray ray, FrameStats& stats) const;

    /// Where a ray goes into several bodies of glass in one place, the hit on the one that rules
    /// there; other hits stay as they are.
    Hit ruling(const Hit& hit, const Ray& ray) const {
        return is_empty() ? hit : ruling_of_all(hit, ray);
    }

    /// Where a ray that leaves a glass body outward begins, so that it is clear of others whose
    /// surfaces lie in the same place: a ray is `on` one body only. Else the point itself.
    Vec4 start_outside(std::uint32_t body, Vec4 point, const Vec4& direction,
                       double time = 0) const;

    /// The medium just outside a glass body, at a point of its surface.
    std::uint32_t medium_beyond(std::uint32_t body, const Vec4& point, double time = 0) const;

    /// The last of the bodies of glass that come after a glass body and hold all of it, so that it
    /// is not seen; kNone if there is none.
    std::uint32_t hidden_in(std::uint32_t body) const;

  private:
    Hit ruling_of_all(const Hit& hit, const Ray& ray) const;
    double scale(std::uint32_t body, const Vec4& point) const;
    double depth(std::uint32_t body, const Vec4& point, double time) const;
    double distance_from(const PlacedBody& body, const Vec4& point) const;
    bool reach_each_other(std::uint32_t a, std::uint32_t b) const;
    void find_neighbours();

    const Picture& picture_;
    const PlacedBodies& placed_;
    std::vector<std::uint32_t> slot_;  ///< by body: which list is its own, or kNone
    std::vector<std::vector<std::uint32_t>> neighbours_;  ///< ascending
};

}  // namespace tesserae::render
