#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "render/camera/camera_rays.hpp"
#include "render/integrator/integrator.hpp"
#include "render/picture_needs.hpp"
#include "render/sampling/filter.hpp"
#include "render/scene/view_scene.hpp"

namespace tesserae::render {

/// The scene as it is at one instant of the open shutter: what all rays of that instant share.
struct Instant {
    CameraDescription description;
    Camera camera;  ///< of a cell
    PlacedBodies placed;
    LightSet lights;
    BodyTree tree;  ///< empty where there are neither shadows nor rays of the integrator's
    Shading shading;
    std::unique_ptr<const LightIntegrator> integrator;
    CameraRays rays;
    std::vector<std::uint32_t> glass_about;  ///< GlassBodies::about where view rays begin
    std::optional<ViewScene> view;           ///< none where FrameScene::slice serves

    /// @param bodies   their poses at the instant; only read here
    Instant(const Picture& picture, const CameraDescription& description, const SliceSheet& sheet,
            const Bodies& bodies, const RoughReflections& rough);
    Instant(const Instant&) = delete;  // its parts refer to each other
};

/// At how many instants a frame with an open shutter sees its bodies at most: 256, one a sample,
/// and no more than keep the memory for their trees within bounds.
int most_instants(std::size_t bodies, int samples);

/// What all tiles of a frame share. While the shutter is open the scene is seen at so many instants
/// that what moves moves by no more than about a pixel from one to the next, but at most one a
/// sample; a sample sees one of them. Where nothing moves there is one.
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
    const Instant& opening() const { return *instants_.front(); }
    /// @param time   uniform in [0, 1)
    const Instant& at(double time) const;
    bool is_still() const { return instants_.size() == 1; }

    /// The slice's bounds for view rays that all start in the pinhole of one instant; else empty,
    /// and every instant has a ViewScene. Their film rectangles are grown by the filter's reach:
    /// they hold every pixel of which a sample can meet the body.
    const std::vector<SliceBounds>& slice() const { return slice_; }
    bool is_pinhole() const { return is_still() && opening().rays.is_pinhole(); }

  private:
    const Picture& picture_;
    PictureNeeds needs_;
    SliceSheet sheet_;
    RoughReflections rough_;
    PixelFilter filter_;
    std::uint64_t pattern_;
    bool wants_color_;
    std::vector<std::unique_ptr<Instant>> instants_;  ///< the opening one, then those of samples
    std::vector<SliceBounds> slice_;
};

}  // namespace tesserae::render
