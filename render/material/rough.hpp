// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <span>

#include "render/description.hpp"
#include "render/material/microfacet.hpp"

namespace tesserae::render {

/// Reflection from a rough surface: once from the mirrors that Microfacet describes, or several
/// times between them. Of a white surface nothing is lost.
///
/// What comes back after one reflection is the microfacets' BRDF; of a uniform field that is the
/// part E(cos), the rest of which goes on between the mirrors. After several reflections it has
/// forgotten where it came from, so that it leaves in proportion to what may not arrive (Kulla and
/// Conty 2017, here with the 4 pi/3 of S^3's hemisphere for pi):
///     (1 - E(cos_o)) (1 - E(cos_i)) / (4 pi/3 (1 - mean)),   mean = 3 integral of E sin^2 d(sin).
/// Each further reflection tints: albedo a once, then a^2 mean / (1 - a (1 - mean)).
/// Directions are as Microfacet's.
class RoughReflection {
  public:
    /// Tabulates E, some 5 ms.
    explicit RoughReflection(double roughness);

    /// E.
    double single_part(double cosine) const { return 1 - lost_part(cosine); }

    /// [1/sr of S^3]; 0 where either direction is below the surface.
    Color brdf(const Color& albedo, const Vec4& out, const Vec4& in) const;
    /// As Microfacet's, or by the cosine.
    Vec4 sample(const Vec4& out, const Uniform3& u) const;
    /// Density of `sample`.
    double density(const Vec4& out, const Vec4& in) const;

  private:
    double lost_part(double cosine) const;
    /// How often `sample` takes one reflection only. Where little comes back of one it is still
    /// half, so that no direction weighs more than 2.
    double single_choice(double cosine) const { return 0.5 * (1 + single_part(cosine)); }

    static constexpr int kNodes = 32;
    Microfacet facets_;
    std::array<double, kNodes + 1> lost_;  ///< 1 - E at the cosines (k/kNodes)^2
    double mean_lost_;                     ///< 1 - mean
};

/// The rough reflections of a scene's materials, by roughness.
class RoughReflections {
  public:
    explicit RoughReflections(std::span<const Material> materials);
    /// Null for one that is not rough.
    const RoughReflection* of(const Material& material) const;

  private:
    std::map<double, RoughReflection> by_roughness_;
};

}  // namespace tesserae::render
