// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/weld_loops.hpp"

#include <utility>

namespace tesserae::scenes {

std::size_t WeldLoops::node_of(BodyId id) {
    const bool is_held = id == kWorld || !bodies_.is_movable(id);
    return is_held ? bodies_.size() : std::size_t{id};
}

std::optional<std::size_t> WeldLoops::add(const Joint& joint, std::size_t number) {
    while (nodes_.size() <= bodies_.size()) nodes_.push_back({nodes_.size()});
    // The ways to the roots stay as they were made: a node's weld is newer than those below it. So
    // the ways of a and b are gone up in the order of the welds, and where they meet the last one
    // is that which joined the groups of both: it is part of the loop.
    std::size_t a = node_of(joint.a), b = node_of(joint.b), last = kNoWeld;
    while (a != b) {
        std::size_t& older = nodes_[a].weld < nodes_[b].weld ? a : b;
        if (nodes_[older].weld == kNoWeld) break;  // two roots
        last = nodes_[older].weld;
        older = nodes_[older].parent;
    }
    if (a == b) return last;
    if (nodes_[a].size < nodes_[b].size) std::swap(a, b);
    nodes_[b].parent = a;
    nodes_[b].weld = number;
    nodes_[a].size += nodes_[b].size;
    return {};
}

}  // namespace tesserae::scenes
