// SPDX-License-Identifier: Apache-2.0
#include "tests/core/shape/oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tesserae {
namespace {

/// The weights of the corners of a face, by which the face's space has the point nearest to the
/// origin: least squares by Gram-Schmidt on its edges from one corner. An edge that the others span
/// gets none.
std::vector<long double> wanted_weights(const std::vector<LVec>& face) {
    const std::size_t edges = face.size() - 1;
    std::array<LVec, 4> q;
    std::array<std::array<long double, 4>, 4> upper;
    std::array<long double, 4> along = {};
    std::array<std::size_t, 4> used = {};
    std::size_t count = 0;
    LVec rest = face[0];
    for (std::size_t k = 0; k < edges && count < 4; ++k) {
        const LVec edge = face[k + 1] - face[0];
        LVec& direction = q[count] = edge;
        for (std::size_t i = 0; i < count; ++i) {
            upper[i][count] = q[i].dot(direction);
            direction -= upper[i][count] * q[i];
        }
        const long double length = direction.norm();
        if (length <= 1e-18L * edge.norm()) continue;
        direction /= length;
        upper[count][count] = length;
        along[count] = -direction.dot(rest);
        rest += along[count] * direction;
        used[count++] = k + 1;
    }
    std::vector<long double> weights(face.size(), 0);
    weights[0] = 1;
    for (std::size_t k = count; k-- > 0;) {
        for (std::size_t j = k + 1; j < count; ++j) along[k] -= upper[k][j] * along[j];
        along[k] /= upper[k][k];
        weights[used[k]] = along[k];
        weights[0] -= along[k];
    }
    return weights;
}

const LVec& lowest_along(const LVec& x, const std::vector<LVec>& points) {
    const LVec* lowest = &points[0];
    long double least = lowest->dot(x);
    for (const LVec& p : points)
        if (const long double height = p.dot(x); height < least) lowest = &p, least = height;
    return *lowest;
}

}  // namespace

LVec nearest_of_hull(const std::vector<LVec>& points) {
    long double square = 0;
    for (const LVec& p : points) square = std::max(square, p.squaredNorm());
    const long double scale = std::sqrt(square);
    std::vector<LVec> face = {lowest_along(points[0], points)};
    std::vector<long double> weight = {1};
    LVec x = face[0];
    for (int step = 0; step < 1000; ++step) {
        const LVec next = lowest_along(x, points);
        if (x.dot(x - next) <= 1e-18L * scale * x.norm()) break;
        if (std::find(face.begin(), face.end(), next) != face.end()) break;
        face.push_back(next), weight.push_back(0);
        for (;;) {
            const std::vector<long double> wanted = wanted_weights(face);
            long double part = 1;
            for (std::size_t i = 0; i < face.size(); ++i)
                if (wanted[i] <= 0) part = std::min(part, weight[i] / (weight[i] - wanted[i]));
            for (std::size_t i = 0; i < face.size(); ++i)
                weight[i] += part * (wanted[i] - weight[i]);
            const bool is_inside = part == 1;
            for (std::size_t i = face.size(); i-- > 0;)
                if (weight[i] <= 1e-19L && face.size() > 1) {
                    face.erase(face.begin() + static_cast<std::ptrdiff_t>(i));
                    weight.erase(weight.begin() + static_cast<std::ptrdiff_t>(i));
                }
            if (is_inside) break;
        }
        x.setZero();
        for (std::size_t i = 0; i < face.size(); ++i) x += weight[i] * face[i];
    }
    return x;
}

}  // namespace tesserae
