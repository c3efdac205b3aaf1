// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "core/simd/simd.hpp"
#include "render/ray.hpp"
#include "render/scene/placed_bodies.hpp"

namespace tesserae::render {

class RayStream;

using simd::kLanes, simd::Float8, simd::all_lanes, simd::larger, simd::smaller, simd::magnitude;
using simd::not_above, simd::product_sum, simd::square_root, simd::store_set;

/// A hierarchy of 4D boxes over all bounded bodies, eight children to a node, tested at once by
/// wide arithmetic: for rays that leave the camera's hyperplane, so over whole bodies, not their
/// slices. Leaves hold up to eight bodies by their bounding spheres, which in 4D are tighter than
/// boxes for all but long bodies. Bounds are floats rounded outward, and by far more than the
/// tolerance of any hit: the walks may name a body that is not met, and never leave out one that
/// is.
class BodyTree {
  public:
    /// RayStream puts a ray's number into the other four bits of a body's.
    static constexpr std::size_t kMostBodies = (std::size_t{1} << 28) - 1;

    /// Built on the threads of the caller's task arena; the same bodies give the same tree on any
    /// number of them.
    explicit BodyTree(const PlacedBodies& placed);

    /// Calls visit(body index) for every bounded body that the ray may meet up to its limit, also
    /// the one that it is `on`, roughly nearest first; visit returns false to end the walk.
    template <class Visit>
    void for_each_on_ray(const Ray& ray, Visit&& visit) const;

    /// Calls visit(body index) for every bounded body whose bounding sphere may reach into the
    /// cone about a ray, however far away; visit may narrow the cone (a reference to the caller's),
    /// and returns false to end the walk.
    template <class Visit>
    void for_each_in_cone(const Ray& axis, const Cone& cone, Visit&& visit) const;

    /// The bodies that no box holds, ascending: the walks leave them to the caller.
    const std::vector<std::uint32_t>& unbounded() const { return unbounded_; }

    /// Calls visit(body index) for every bounded body, neighbours one after the other.
    template <class Visit>
    void for_each_bounded(Visit&& visit) const {
        for (const Leaf& leaf : leaves_)
            for (std::size_t i = 0; i < kLanes; ++i)
                if (leaf.radius[i] == leaf.radius[i]) visit(leaf.body[i]);
    }

    /// A hash of the whole tree, for tests.
    std::uint64_t fingerprint() const;

  private:
    friend class BodyTreeBuilder;
    friend class RayStream;
    /// The difference of squares in a sphere's test cancels: far away a sphere counts as wider, by
    /// 1/1000 of the distance at most, which is twice what the roundings can make of it.
    static constexpr float kSquareSlack = 1e-6f;

    /// Eight boxes; low > high where a lane is not used. A side is named by the place of its lane
    /// 0: the walks find it so without arithmetic.
    struct Boxes {
        /// The low sides along the first axis, the high sides, the low sides along the next one...
        alignas(Float8) std::array<float, 8 * kLanes> sides;

        static std::uint32_t low(std::size_t axis) {
            return static_cast<std::uint32_t>(2 * axis * kLanes);
        }
        static std::uint32_t high(std::size_t axis) {
            return static_cast<std::uint32_t>((2 * axis + 1) * kLanes);
        }
        static std::uint32_t opposite(std::uint32_t side) {
            return side ^ static_cast<std::uint32_t>(kLanes);
        }
        Float8 at(std::uint32_t side) const {
            Float8 coordinates;
            std::memcpy(&coordinates, &sides[side], sizeof coordinates);
            return coordinates;
        }
    };
    struct Node {
        Boxes boxes;
        std::array<std::uint32_t, kLanes> child;  ///< index of a node, or of a leaf
        std::uint32_t leaves;                     ///< bit i is set where child i is a leaf
        std::uint32_t unused[7];
    };
    /// Where a lane is not used the radius is no number, and nothing meets it.
    struct Leaf {
        std::array<Float8, 4> centre;
        Float8 radius;
        std::array<std::uint32_t, kLanes> body;
    };

