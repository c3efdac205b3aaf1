#pragma once

#include <array>
#include <optional>

#include "render/camera.hpp"

namespace tesserae::render {

/// A ray at an instant of the open shutter.
struct Ray {
    Vec4 origin;      ///< relative to the camera's position when the shutter opens, world axes [m]
    Vec4 direction;   ///< unit, world axes
    double time = 0;  ///< 0: the shutter opens, 1: it closes
};

/// The parallel slices that a frame shows, in cells of equal size: one that fills the frame, or
/// several row by row. They are spread evenly over the slice's thickness, the first at -w.
class SliceSheet {
  public:
    SliceSheet(const CameraDescription& camera, int width, int height);

    struct Cell {
        int x0, y0;     ///< its upper left pixel
        double fourth;  ///< of its slice, from the camera's own along the fourth axis [m]
    };
    /// Nothing where no slice is shown: in what is left over at the right and the bottom.
    std::optional<Cell> cell_of(int x, int y) const;
    int cell_width() const { return cell_width_; }
    int cell_height() const { return cell_height_; }

  private:
    int slices_, columns_, rows_, cell_width_, cell_height_;
    double thickness_;
};

/// The view rays of a frame: through the pinhole, or through a thin lens, from anywhere in a thick
/// slice, at any instant while the shutter is open; what has no extent is left out. The camera's
/// position and axes move evenly while it is open.
class CameraRays {
  public:
    /// @param closing   the camera when the shutter closes
    /// @throws InputError   as Camera()
    CameraRays(const CameraDescription& opening, const CameraDescription& closing, int width,
               int height);

    /// The camera of a cell when the shutter opens.
    const Camera& camera() const { return camera_; }
    const SliceSheet& sheet() const { return sheet_; }
    /// Every ray starts in the camera's position, lies in its slice, and has time 0.
    bool is_pinhole() const { return is_pinhole_; }

    /// The ray that stands for a film point as a whole: through the middle of lens and slice, when
    /// the shutter opens.
    /// @param film   continuous pixels from the frame's top left
    Ray middle(const SliceSheet::Cell& cell, const Vec2& film) const;
    /// @param u   uniform in [0, 1)^4: lens, lens, slice, time
    Ray sample(const SliceSheet::Cell& cell, const Vec2& film,
               const std::array<double, 4>& u) const;

  private:
    CameraDescription opening_, closing_;
    SliceSheet sheet_;
    Camera camera_;
    double focus_;  ///< distance of the plane in focus, along the forward axis [m]
    bool is_pinhole_, moves_;
};

}  // namespace tesserae::render
