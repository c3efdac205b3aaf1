// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/scene/body_tree.hpp"
#include "render/scene/intersect.hpp"
#include "render/scene/ray_stream.hpp"

namespace tesserae::render {

/// The bodies as rays in any direction of 4D meet them: shadow and bounce rays, which leave the
/// camera's hyperplane. Whole bodies, not their slices.
class RayScene {
  public:
    /// @param tree   of the bodies; it must outlive this, like the others
    RayScene(const PlacedBodies& placed, const BodyTree& tree, const Settings& settings);

    /// What each ray meets first. Sixteen rays at a time go side by side: see RayStream.
    /// @param rays   whose limits come down to their hits
    /// @param hits   as many as rays
    void nearest(std::span<Ray> rays, std::span<Hit> hits, FrameStats& stats) const;
    Hit nearest(Ray ray, FrameStats& stats) const {
        Hit hit;
        nearest({&ray, 1}, {&hit, 1}, stats);
        return hit;
    }

    /// Whether each ray meets any body before its limit; sixteen rays at a time as well.
    /// @param blocked   as many as rays
    void find_blocked(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                      FrameStats& stats) const;
    bool is_blocked(const Ray& ray, FrameStats& stats) const {
        std::uint8_t blocked;
        find_blocked({&ray, 1}, {&blocked, 1}, stats);
        return blocked != 0;
    }

  private:
    /// What the test of a usual body needs, in one and in three lines of a CPU's cache: to gather
    /// it from PlacedBodies and Shape takes as long as the test itself.
    struct alignas(64) Ball {
        Vec4 centre;
        Hypersphere shape;
    };
    struct alignas(64) Box {
        Vec4 centre;
        Mat4 turn;
        Hyperbox shape;
    };
    enum Kind : std::uint32_t { kBall, kBox, kOther, kKinds };
    struct Slot {
        Kind kind;
        std::uint32_t index;  ///< in balls_, boxes_ or placed_.bodies
    };

    Slot slot_of(std::uint32_t index);
    void nearest_in_stream(std::span<Ray> rays, std::span<Hit> hits, FrameStats& stats) const;
    void find_blocked_in_stream(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                                FrameStats& stats) const;
    template <class LeavesOut, class Take>
    void test_bodies(RayStream& stream, std::span<const Ray> rays, LeavesOut&& leaves_out,
                     Take&& take, FrameStats& stats) const;
    void prefetch(const Slot& slot) const;

    const PlacedBodies& placed_;
    const BodyTree& tree_;
    const Settings& settings_;
    std::vector<Slot> slots_;  ///< by body
    std::vector<Ball> balls_;
    std::vector<Box> boxes_;
};

}  // namespace tesserae::render
