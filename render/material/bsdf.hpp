// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <numbers>
#include <optional>

#include "render/material/surface.hpp"
#include "render/sampling/cap.hpp"

namespace tesserae::render {

/// Mirrors and glass: they send a ray on in one or two directions only.
inline bool is_specular(const Material& m) {
    return m.kind == MaterialKind::kMirror || m.kind == MaterialKind::kGlass ||
           (m.kind == MaterialKind::kRough && m.roughness == 0);
}

/// How a surface that is not specular scatters light toward a viewer: diffuse, by Lambert's 3
/// albedo/(4 pi); rough, by RoughReflection.
class Bsdf {
  public:
    /// @param out   toward the viewer, unit, world axes
    Bsdf(const Surface& surface, const Vec4& out) : surface_(surface), out_(out) {
        if (surface.rough) enter_frame();
    }

    /// For light from `in` [1/sr of S^3]. Lambert's also where `in` is below the surface, since
    /// irradiance of a light that is partly set has its middle there.
    Color value(const Vec4& in) const {
        return frame_ ? value_of_rough(in) : Color(kLambert * surface_.albedo);
    }

    /// Density of `sample` [1/sr of S^3].
    double density(const Vec4& in) const {
        return frame_ ? density_of_rough(in) : kLambert * std::max(0.0, surface_.normal.dot(in));
    }

    struct Sample {
        Vec4 in;         ///< unit, world axes
        Color weight;    ///< value * cos / density; 0 for a direction below the surface
        double density;  ///< [1/sr of S^3]
    };
    /// @param cosine   cosine_direction(u), which paths side by side have made together
    Sample sample(const Uniform3& u, const Vec4& cosine) const {
        if (frame_) return sample_of_rough(u);
        return {TangentFrame(surface_.normal).to_world(cosine), surface_.albedo,
                kLambert * cosine[3]};
    }

  private:
    static constexpr double kLambert = 3 / (4 * std::numbers::pi);

    void enter_frame();
    Color value_of_rough(const Vec4& in) const;
    double density_of_rough(const Vec4& in) const;
    Sample sample_of_rough(const Uniform3& u) const;

    const Surface& surface_;
    std::optional<TangentFrame> frame_;  ///< of a rough surface
    Vec4 out_;                           ///< toward the viewer, in the frame if there is one
};

}  // namespace tesserae::render
