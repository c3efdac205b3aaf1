#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hypersphere.hpp"

namespace tesserae {

/// A hypersphere against any bounded shape: the contact is the shape's own distance and gradient
/// at the sphere's centre, outside, on the core and inside. At most one point, feature 0, reported
/// when the separation is at most `margin` [m].
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
