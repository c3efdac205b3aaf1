// SPDX-License-Identifier: Apache-2.0
#include "render/material/microfacet.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tesserae::render {

Microfacet::Microfacet(double roughness) : alpha_(std::max(kLeastAlpha, roughness * roughness)) {}

double Microfacet::normal_density(const Vec4& m) const {
    if (!(m[3] > 0)) return 0;
    const double h = m.head<3>().squaredNorm() + alpha_ * alpha_ * m[3] * m[3];
    return 3 * alpha_ * alpha_ / (4 * std::numbers::pi * h * h * std::sqrt(h));
}

double Microfacet::lambda(const Vec4& d) const {
    const double square = alpha_ * alpha_ * d.head<3>().squaredNorm() / (d[3] * d[3]);
    return 0.5 * (std::sqrt(1 + square) - 1);
}

double Microfacet::visible_part(const Vec4& d) const { return 1 / (1 + lambda(d)); }

double Microfacet::visible_part(const Vec4& out, const Vec4& in) const {
    return 1 / (1 + lambda(out) + lambda(in));
}

double Microfacet::brdf(const Vec4& out, const Vec4& in) const {
    if (!(out[3] > 0 && in[3] > 0)) return 0;
    const Vec4 m = (out + in).normalized();
    return normal_density(m) * visible_part(out, in) / (8 * out.dot(m) * out[3] * in[3]);
}

Vec4 Microfacet::visible_normal(const Vec4& out, Eigen::Vector3d p) const {
    // Stretch the ellipsoid to the unit hemisphere.
    const Vec4 view = Vec4(alpha_ * out[0], alpha_ * out[1], alpha_ * out[2], out[3]).normalized();

    // Axes of the plane of its shadow, the last of them rising as far as it can.
    const TangentFrame frame(view);
    const Vec4 rise = Vec4::UnitW() - view[3] * view;
    const double steepness = rise.norm();
    const Eigen::Vector3d up = steepness > 0
                                   ? Eigen::Vector3d(frame.to_local(rise).head<3>() / steepness)
                                   : Eigen::Vector3d(Eigen::Vector3d::UnitZ());

    // The ball's lower half is seen foreshortened.
    const double height = p.dot(up);
    const double rim = std::sqrt(std::max(0.0, 1 - (p - height * up).squaredNorm()));
    const double part = 0.5 * (1 + view[3]);
    p += ((1 - part) * rim + part * height - height) * up;

    // Lift it to the hemisphere and squeeze it back.
    const double depth = std::sqrt(std::max(0.0, 1 - p.squaredNorm()));
    Vec4 m = frame.to_world(Vec4(p.x(), p.y(), p.z(), depth));
    m.head<3>() *= alpha_;
    m[3] = std::max(m[3], 0.0);
    return m.normalized();
}

Vec4 Microfacet::sample(const Vec4& out, const Uniform3& u) const {
    const Vec4 m = visible_normal(out, uniform_ball(u));
    return (2 * out.dot(m) * m - out).normalized();
}

double Microfacet::density(const Vec4& out, const Vec4& in) const {
    if (!(out[3] > 0)) return 0;
    const Vec4 m = (out + in).normalized();
    if (!(m[3] > 0 && out.dot(m) > 0)) return 0;
    return visible_part(out) * normal_density(m) / (8 * out.dot(m) * out[3]);
}

}  // namespace tesserae::render
