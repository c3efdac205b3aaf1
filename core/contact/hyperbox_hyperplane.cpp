// SPDX-License-Identifier: Apache-2.0
#include "core/contact/hyperbox_hyperplane.hpp"

#include <array>

#include "core/contact/manifold.hpp"

namespace tesserae {

void contacts_between(const Hyperbox& box, const Pose& pose, const Hyperplane& plane, const Pose&,
                      double margin, PairContacts& out) {
    // What half an edge along each axis rises above the plane.
    const double height = plane.normal.dot(pose.position) - plane.offset;
    const Mat4 edges = to_matrix(pose.rotor) * (0.5 * box.size).asDiagonal();
    const Vec4 rises = edges.transpose() * plane.normal;
    if (!(height - rises.cwiseAbs().sum() <= margin)) return;

    std::array<ContactPoint, 16> points;
    std::size_t count = 0;
    for (std::uint32_t vertex = 0; vertex < 16; ++vertex) {
        Vec4 side;
        for (int i = 0; i < 4; ++i) side[i] = (vertex >> i & 1u) != 0 ? 1 : -1;
        const double separation = height + rises.dot(side);
        if (!(separation <= margin)) continue;
        const Vec4 point = pose.position + edges * side - 0.5 * separation * plane.normal;
        points[count++] = {point, separation, vertex};
    }

    count = reduce_corners({points.data(), count}, plane.normal);
    for (std::size_t i = 0; i < count; ++i)
        out.add(points[i].feature, -plane.normal, points[i].separation, points[i].point);
}

}  // namespace tesserae
