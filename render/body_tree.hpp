#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "render/lanes.hpp"
#include "render/placed_bodies.hpp"

namespace tesserae::render {

/// The directions within an angle (possibly negative) of an axis, from an apex.
struct Cone {
    double sine, cosine;  ///< of the half-angle, within +-90 degrees
};

/// A hierarchy of 4D boxes over all bounded bodies, eight children to a node, tested at once by
/// wide arithmetic: for rays that leave the camera's hyperplane, so over whole bodies, not their
/// slices. Leaves hold up to eight bodies by their bounding spheres, which in 4D are tighter than
/// boxes for all but long bodies. Bounds are floats rounded outward, and by far more than the
/// tolerance of any hit: the walks may name a body that is not met, and never leave out one that
/// is.
class BodyTree {
  public:
    /// Built on the threads of the caller's task arena; the same bodies give the same tree on any
    /// number of them.
    explicit BodyTree(const PlacedBodies& placed);

    /// Calls visit(body index) for every bounded body that the ray may meet no farther than
    /// `limit`, roughly nearest first; visit may lower `limit` (a reference to the caller's), and
    /// returns false to end the walk.
    /// @param direction   unit
    template <class Visit>
    void for_each_on_ray(const Vec4& origin, const Vec4& direction, const double& limit,
                         Visit&& visit) const;

    /// Calls visit(body index) for every bounded body whose bounding sphere may reach into the
    /// cone about `direction` (unit) from `apex`; visit may narrow the cone (a reference to the
    /// caller's), and returns false to end the walk.
    template <class Visit>
    void for_each_in_cone(const Vec4& apex, const Vec4& direction, const Cone& cone,
                          Visit&& visit) const;

    /// A hash of the whole tree, for tests.
    std::uint64_t fingerprint() const;

  private:
    friend class BodyTreeBuilder;
    /// Marks a child that is a leaf, not a node.
    static constexpr std::uint32_t kLeaf = 0x80000000u;
    /// Floats stand for doubles to 6e-8; this covers the few roundings of the sphere and cone
    /// tests, relative to the coordinates.
    static constexpr float kSlack = 2e-6f;

    /// Where a lane is not used the radius is no number, and nothing meets it.
    struct Balls {
        std::array<Lanes, 4> centre;
        Lanes radius;
    };
    /// By axis the low sides and the high sides; low > high where a lane is not used.
    using Boxes = std::array<std::array<Lanes, 2>, 4>;
    struct Node {
        Boxes boxes;
        Balls balls;  ///< of the same children, for cones
        std::array<std::uint32_t, kLanes> child;
    };
    struct Leaf {
        Balls balls;
        std::array<std::uint32_t, kLanes> body;
    };

    /// What the tests of one ray have in common. The origin is widened by its rounding: `enter` is
    /// subtracted from the sides that a ray enters by, `leave` from those that it leaves by.
    struct Ray {
        std::array<float, 4> origin, direction, enter, leave, inverse;
        std::array<std::size_t, 4> enter_side;
        float slack;
    };
    static Ray ray_of(const Vec4& origin, const Vec4& direction);
    /// Which boxes the ray meets within the limit, and where it enters them.
    static std::uint32_t boxes_on_ray(const Boxes& boxes, const Ray& ray, float limit,
                                      Lanes& enter);
    /// The same for spheres.
    static std::uint32_t balls_on_ray(const Balls& balls, const Ray& ray, float limit,
                                      Lanes& enter);
    /// Which spheres the cone may meet.
    static std::uint32_t balls_in_cone(const Balls& balls, const Ray& axis, const Cone& cone);

    struct Waiting {
        std::uint32_t child;
        float enter;
    };

    /// No smaller float.
    static float rounded_up(double v) {
        const float f = static_cast<float>(v);
        return f < v ? f + f * 1.2e-7f : f;
    }

    /// At most seven children wait at every level; the builder bounds the levels: 48 by cost, and
    /// 32 more that halve.
    static constexpr std::size_t kWaiting = (kLanes - 1) * 80 + kLanes;

    std::vector<Node> nodes_;  ///< the root first; empty without bodies
    std::vector<Leaf> leaves_;
};

inline std::uint32_t BodyTree::boxes_on_ray(const Boxes& boxes, const Ray& ray, float limit,
                                            Lanes& enter) {
    Lanes first = all_lanes(0), last = all_lanes(limit);
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const std::size_t side = ray.enter_side[axis];
        const Lanes inverse = all_lanes(ray.inverse[axis]);
        first = larger(product_sum(boxes[axis][side], inverse, all_lanes(ray.enter[axis])), first);
        last =
            smaller(product_sum(boxes[axis][1 - side], inverse, all_lanes(ray.leave[axis])), last);
    }
    enter = first;
    return not_above(first, last * (1 + 1e-6f));
}

