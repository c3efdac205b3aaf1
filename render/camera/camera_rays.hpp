// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "render/camera/camera.hpp"

namespace tesserae::render {

/// The parallel slices that a frame shows, in cells of equal size: one that fills the frame, or
/// several row by row. They are spread evenly over the slice's thickness, the first at its lower
/// end.
class SliceSheet {
  public:
    SliceSheet(const CameraDescription& camera, int width, int height);

    struct Cell {
        int x0, y0;     ///< its upper left pixel
        double fourth;  ///< of its slice, from the camera's own along the fourth axis [m]
        int number;     ///< from 0, row by row
    };
    int cells() const { return slices_; }
    /// Of a cell's slice.
    double fourth(int cell) const;
    /// Nothing where no slice is shown: in what is left over at the right and the bottom.
    std::optional<Cell> cell_of(int x, int y) const;
    int cell_width() const { return cell_width_; }
    int cell_height() const { return cell_height_; }

  private:
    int slices_, columns_, rows_, cell_width_, cell_height_;
    double thickness_;
};

/// The view rays of a camera: through the pinhole or a thin lens, in its slice, in several, or
/// anywhere in a thick one. What has no extent is left out.
class CameraRays {
  public:
    /// @param camera   of one cell, as it is at the instant of the rays
    CameraRays(const CameraDescription& description, const Camera& camera);

    /// Every ray starts in the camera's position and lies in its slice.
    bool is_pinhole() const;
    /// Where rays start along the fourth axis, and how far from the camera in their slice.
    SliceRange range() const { return {-0.5 * thickness_, 0.5 * thickness_}; }
    double reach() const { return aperture_; }

    /// The ray that stands for a film point as a whole: through the middle of lens and slice.
    /// @param film   continuous pixels from the frame's top left
    ViewRay middle(const SliceSheet::Cell& cell, const Vec2& film) const;
    /// @param u   uniform in [0, 1)^3: two for the lens, one for the slice
    ViewRay sample(const SliceSheet::Cell& cell, const Vec2& film,
                   const std::array<double, 3>& u) const;

  private:
    const Camera& camera_;
    double aperture_, focus_;  ///< radius of the lens; forward to what is sharp [m]
    double thickness_;
    bool is_sheet_;
};

}  // namespace tesserae::render
