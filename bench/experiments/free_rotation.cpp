// SPDX-License-Identifier: Apache-2.0
#include "bench/experiments/free_rotation.hpp"

namespace tesserae::bench {
namespace {

using Matrix = Eigen::Matrix<long double, 4, 4>;

/// W of the angular momentum L, both in the body frame.
Matrix velocity_of(const Matrix& L, const Vec4& moments) {
    Matrix W;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            W(i, j) = L(i, j) / (static_cast<long double>(moments[i]) + moments[j]);
    return W;
}

}  // namespace

Bivector free_rotation(const Vec4& moments, const Bivector& omega, double time, int steps) {
    Matrix L = to_matrix(omega).cast<long double>();
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) L(i, j) *= static_cast<long double>(moments[i]) + moments[j];

    const auto rate = [&](const Matrix& Q) -> Matrix {
        return Q * velocity_of(Q.transpose() * L * Q, moments);
    };
    const long double h = static_cast<long double>(time) / steps;
    Matrix Q = Matrix::Identity();
    for (int i = 0; i < steps; ++i) {
        const Matrix k1 = rate(Q);
        const Matrix k2 = rate(Q + h / 2 * k1);
        const Matrix k3 = rate(Q + h / 2 * k2);
        const Matrix k4 = rate(Q + h * k3);
        Q += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    const Matrix W = Q * velocity_of(Q.transpose() * L * Q, moments) * Q.transpose();
    return to_bivector(W.cast<double>());
}

}  // namespace tesserae::bench
