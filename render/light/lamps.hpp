// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "render/light/light_set.hpp"
#include "render/picture.hpp"
#include "render/scene/placed_bodies.hpp"

namespace tesserae::render {

/// What shines from a surface of its own: a sphere light, or a bounded body that glows.
struct Lamp {
    Vec4 centre;    ///< of a ball that holds it, relative to the camera [m]
    double radius;  ///< of that ball [m]
    Color radiance;
    double power;          ///< of all colours, about
    std::uint32_t sphere;  ///< in LightSet::spheres, or kNone
    std::uint32_t body;    ///< in PlacedBodies::bodies, or kNoBody
};

/// The visible bounded bodies that glow.
std::size_t count_glowing(const Picture& picture);

/// A lamp, and how often a choice falls on it.
struct LampChoice {
    std::uint32_t lamp;
    double chance;
};

/// The lamps of a frame, and the choice of those that a surface asks for light. Few are asked one
/// by one; of many one is chosen, by about what each would bring if nothing stood between: down a
/// tree of balls (Conty and Kulla, Importance sampling of many lights with adaptive tree splitting,
/// 2018, without splitting), by power over the distance's cube and the best cosine at the surface.
class Lamps {
  public:
    static constexpr std::uint32_t kNone = LightSet::kNone;
    /// As many are asked one by one. More, and each costs a ray at every surface; of fewer, a
    /// choice would have more noise than it saves.
    static constexpr std::uint32_t kEach = 4;

    Lamps(const LightSet& lights, const Picture& picture, const PlacedBodies& placed);

    const Lamp& operator[](std::uint32_t lamp) const { return lamps_[lamp]; }
    /// How many a surface asks.
    std::uint32_t asked() const;
    /// The k-th of them.
    /// @param chance   uniform in [0, 1)
    /// @return none where every lamp lies below the surface's horizon
    std::optional<LampChoice> choose(std::uint32_t k, const Vec4& point, const Vec4& normal,
                                     double chance) const;
    /// How often choose() falls on a lamp.
    double chance_of(std::uint32_t lamp, const Vec4& point, const Vec4& normal) const;

    /// The lamp that a sphere light or a body is, or kNone.
    std::uint32_t of_sphere(std::uint32_t sphere) const { return sphere; }
    std::uint32_t of_body(std::uint32_t body) const {
        return of_body_.empty() ? kNone : of_body_[body];
    }

  private:
    /// The lamps order_[first] to order_[first + count], halved.
    struct Node {
        Vec4 centre;
        double radius, power;
        std::uint32_t parent;
        std::uint32_t child;  ///< the first of two, or kNone
    };
    std::uint32_t add_node(std::uint32_t parent, std::span<std::uint32_t> lamps);
    void split(std::uint32_t node, std::span<std::uint32_t> lamps);
    static double importance(const Node& node, const Vec4& point, const Vec4& normal);

    std::vector<Lamp> lamps_;  ///< sphere lights first
    std::vector<std::uint32_t> of_body_;
    std::vector<Node> nodes_;          ///< the root first
    std::vector<std::uint32_t> leaf_;  ///< of every lamp
    std::vector<std::uint32_t> lamp_;  ///< of every node that is a leaf
};

}  // namespace tesserae::render
