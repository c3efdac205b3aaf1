// SPDX-License-Identifier: Apache-2.0
#include "render/camera/camera.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace tesserae::render {
namespace {

/// Sine of the angle below which two directions count as parallel. Smaller ones would leave fewer
/// than half of a double's digits in the orthogonalised axis.
constexpr double kParallel = 1e-8;

std::string text(const Vec4& v) { return fmt::format("[{}, {}, {}, {}]", v[0], v[1], v[2], v[3]); }

/// The unit part of `v` orthogonal to `first` and `second` (unit, orthogonal to each other).
Vec4 orthogonal_part(const Vec4& v, const Vec4& first, const Vec4& second, const char* key,
                     const char* others) {
    const Vec4 unit = v.stableNormalized();
    Vec4 rest = unit - unit.dot(first) * first - unit.dot(second) * second;
    if (!(rest.norm() > kParallel))
        throw InputError(
            fmt::format("camera: {} = {} must not be parallel to {}", key, text(v), others));
    // A second pass removes what rounding left along the other axes.
    rest.normalize();
    rest -= rest.dot(first) * first + rest.dot(second) * second;
    return rest.normalized();
}

/// The unit vector that makes (it, a, b, c) a frame of determinant +1, for orthonormal a, b, c: the
/// cofactors of the first column.
Vec4 completing_axis(const Vec4& a, const Vec4& b, const Vec4& c) {
    Vec4 axis;
    for (int i = 0; i < 4; ++i) {
        Mat4 m;
        m << Vec4::Unit(i), a, b, c;
        axis[i] = m.determinant();
    }
    return axis.normalized();
}

}  // namespace

Camera::Camera(const CameraDescription& d, int width, int height)
    : origin_(d.position), centre_(0.5 * width, 0.5 * height) {
    const Vec4 view = d.look_at - d.position;
    if (!(view.stableNorm() > 0))
        throw InputError(
            fmt::format("camera: look_at = {} must differ from position", text(d.look_at)));
    const Vec4 forward = view.stableNormalized();
    const Vec4 fourth =
        orthogonal_part(d.fourth, forward, Vec4::Zero(), "fourth", "the forward direction");
    const Vec4 up = orthogonal_part(d.up, forward, fourth, "up",
                                    "the plane of the forward direction and fourth");
    axes_ << completing_axis(up, forward, fourth), up, forward, fourth;
    pixel_ = 2 * std::tan(d.field_of_view * (std::numbers::pi / 360)) / height;
}

}  // namespace tesserae::render
