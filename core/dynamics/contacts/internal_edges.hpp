// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/contacts/chunked_list.hpp"
#include "core/dynamics/contacts/edge_judge.hpp"
#include "core/dynamics/step/schedule.hpp"

namespace tesserae {

/// Corrects contacts at internal edges, the last part of the narrow phase: bodies slide over faces
/// that lie in one plane as over one face.
///
/// The narrow phase looks at two bodies at a time. A box that has sunk a little into a tile
/// overlaps the next tile's side by less than its top, and a ball is nearer to that tile's edge
/// than to the plane of its top. Such contacts push along the floor. This class finds the bodies
/// for which EdgeJudge has to look at all that they meet.
class InternalEdges {
  public:
    /// Corrects step.contacts.
    void correct(const Simulation& simulation, StepData& step, Schedule& schedule);

  private:
    template <class Choose>
    void list_meetings(const StepData& step, Schedule& schedule, const Choose& choose);
    void replace(StepData& step);

    ChunkedList<Meeting> lists_;
    std::vector<Meeting> meetings_;        ///< ascending (body, begin)
    std::vector<std::uint8_t> is_marked_;  ///< of every body: EdgeJudge has to look at it
    EdgeJudge judge_;
    std::vector<ContactList::Replacement> replacements_;
};

}  // namespace tesserae
