// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// All contacts of a body with one other body: [begin, end) of the list.
struct Meeting {
    BodyId body, other;
    std::uint32_t begin, end;
    bool may_be_internal_edge = false;  ///< see the function of this name
};

/// Returns whether a meeting may be an internal edge as far as its two bodies show: its points do
/// not all lie straight over one face of the other body, or they do, but all near one of its rims.
bool may_be_internal_edge(const Simulation& simulation, const StepData& step,
                          const Meeting& meeting);

/// Returns whether may_be_internal_edge() stays false while the two bodies move by kKeptMotion
/// relative to each other.
/// @param shape    the other body's shape; its outward `normal` and all `points` are in its own
///                 frame
bool is_never_internal_edge(const Shape& shape, const Vec4& normal, std::span<const Vec4> points,
                            const TypeProperties& body);

/// The replacement of contacts [begin, end) of the list by [first, last) of EdgeJudge::contacts.
struct EdgeCorrection {
    std::uint32_t begin, end;
    std::uint32_t first, last;
    double cosine;  ///< of the greatest angle by which a normal is turned
};

/// Finds and corrects the internal edges of one body from all that it meets. The bodies on whose
/// faces it lies are its ground.
///
/// - If faces of the ground lie in one plane and do not move, the body gets the contacts that it
///   would have with a hyperplane there. Each is with the body under it, if each of them has one.
/// - Otherwise a meeting is an internal edge if all its points are on or under the plane of the
///   ground's face but push in another direction: lifted out of the ground, the body would not
///   touch there. Its points are replaced by those over the other body's own face along the plane,
///   or over a face that rises from the plane there, as a fixed floor rises from a ramp; without
///   such a face they are dropped. Only ground whose own meeting is no internal edge counts, so
///   that no body loses all contacts.
class EdgeJudge {
  public:
    std::vector<EdgeCorrection> corrections;
    std::vector<Contact> contacts;

    void clear();
    /// Appends the corrections of one body's contacts.
    /// @param meetings   all meetings of the body, ascending
    void judge(const Simulation& simulation, const StepData& step,
               std::span<const Meeting> meetings);

  private:
    struct Ground {
        const Meeting* meeting;
        Face face;              ///< world
        bool is_internal_edge;  ///< as other ground shows
    };
    struct Floor {
        const Meeting* meeting;
        Face face;
        std::uint32_t points;  ///< bit i: it is under the i-th of on_plane_
    };

    void find_ground(const Simulation& simulation, const StepData& step,
                     std::span<const Meeting> meetings);
    bool is_joined(const Meeting& meeting) const;
    void find_floor(const Face& face, const Simulation& simulation, const StepData& step,
                    std::span<const Meeting> meetings);
    void join_floor(const Face& face, const Simulation& simulation, const StepData& step,
                    std::span<const Meeting> meetings);
    void stand_on(const Floor& floor, const Simulation& simulation, const StepData& step);
    void correct_edge(const Face& ground, const Simulation& simulation, const StepData& step,
                      const Meeting& meeting);
    void rise_on(const Face& face, const Simulation& simulation, const StepData& step,
                 const Meeting& meeting);
    void find_on_plane(const Face& face, const Simulation& simulation, const StepData& step,
                       BodyId body, BodyId ground, double margin);
    void finish(const Meeting& meeting, std::uint32_t first, double cosine);

    std::vector<Ground> grounds_;
    std::vector<Floor> floor_;
    std::vector<const Meeting*> joined_;
    std::vector<Contact> on_plane_;
};

}  // namespace tesserae