    /// A Ray as eight boxes at once are tested against it: in floats, and what the tests have in
    /// common worked out. A side of a box, as a distance along the ray, is coordinate * inverse +
    /// shift.
    struct alignas(64) Line {
        std::array<std::uint32_t, 4> enter_side;  ///< of Boxes, by axis: the first on the way
        std::array<float, 4> inverse, enter_shift, leave_shift, origin, direction;
        float slack;  ///< spheres count as so much wider: see kOriginSlack
        float limit;
    };
    static Line line_of(const Ray& ray);
    /// The same for a cone. A cone about d is, along every axis, no wider than rays of slopes
    /// d - tan and d + tan.
    struct Side {
        std::uint32_t side;  ///< of Boxes
        float inverse, shift;
    };
    struct Flare {
        std::array<float, 4> origin, direction;
        std::array<Side, 4> enter, leave;
        /// The cone opens to both sides of this axis: it leaves no box there, and enters by both.
        std::array<bool, 4> opens;
        float slack, limit, sine, cosine;
    };
    static Flare flare_of(const Ray& axis, const Cone& cone);
    /// Which boxes the ray, or cone, meets within its limit, and where it enters them.
    static std::uint32_t boxes_met(const Boxes& boxes, const Line& line, Float8& enter);
    static std::uint32_t boxes_met(const Boxes& boxes, const Flare& cone, Float8& enter);
    /// Which spheres the ray meets within its limit.
    static std::uint32_t balls_on_ray(const Leaf& leaf, const Line& line);
    /// Which spheres the cone may meet.
    static std::uint32_t balls_in_cone(const Leaf& leaf, const Flare& cone);
    /// Calls visit(body) for the bodies of leaves that the way (a Line or Flare) meets and that
    /// test(leaf), a mask of lanes, names; nodes come roughly nearest first. The way may get
    /// shorter or narrower as it goes. Ends when visit returns false.
    template <class Way, class Test, class Visit>
    void for_each_body(const Way& way, Test&& test, Visit&& visit) const;

    /// A limit as a float that is no smaller, or far: unused lanes are farther.
    static float rounded_up(double v) {
        constexpr float kFar = 3e38f;
        const float f = static_cast<float>(v);
        return std::min(f < v ? f + f * 1.2e-7f : f, kFar);
    }

    /// Of nodes, at most: the builder makes 48 by cost, and 32 more that halve.
    static constexpr std::size_t kLevels = 80;
    /// At most seven children wait at every level.
    static constexpr std::size_t kWaiting = (kLanes - 1) * kLevels + kLanes;

    std::vector<Node> nodes_;  ///< the root first; empty without bodies
    std::vector<Leaf> leaves_;
    std::vector<std::uint32_t> unbounded_;
};

inline std::uint32_t BodyTree::boxes_met(const Boxes& boxes, const Line& line, Float8& enter) {
    Float8 first = all_lanes(0), last = all_lanes(line.limit);
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const std::uint32_t near = line.enter_side[axis], far = Boxes::opposite(near);
        const Float8 inverse = all_lanes(line.inverse[axis]);
        const Float8 enter_shift = all_lanes(line.enter_shift[axis]);
        const Float8 leave_shift = all_lanes(line.leave_shift[axis]);
        first = larger(product_sum(boxes.at(near), inverse, enter_shift), first);
        last = smaller(product_sum(boxes.at(far), inverse, leave_shift), last);
    }
    enter = first;
    // Both are right to three roundings.
    return not_above(first, last * (1 + 1e-6f));
}

inline std::uint32_t BodyTree::boxes_met(const Boxes& boxes, const Flare& cone, Float8& enter) {
    Float8 first = all_lanes(0), last = all_lanes(cone.limit);
    const auto distance = [&](const Side& side) {
        return product_sum(boxes.at(side.side), all_lanes(side.inverse), all_lanes(side.shift));
    };
    for (std::size_t axis = 0; axis < 4; ++axis) {
        first = larger(distance(cone.enter[axis]), first);
        if (cone.opens[axis])
            first = larger(distance(cone.leave[axis]), first);
        else
            last = smaller(distance(cone.leave[axis]), last);
    }
    enter = first;
    return not_above(first, last * (1 + 1e-6f));
}

