#pragma once

#include <optional>

#include "render/material/surface.hpp"
#include "render/sampling/cap.hpp"

namespace tesserae::render {

/// Mirrors and glass: they send a ray on in one or two directions only.
bool is_specular(const Material& material);

/// How a surface that is not specular scatters light toward a viewer: diffuse, by Lambert's 3
/// albedo/(4 pi); rough, by RoughReflection.
class Bsdf {
  public:
    /// @param out   toward the viewer, unit, world axes
    Bsdf(const Surface& surface, const Vec4& out);

    /// For light from `in` [1/sr of S^3]. Lambert's also where `in` is below the surface, since
    /// irradiance of a light that is partly set has its middle there.
    Color value(const Vec4& in) const;

    /// Density of `sample` [1/sr of S^3].
    double density(const Vec4& in) const;

    struct Sample {
        Vec4 in;         ///< unit, world axes
        Color weight;    ///< value * cos / density; 0 for a direction below the surface
        double density;  ///< [1/sr of S^3]
    };
    Sample sample(const Uniform3& u) const;

  private:
    const Surface& surface_;
    std::optional<TangentFrame> frame_;  ///< of a rough surface
    Vec4 out_;                           ///< toward the viewer, in the frame if there is one
};

}  // namespace tesserae::render
