// SPDX-License-Identifier: Apache-2.0
#include "core/convex/principal_axes.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace tesserae {
namespace {

constexpr double kEqualMoments = 1e-9;

/// Their mean in place of those that are about equal.
Vec4 merged(const Vec4& moments, double equal) {
    Vec4 means;
    for (int i = 0; i < 4; ++i) {
        const auto is_near = (moments.array() - moments[i]).abs() <= equal;
        means[i] = is_near.select(moments.array(), 0).sum() / static_cast<double>(is_near.count());
    }
    return means;
}

}  // namespace

PrincipalAxes principal_axes(const Mat4& moments) {
    const double equal = kEqualMoments * moments.trace();
    const Vec4 given = moments.diagonal();
    const Mat4 mixed = moments - Mat4(given.asDiagonal());
    if (mixed.cwiseAbs().maxCoeff() <= equal) return {merged(given, equal), {}, true};

    const Eigen::SelfAdjointEigenSolver<Mat4> solver(moments);
    const Vec4 values = solver.eigenvalues();  // ascending
    Mat4 axes;
    Vec4 found;
    for (int begin = 0, end = 0; begin < 4; begin = end) {
        while (end < 4 && values[end] - values[begin] <= equal) ++end;
        // Of a space of equal moments the given axes' shadows in it, the longest first.
        Mat4 shadow = Mat4::Zero();
        for (int k = begin; k < end; ++k)
            shadow += solver.eigenvectors().col(k) * solver.eigenvectors().col(k).transpose();
        for (int k = begin; k < end; ++k) {
            int longest = 0;
            for (int axis = 1; axis < 4; ++axis)
                if (shadow.col(axis).norm() > shadow.col(longest).norm() + kEqualMoments)
                    longest = axis;
            const Vec4 unit = shadow.col(longest).normalized();
            shadow -= unit * (unit.transpose() * shadow).eval();
            axes.col(k) = unit;
            found[k] = unit.dot(moments * unit);
        }
    }
    if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
    return {merged(found, equal), to_rotor(axes), false};
}

}  // namespace tesserae
