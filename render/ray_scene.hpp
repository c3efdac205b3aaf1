#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/body_tree.hpp"
#include "render/intersect.hpp"

namespace tesserae::render {

/// The bodies as rays in any direction of 4D meet them: shadow and bounce rays, which leave the
/// camera's hyperplane. Whole bodies, not their slices.
class RayScene {
  public:
    static constexpr std::uint32_t kNoBody = ~std::uint32_t{0};

    /// @param tree   of the bodies; it must outlive this, like the others
    RayScene(const PlacedBodies& placed, const BodyTree& tree, const Settings& settings);

    struct Ray {
        Vec4 origin;     ///< relative to the camera, world axes
        Vec4 direction;  ///< unit, world axes
        /// A body left out, or kNoBody: a ray that leaves a convex body outward never meets it
        /// again, so that no origin needs to be moved off its surface.
        std::uint32_t on = kNoBody;
        double limit = kMiss;  ///< bodies farther than this do not count [m]
    };
    /// The nearest body that each ray meets; equal distances go to the lower id. Sixteen rays at a
    /// time go side by side: see RayStream.
    /// @param hits   as many as rays
    void nearest(std::span<const Ray> rays, std::span<Hit> hits, FrameStats& stats) const;
    Hit nearest(const Ray& ray, FrameStats& stats) const {
        Hit hit;
        nearest({&ray, 1}, {&hit, 1}, stats);
        return hit;
    }

    /// Whether any body but `on` is met no farther than `limit` [m]; origin and direction as above.
    bool is_blocked(const Vec4& origin, const Vec4& direction, double limit, std::uint32_t on,
                    FrameStats& stats) const;

  private:
    /// What the closed form of a usual body needs, in one and in three lines of a CPU's cache: to
    /// gather it from PlacedBodies and Shape takes as long as the test itself.
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

    void nearest_in_stream(std::span<const Ray> rays, std::span<Hit> hits, FrameStats& stats) const;
    void prefetch(const Slot& slot) const;

    const PlacedBodies& placed_;
    const BodyTree& tree_;
    const Settings& settings_;
    std::vector<Slot> slots_;  ///< by body; where bodies are sphere traced all are others
    std::vector<Ball> balls_;
    std::vector<Box> boxes_;
};

}  // namespace tesserae::render
