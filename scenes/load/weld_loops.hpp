// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "core/dynamics/constraints/joint.hpp"

namespace tesserae::scenes {

/// Finds chains of welds that close on themselves: nothing says which of them bears the load. The
/// world and all bodies that never move count as one body.
class WeldLoops {
  public:
    explicit WeldLoops(const Bodies& bodies) : bodies_(bodies) {}

    /// Adds a weld.
    /// @param number   of the weld, higher than those before
    /// @return the number of another weld of the loop that this one closes, if it closes one
    std::optional<std::size_t> add(const Joint& joint, std::size_t number);

  private:
    static constexpr std::size_t kNoWeld = std::numeric_limits<std::size_t>::max();
    /// Nodes that welds connect make a tree, whose height grows with the logarithm of its size.
    struct Node {
        std::size_t parent;          ///< of a root, itself
        std::size_t weld = kNoWeld;  ///< that tied its tree to its parent's
        std::size_t size = 1;        ///< of its tree, while it was a root
    };

    std::size_t node_of(BodyId id);

    const Bodies& bodies_;
    std::vector<Node> nodes_;  ///< by BodyId, then one for all that never moves
};

}  // namespace tesserae::scenes
