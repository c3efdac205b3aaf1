#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "render/placed_bodies.hpp"

namespace tesserae::render {

/// The directions within an angle (possibly negative) of an axis, from an apex.
struct Cone {
    double sine, cosine;  ///< of the half-angle, within +-90 degrees
};

/// Bounding spheres in 4D over all bounded bodies, eight to a node, so that one pass of wide
/// arithmetic tests a node's children. Shadow rays leave the camera's hyperplane, so these are the
/// whole bodies, not their slices. Built by median splits: the same bodies give the same tree.
class ShadowTree {
  public:
    explicit ShadowTree(std::span<const PlacedBody> bodies);

    /// Calls visit(body index) for every body whose bounding sphere may reach into the cone about
    /// `direction` (unit) from `apex`; visit may narrow the cone, and returns false to end the
    /// walk.
    template <class Visit>
    void for_each_in_cone(const Vec4& apex, const Vec4& direction, const Cone& cone,
                          Visit&& visit) const;

  private:
    static constexpr int kWidth = 8;
    using Lanes = std::array<float, kWidth>;
    /// Marks a child that is a body, not a node.
    static constexpr std::uint32_t kBody = 0x80000000u;
    /// Floats stand for doubles to 6e-8; this covers the few roundings of the cone test, relative
    /// to the coordinates.
    static constexpr float kSlack = 2e-6f;

    struct alignas(32) Node {
        std::array<Lanes, 4> centre;
        Lanes radius;  ///< negative infinity: no child here
        std::array<std::uint32_t, kWidth> child;
    };
    struct Ball {
        Vec4 centre;
        double radius;
    };

    std::uint32_t build(std::span<std::uint32_t> members, std::span<const PlacedBody> bodies);
    void set_child(std::uint32_t node, int slot, std::span<std::uint32_t> members,
                   std::span<const PlacedBody> bodies);
    /// Which children's spheres the cone may meet, by a signed gap: above zero if it cannot.
    static void gaps(const Node& node, const std::array<float, 4>& apex,
                     const std::array<float, 4>& direction, float apex_slack, const Cone& cone,
                     Lanes& gap);

    std::vector<Node> nodes_;  ///< the root first; empty without bodies
};

inline void ShadowTree::gaps(const Node& n, const std::array<float, 4>& p,
                             const std::array<float, 4>& d, float apex_slack, const Cone& cone,
                             Lanes& gap) {
    const float sine = static_cast<float>(cone.sine), cosine = static_cast<float>(cone.cosine);
    for (std::size_t i = 0; i < kWidth; ++i) {
        const float x = n.centre[0][i] - p[0], y = n.centre[1][i] - p[1];
        const float z = n.centre[2][i] - p[2], w = n.centre[3][i] - p[3];
        const float along = x * d[0] + y * d[1] + z * d[2] + w * d[3];
        // From the vector, since the difference of squares would cancel.
        const float ox = x - along * d[0], oy = y - along * d[1];
        const float oz = z - along * d[2], ow = w - along * d[3];
        const float off = std::sqrt(ox * ox + oy * oy + oz * oz + ow * ow);
        const float reach = std::abs(along) + off;
        // Distance of the centre from the cone's side; behind the apex, from the apex (from below:
        // the larger leg of a right triangle).
        const float side = off * cosine - along * sine;
        const float behind = along * cosine + off * sine < 0 ? std::max(off, -along) : side;
        gap[i] = std::max(side, behind) - n.radius[i] - kSlack * reach - apex_slack;
    }
}

template <class Visit>
void ShadowTree::for_each_in_cone(const Vec4& apex, const Vec4& direction, const Cone& cone,
                                  Visit&& visit) const {
    if (nodes_.empty()) return;
    std::array<float, 4> p, d;
    for (std::size_t i = 0; i < 4; ++i) {
        p[i] = static_cast<float>(apex[static_cast<int>(i)]);
        d[i] = static_cast<float>(direction[static_cast<int>(i)]);
    }
    const float apex_slack = kSlack * static_cast<float>(apex.lpNorm<1>());

    // Every level leaves at most seven siblings waiting, and a tree of 2^31 bodies has 11 levels.
    std::array<std::uint32_t, 96> waiting;
    std::size_t count = 0;
    waiting[count++] = 0;
    while (count > 0) {
        const Node& node = nodes_[waiting[--count]];
        Lanes gap;
        gaps(node, p, d, apex_slack, cone, gap);
        for (std::size_t i = 0; i < kWidth; ++i) {
            if (gap[i] > 0) continue;
            const std::uint32_t child = node.child[i];
            if ((child & kBody) == 0)
                waiting[count++] = child;
            else if (!visit(child & ~kBody))
                return;
        }
    }
}

}  // namespace tesserae::render