inline std::uint32_t BodyTree::balls_on_ray(const Leaf& leaf, const Line& line) {
    Float8 along = all_lanes(0), square = all_lanes(0);
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const Float8 v = leaf.centre[axis] - line.origin[axis];
        along = product_sum(v, all_lanes(line.direction[axis]), along);
        square = product_sum(v, v, square);
    }
    const Float8 radius = leaf.radius + line.slack;
    const Float8 power = product_sum(radius, radius, square * kSquareSlack) - square;
    // Missed where the chord's middle lies back, and the origin outside; or where the middle is
    // past the limit by more than half the chord: of that half, the square.
    const Float8 past = larger(along - line.limit, all_lanes(0));
    const Float8 half = product_sum(along, along, power);
    return not_above(all_lanes(0), smaller(product_sum(-past, past, half), larger(along, power)));
}

inline std::uint32_t BodyTree::balls_in_cone(const Leaf& leaf, const Flare& cone) {
    Float8 along = all_lanes(0), square = all_lanes(0);
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const Float8 v = leaf.centre[axis] - cone.origin[axis];
        along = product_sum(v, all_lanes(cone.direction[axis]), along);
        square = product_sum(v, v, square);
    }
    // The centre lies off cos - along sin from the cone's side, and before the apex if it is met.
    const Float8 radius = leaf.radius + cone.slack;
    const Float8 reach = larger(product_sum(along, all_lanes(cone.sine), radius), all_lanes(0));
    const Float8 off = (square - along * along) * (cone.cosine * cone.cosine);
    return not_above(off, product_sum(reach, reach, square * kSquareSlack)) &
           not_above(all_lanes(0), along + radius);
}

template <class Way, class Test, class Visit>
void BodyTree::for_each_body(const Way& way, Test&& test, Visit&& visit) const {
    if (nodes_.empty()) return;
    struct Waiting {
        std::uint32_t node;
        float enter;
    };
    std::array<Waiting, kWaiting> waiting;
    std::size_t count = 0;
    for (Waiting next = {0, 0};;) {
        const Node& node = nodes_[next.node];
        Float8 enter;
        const std::uint32_t met = boxes_met(node.boxes, way, enter);

        // All leaves at once: most name no body, and tests that wait for nothing overlap.
        std::uint64_t named = 0;
        for (std::uint32_t leaves = met & node.leaves; leaves; leaves &= leaves - 1) {
            const int lane = std::countr_zero(leaves);
            const Leaf& leaf = leaves_[node.child[static_cast<std::size_t>(lane)]];
            named |= std::uint64_t{test(leaf)} << (lane * kLanes);
        }
        for (; named; named &= named - 1) {
            const auto at = static_cast<std::size_t>(std::countr_zero(named));
            if (!visit(leaves_[node.child[at / kLanes]].body[at % kLanes])) return;
        }

        // The nearest node is next, the others wait, the nearer ones on top.
        std::uint32_t nodes = met & ~node.leaves;
        if (nodes) {
            const auto child = [&](std::uint32_t bits) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
                return Waiting{node.child[lane], enter[lane]};
            };
            const std::size_t begin = count;
            next = child(nodes);
            for (nodes &= nodes - 1; nodes; nodes &= nodes - 1) {
                Waiting farther = child(nodes);
                if (farther.enter < next.enter) std::swap(farther, next);
                std::size_t at = count++;
                for (; at > begin && waiting[at - 1].enter < farther.enter; --at)
                    waiting[at] = waiting[at - 1];
                waiting[at] = farther;
            }
            if (next.enter <= way.limit) continue;
        }
        do {
            if (count == 0) return;
            next = waiting[--count];
        } while (next.enter > way.limit);
    }
}

template <class Visit>
void BodyTree::for_each_on_ray(const Ray& ray, Visit&& visit) const {
    const Line line = line_of(ray);
    for_each_body(
        line, [&](const Leaf& leaf) { return balls_on_ray(leaf, line); }, visit);
}

template <class Visit>
void BodyTree::for_each_in_cone(const Ray& axis, const Cone& cone, Visit&& visit) const {
    Flare flare = flare_of(axis, cone);
    double sine = cone.sine;
    for_each_body(
        flare, [&](const Leaf& leaf) { return balls_in_cone(leaf, flare); },
        [&](std::uint32_t body) {
            const bool goes_on = visit(body);
            if (cone.sine != sine) {
                flare = flare_of(axis, cone);
                sine = cone.sine;
            }
            return goes_on;
        });
}

}  // namespace tesserae::render
