// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "render/scene/body_tree.hpp"

namespace tesserae::render {

/// Up to sixteen rays on their way through a BodyTree side by side. A single ray's next test hangs
/// on the outcome of its last one, and half of its time goes into branches that no CPU foretells.
/// Here the nodes of many rays wait in one list: their tests hang on nothing, and what they find is
/// appended to the next list without a branch. It names the bodies that for_each_on_ray names and,
/// as nodes come in no order and limits into force late, some more.
class RayStream {
  public:
    static constexpr std::uint32_t kMost = 16;  ///< rays
    /// Leaves tested in one go, and so many at least are found before: fewer would find bodies, and
    /// so limits, sooner, but at half as many short loops cost a twentieth of the time.
    static constexpr std::uint32_t kLeaves = 128;
    static constexpr std::size_t kMostAtOnce = std::size_t{kLeaves} * kLanes;  ///< candidates

    /// A body that a ray may meet.
    class Candidate {
      public:
        std::uint32_t ray() const { return packed_ % kMost; }
        std::uint32_t body() const { return packed_ / kMost; }

      private:
        std::uint32_t packed_;
    };

    /// @param tree   must outlive it
    explicit RayStream(const BodyTree& tree) : tree_(tree) {}

    /// The next ray, numbered from 0; before the first call of `next`, and at most kMost.
    /// Bodies beyond its limit are left out where that is cheap; the one that it is `on` is not.
    void add(const Ray& ray) {
        lines_[size_] = BodyTree::line_of(ray);
        waiting_[size_] = size_;  // at the root
        ++size_;
    }
    /// Lowers a ray's limit.
    void shorten(std::uint32_t ray, double limit) {
        lines_[ray].limit = BodyTree::rounded_up(limit);
    }

    /// More bounded bodies that rays may meet, valid until the next call; none at the end. Every
    /// pair comes at most once.
    std::span<const Candidate> next();

  private:
    /// Nodes tested in one go, at most: four of each ray.
    static constexpr std::uint32_t kTogether = 64;

    struct Range {
        std::uint32_t begin, end;
    };

    void find_leaves();
    std::size_t test_leaves();

    const BodyTree& tree_;
    std::uint32_t size_ = 0;
    std::array<BodyTree::Line, kMost> lines_;

    // Lists of index * kMost + ray, with room to append eight at once.
    /// Nodes not yet tested, by level: what the last go found there, less what went on from there.
    std::array<std::uint32_t, kMost + kTogether * kLanes * BodyTree::kLevels + kLanes> waiting_;
    std::array<Range, BodyTree::kLevels + 1> ranges_;
    std::uint32_t range_count_ = 0;
    bool has_begun_ = false;
    std::array<std::uint32_t, kLeaves + kTogether * kLanes + kLanes> leaves_;
    std::uint32_t leaf_begin_ = 0, leaf_end_ = 0;
    std::array<Candidate, kMostAtOnce + kLanes> candidates_;
};

}  // namespace tesserae::render
