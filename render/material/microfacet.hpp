// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/sampling/cap.hpp"

namespace tesserae::render {

/// Reflection from a surface of tiny mirrors, in four dimensions: Trowbridge and Reitz's (GGX) for
/// S^3. Directions are unit, in the frame whose last axis is the surface's normal.
///
/// The mirrors are oriented as the surface of an ellipsoid with half-axes 1, 1, 1 along the surface
/// and alpha across it. A support function h(m) = sqrt(sin^2 + alpha^2 cos^2) gives an ellipsoid in
/// N dimensions the area (product of half-axes)^2 / h^(N+1) per solid angle of normals; divided by
/// the area of its upper half's shadow, the unit 3-ball's 4 pi/3,
///     D(m) = 3 alpha^2 / (4 pi (sin^2 + alpha^2 cos^2)^(5/2)),   integral of D cos = 1.
/// The part of the mirrors that is seen from a direction follows from the shadow of the ellipsoid
/// that way: G1 = 2 cos / (cos + sqrt(cos^2 + alpha^2 sin^2)), the same as in three dimensions, and
/// so is the masking of both ways, 1/(1 + Lambda(i) + Lambda(o)) with G1 = 1/(1 + Lambda).
/// Reflecting a fixed direction o about m moves the image twice as far along the plane of incidence
/// and by 2 (o.m) times along the other two: dw = 8 (o.m)^2 dm. Hence
///     brdf = D(m) G(i, o) / (8 (i.m) cos_i cos_o),   m the half vector.
/// Sources: Walter et al. 2007 and Heitz 2014 for three dimensions; the change of dimension is ours
/// (Microfacet.* in the tests hold it against quadrature over S^3).
class Microfacet {
  public:
    /// @param roughness   above 0, to 1; alpha is its square, at least kLeastAlpha
    explicit Microfacet(double roughness);

    /// Below this the lobe is narrower than a pixel, and its height (alpha^-3) nears overflow of
    /// what follows.
    static constexpr double kLeastAlpha = 1e-4;

    double normal_density(const Vec4& normal) const;
    /// G1, and the same for both ways of a reflection.
    double visible_part(const Vec4& direction) const;
    double visible_part(const Vec4& out, const Vec4& in) const;
    /// Of a perfect mirror's material; 0 where either direction is below the surface.
    double brdf(const Vec4& out, const Vec4& in) const;

    /// The mirror that `out` sees for a point of the unit 3-ball, in proportion to the area seen: a
    /// point of the stretched hemisphere's shadow, which is half a ball and half an ellipsoid
    /// (Heitz 2018). Where `out` is across the second and third axis, so is the mirror for a point
    /// without them.
    Vec4 visible_normal(const Vec4& out, Eigen::Vector3d point) const;
    /// The mirrored direction of `out` at a random one of these. May lie below the surface.
    Vec4 sample(const Vec4& out, const Uniform3& u) const;
    /// Density of `sample`: G1(out) D(m) / (8 (out.m) cos_out).
    double density(const Vec4& out, const Vec4& in) const;

  private:
    double lambda(const Vec4& direction) const;

    double alpha_;
};

}  // namespace tesserae::render
