// SPDX-License-Identifier: Apache-2.0
#include "render/scene/ray_stream.hpp"

#include <algorithm>
#include <bit>

namespace tesserae::render {
namespace {

/// index * kMost + ray, for eight of them.
simd::Unsigned8 packed(const std::array<std::uint32_t, kLanes>& indices, std::uint32_t ray) {
    simd::Unsigned8 numbers;
    std::memcpy(&numbers, indices.data(), sizeof numbers);
    return numbers * RayStream::kMost + ray;
}

std::uint32_t bit_count(std::uint32_t bits) {
    return static_cast<std::uint32_t>(std::popcount(bits));
}

}  // namespace

std::span<const RayStream::Candidate> RayStream::next() {
    if (!has_begun_ && size_ > 0 && !tree_.nodes_.empty()) {
        ranges_[0] = {0, size_};
        range_count_ = 1;
    }
    has_begun_ = true;
    std::size_t count = 0;
    while (count == 0) {
        if (leaf_begin_ == leaf_end_) {
            if (range_count_ == 0) return {};
            find_leaves();
        }
        count = test_leaves();
    }
    return {candidates_.data(), count};
}

/// Goes down from the lowest level that has nodes.
void RayStream::find_leaves() {
    std::uint32_t leaf_count = 0;
    do {
        Range& range = ranges_[range_count_ - 1];
        const std::uint32_t begin = range.begin, end = range.end;
        const std::uint32_t first = end - std::min(end - begin, kTogether);
        range.end = first;
        if (first == begin) --range_count_;

        std::uint32_t last = end;
        for (std::uint32_t i = first; i < end; ++i) {
            const std::uint32_t number = waiting_[i] % kMost;
            const BodyTree::Node& node = tree_.nodes_[waiting_[i] / kMost];
            Float8 enter;
            const std::uint32_t met = BodyTree::boxes_met(node.boxes, lines_[number], enter);
            const simd::Unsigned8 children = packed(node.child, number);
            const std::uint32_t nodes = met & ~node.leaves, leaves = met & node.leaves;
            store_set(&children, nodes, &waiting_[last]);
            last += bit_count(nodes);
            store_set(&children, leaves, &leaves_[leaf_count]);
            leaf_count += bit_count(leaves);
        }
        if (last > end) ranges_[range_count_++] = {end, last};
    } while (range_count_ > 0 && leaf_count < kLeaves);
    leaf_begin_ = 0;
    leaf_end_ = leaf_count;
}

/// Tests up to kLeaves leaves. Returns the number of candidates.
std::size_t RayStream::test_leaves() {
    const std::uint32_t end = std::min(leaf_end_, leaf_begin_ + kLeaves);
    std::uint32_t count = 0;
    for (std::uint32_t i = leaf_begin_; i < end; ++i) {
        const std::uint32_t number = leaves_[i] % kMost;
        const BodyTree::Leaf& leaf = tree_.leaves_[leaves_[i] / kMost];
        const std::uint32_t met = BodyTree::balls_on_ray(leaf, lines_[number]);
        const simd::Unsigned8 bodies = packed(leaf.body, number);
        store_set(&bodies, met, &candidates_[count]);
        count += bit_count(met);
    }
    leaf_begin_ = end;
    return count;
}

}  // namespace tesserae::render
