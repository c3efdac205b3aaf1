// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hypersphere.hpp"

namespace tesserae {

/// Finds the contact of a hypersphere with any bounded shape from the shape's own distance and
/// gradient at the sphere's centre, which may be outside, on the core or inside. There is at most
/// one point, feature 0, if the separation is at most `margin` [m].
template <class S>
void sphere_contacts(const Hypersphere& sphere, const Pose& pose, const S& shape,
                     const Pose& shape_pose, double margin, PairContacts& out) {
    const Mat4 rotation = to_matrix(shape_pose.rotor);
    const Vec4 centre = rotation.transpose() * (pose.position - shape_pose.position);
    const double separation = signed_distance(shape, centre) - sphere.radius;
    if (!(separation <= margin)) return;
    const Vec4 outward = rotation * normal(shape, centre);
    const Vec4 point = pose.position - (sphere.radius + 0.5 * separation) * outward;
    out.add(0, -outward, separation, point);
}

}  // namespace tesserae
