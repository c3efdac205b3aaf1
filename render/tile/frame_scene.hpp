// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "render/camera/camera_rays.hpp"
#include "render/integrator/integrator.hpp"
#include "render/picture_needs.hpp"
#include "render/sampling/filter.hpp"
#include "render/scene/ghosts.hpp"
#include "render/scene/view_scene.hpp"

namespace tesserae::render {

/// The scene as rays of one part of the time meet it while the shutter is open: what moves is where
/// it is at each ray's own time, and bounds hold it for the whole part.
struct Interval {
    PlacedBodies placed;
    BodyTree tree;  ///< empty unless PictureNeeds has one
    Shading shading;
    std::unique_ptr<const LightIntegrator> integrator;
    std::vector<std::uint32_t> glass_about;  ///< GlassBodies::about where view rays begin

    /// @param reach   view rays begin no farther from the camera's place at the opening [m]
    Interval(const Picture& picture, const Vec4& origin, const ShutterPart& part,
             const LightSet& lights, const RoughReflections& rough, double reach);
    Interval(const Interval&) = delete;  // its parts refer to each other
};

/// Into how many intervals a frame with an open shutter divides its time at most: no more than keep
/// the memory for their trees within bounds.
int most_intervals(std::size_t bodies);

/// What all tiles of a frame share. While the shutter is open every sample has a time of its own.
/// The time is divided into intervals so short that what moves stays about where it is.
class FrameScene {
  public:
    FrameScene(const Picture& picture, bool wants_color);
    FrameScene(const FrameScene&) = delete;

    const Picture& picture() const { return picture_; }
    const PictureNeeds& needs() const { return needs_; }
    const SliceSheet& sheet() const { return sheet_; }
    const PixelFilter& filter() const { return filter_; }
    std::uint64_t pattern() const { return pattern_; }  ///< of the samples, see sample_pattern()
    bool wants_color() const { return wants_color_; }   ///< for the image or the preview

    /// When the shutter opens: depth, normal, position and id are as they are then.
    const Camera& camera() const { return camera_; }  ///< of a cell
    const CameraRays& rays() const { return rays_; }
    const Interval& opening() const { return opening_; }

    /// Nothing moves: every sample sees the opening.
    bool is_still() const { return intervals_.empty(); }
    /// @param part   of the time that the shutter is open, in [0, 1)
    double time(double part) const { return part * motions_.end(); }
    const Interval& at(double time) const;
    /// A view ray at a time, about the camera's place at the opening.
    /// @param u   as in CameraRays::sample
    Ray view_ray(const SliceSheet::Cell& cell, const Vec2& film, const std::array<double, 3>& u,
                 double time) const;

    /// The slice's bounds for view rays that all start in the pinhole, where nothing moves; else
    /// empty. Their film rectangles are grown by the filter's reach: they hold every pixel of which
    /// a sample can meet the body.
    const std::vector<SliceBounds>& slice() const { return slice_; }
    bool is_pinhole() const { return is_still() && rays_.is_pinhole(); }
    /// For the opening's view rays where there is no slice().
    const ViewScene& view() const { return *view_; }
    /// Beside a cell's slice; none where the picture has no ghosts.
    const Ghosts* ghosts(const SliceSheet::Cell& cell) const {
        return ghosts_.empty() ? nullptr : ghosts_[static_cast<std::size_t>(cell.number)].get();
    }

  private:
    const Picture& picture_;
    PictureNeeds needs_;
    SliceSheet sheet_;
    RoughReflections rough_;
    PixelFilter filter_;
    std::uint64_t pattern_;
    bool wants_color_;
    Camera camera_;
    CameraRays rays_;
    LightSet lights_;
    Motions motions_;
    bool camera_moves_;
    Interval opening_;
    std::vector<std::unique_ptr<Interval>> intervals_;  ///< of equal length, one after the other
    std::vector<SliceBounds> slice_;
    std::optional<ViewScene> view_;
    std::vector<std::unique_ptr<const Ghosts>> ghosts_;  ///< by cell
};

}  // namespace tesserae::render
