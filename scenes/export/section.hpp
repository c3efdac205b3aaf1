// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/dynamics/bodies/bodies.hpp"
#include "scenes/export/hull_section.hpp"
#include "scenes/export/round_section.hpp"
#include "scenes/export/slice_frame.hpp"

namespace tesserae::scenes {

/// How fine round bodies are, and how far planes go.
struct SectionSettings {
    double tolerance = 0;  ///< [m]; 0: kUsualTolerance of a body's size
    double extent = 0;     ///< planes end where a coordinate of the film is beyond it [m]
};

/// In parts of a body's diameter.
constexpr double kUsualTolerance = 1e-3;
/// In parts of its bounding radius: some 400 000 triangles a ball. Finer ones help no one.
constexpr double kFinestTolerance = 1e-5;

/// Bodies' sections by the slice of a frame, as meshes in the film's space.
class Sections {
  public:
    /// @throws InputError   the tolerance is below kFinestTolerance of a round body's radius
    Sections(const Bodies& bodies, const SectionSettings& settings);

    /// Polytopes exactly, round bodies within the tolerance, a plane as one polygon that faces its
    /// free side and ends where the film's space is cut off. Empty where the slice misses the body.
    Mesh of(const Bodies& bodies, BodyId id, const SliceFrame& frame) const;

  private:
    Mesh bounded(const Bodies& bodies, BodyId id, const SliceFrame& frame) const;

    SectionSettings settings_;
    std::vector<HullFaces> faces_;  ///< by body type; empty for other shapes
};

/// The part of the plane normal . x = offset that lies in the cube about the origin with the given
/// half side, counter-clockwise seen from where the normal points.
Mesh plane_patch(const Vec3& normal, double offset, double half_side);

}  // namespace tesserae::scenes
