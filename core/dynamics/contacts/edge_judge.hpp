#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// All contacts of a body with one other: [begin, end) of the list.
struct Meeting {
    BodyId body, other;
    std::uint32_t begin, end;
    bool may_be_internal_edge = false;  ///< as the function says
};

/// Whether the two bodies alone leave it open that the meeting is an internal edge: its points do
/// not lie straight over one face of the other body, or they do and all near one of its rims.
bool may_be_internal_edge(const Simulation& simulation, const StepData& step,
                          const Meeting& meeting);

/// Whether that stays false while the two bodies move by kKeptMotion against each other.
/// @param shape    the other body's; it has `normal`, out of it, and `points`, all of them, in its
///                 own frame
bool is_never_internal_edge(const Shape& shape, const Vec4& normal, std::span<const Vec4> points,
                            const TypeProperties& body);

/// Contacts [begin, end) of the list give way to [first, last) of EdgeJudge::contacts.
struct EdgeCorrection {
    std::uint32_t begin, end;
    std::uint32_t first, last;
    double cosine;  ///< of the angle by which the normal is turned, at most
};

/// Sees a body with all that it meets. What it lies on, on a face, is its ground.
///
/// - Faces of the ground in one plane that do not move: the body has the contacts that it would
///   have with a hyperplane there, each with the body under it, if there is one under all of them.
/// - Otherwise a meeting is an internal edge if all its points are on or under the plane of the
/// ground's
///   face, but push another way: lifted out of the ground, the body would not touch there. It is
///   given the points over the other body's own face along the plane, or over one that rises from
///   the plane there as a floor that does not move does from a ramp, if there is one, else none.
///   Only ground whose own meeting is no internal edge tells so: no body is left without.
class EdgeJudge {
  public:
    std::vector<EdgeCorrection> corrections;
    std::vector<Contact> contacts;

    void clear();
    /// Appends the corrections of one body's contacts.
    /// @param meetings   all that it has, ascending
    void judge(const Simulation& simulation, const StepData& step,
               std::span<const Meeting> meetings);

  private:
    struct Ground {
        const Meeting* meeting;
        Face face;              ///< world
        bool is_internal_edge;  ///< as other ground tells
    };
    struct Floor {
        const Meeting* meeting;
        Face face;
        std::uint32_t points;  ///< bit i: of on_plane_ it is under the i-th
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