inline std::uint32_t BodyTree::balls_on_ray(const Balls& balls, const Ray& ray, float limit,
                                            Lanes& enter) {
    const auto& d = ray.direction;
    Lanes along = all_lanes(0), square = all_lanes(0);
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const Lanes v = balls.centre[axis] - ray.origin[axis];
        along = product_sum(v, all_lanes(d[axis]), along);
        square = product_sum(v, v, square);
    }
    // The difference of squares cancels: far away a sphere counts as wider, by 1/1000 of the
    // distance at most, which is twice what the roundings can make of it.
    const Lanes radius = balls.radius + ray.slack;
    const Lanes wide = product_sum(radius, radius, square * 1e-6f);
    const Lanes chord = product_sum(along, along, wide - square);
    // Behind the origin: that is outside, and the middle of the chord lies back.
    const std::uint32_t met =
        not_above(all_lanes(0), chord) & not_above(all_lanes(0), larger(along, wide - square));
    if (met == 0) return 0;
    enter = along - square_root(larger(chord, all_lanes(0)));
    return met & not_above(enter, all_lanes(limit));
}

inline std::uint32_t BodyTree::balls_in_cone(const Balls& balls, const Ray& axis,
                                             const Cone& cone) {
    const float sine = static_cast<float>(cone.sine), cosine = static_cast<float>(cone.cosine);
    const auto& p = axis.origin;
    const auto& d = axis.direction;
    const Lanes x = balls.centre[0] - p[0], y = balls.centre[1] - p[1];
    const Lanes z = balls.centre[2] - p[2], w = balls.centre[3] - p[3];
    const Lanes along = x * d[0] + y * d[1] + z * d[2] + w * d[3];
    const Lanes ox = x - along * d[0], oy = y - along * d[1];
    const Lanes oz = z - along * d[2], ow = w - along * d[3];
    const Lanes off = square_root(ox * ox + oy * oy + oz * oz + ow * ow);
    const Lanes reach = magnitude(along) + off;
    // Distance of the centre from the cone's side; behind the apex, from the apex (from below: the
    // larger leg of a right triangle).
    const Lanes side = off * cosine - along * sine;
    const Lanes behind = along * cosine + off * sine < 0 ? larger(off, -along) : side;
    return not_above(larger(side, behind), balls.radius + kSlack * reach + axis.slack);
}

template <class Visit>
void BodyTree::for_each_on_ray(const Vec4& origin, const Vec4& direction, const double& limit,
                               Visit&& visit) const {
    if (nodes_.empty()) return;
    const Ray ray = ray_of(origin, direction);
    std::array<Waiting, kWaiting> waiting;
    std::size_t count = 0;
    std::uint32_t next = 0;
    for (float reach = rounded_up(limit);;) {
        if ((next & kLeaf) == 0) {
            const Node& node = nodes_[next];
            Lanes enter;
            std::uint32_t met = boxes_on_ray(node.boxes, ray, reach, enter);
            if (met) {
                // The nearest child is next, the others wait, the nearer ones on top.
                const auto child = [&](std::uint32_t bits) {
                    const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
                    return Waiting{node.child[lane], enter[lane]};
                };
                Waiting nearest = child(met);
                const std::size_t begin = count;
                for (met &= met - 1; met; met &= met - 1) {
                    Waiting farther = child(met);
                    if (farther.enter < nearest.enter) std::swap(farther, nearest);
                    std::size_t at = count++;
                    for (; at > begin && waiting[at - 1].enter < farther.enter; --at)
                        waiting[at] = waiting[at - 1];
                    waiting[at] = farther;
                }
                next = nearest.child;
                continue;
            }
        } else {
            const Leaf& leaf = leaves_[next & ~kLeaf];
            Lanes enter;
            std::uint32_t met = balls_on_ray(leaf.balls, ray, reach, enter);
            while (met) {
                auto lane = static_cast<std::size_t>(std::countr_zero(met));
                for (std::uint32_t rest = met & (met - 1); rest; rest &= rest - 1) {
                    const auto other = static_cast<std::size_t>(std::countr_zero(rest));
                    if (enter[other] < enter[lane]) lane = other;
                }
                met &= ~(1u << lane);
                if (enter[lane] > reach) break;
                if (!visit(leaf.body[lane])) return;
                reach = rounded_up(limit);
            }
        }
        Waiting last;
        do {
            if (count == 0) return;
            last = waiting[--count];
        } while (last.enter > reach);
        next = last.child;
    }
}

template <class Visit>
void BodyTree::for_each_in_cone(const Vec4& apex, const Vec4& direction, const Cone& cone,
                                Visit&& visit) const {
    if (nodes_.empty()) return;
    const Ray axis = ray_of(apex, direction);
    std::array<std::uint32_t, kWaiting> waiting;
    std::size_t count = 0;
    waiting[count++] = 0;
    while (count > 0) {
        const std::uint32_t next = waiting[--count];
        if ((next & kLeaf) == 0) {
            const Node& node = nodes_[next];
            std::uint32_t met = balls_in_cone(node.balls, axis, cone);
            for (; met; met &= met - 1)
                waiting[count++] = node.child[static_cast<std::size_t>(std::countr_zero(met))];
        } else {
            const Leaf& leaf = leaves_[next & ~kLeaf];
            std::uint32_t met = balls_in_cone(leaf.balls, axis, cone);
            for (; met; met &= met - 1)
                if (!visit(leaf.body[static_cast<std::size_t>(std::countr_zero(met))])) return;
        }
    }
}

}  // namespace tesserae::render
