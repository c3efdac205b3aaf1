// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/shape.hpp"

namespace tesserae {

/// Appends the contact points of bodies a < b whose separation is at most `margin` [m], ascending
/// by feature. At least one shape must be bounded.
///
/// All calls of pair functions come from here. The contacts_between() of a pair takes its shapes in
/// either order, and its header is included in find_contacts.cpp; nothing else is edited. A shape
/// that lacks a pair does not compile.
/// @return PairContacts::apart
double find_contacts(BodyId a, const Shape& shape_a, const Pose& pose_a, BodyId b,
                     const Shape& shape_b, const Pose& pose_b, double margin,
                     std::vector<Contact>& list);

/// Appends the contact points of two bodies, one of which lies over a face of the other. They are
/// along the face's normal, whichever features are closest. Shapes with only one point get none: if
/// it lies over the face, it is the closest point anyway.
/// @param face_of_b   the face belongs to b, otherwise to a
/// @param outward     a direction near the face's normal, world
void find_contacts_over_face(BodyId a, const Shape& shape_a, const Pose& pose_a, BodyId b,
                             const Shape& shape_b, const Pose& pose_b, bool face_of_b,
                             const Vec4& outward, double margin, std::vector<Contact>& list);

/// Returns the feature that find_contacts() gives to a point of one body over a face of the other.
/// @param on_plane   the feature of the same point over a hyperplane in place of the face
/// @param outward    the face's normal, in its body's frame
std::uint32_t feature_over_face(const Shape& shape_a, const Shape& shape_b, bool face_of_b,
                                const Vec4& outward, std::uint32_t on_plane);

}  // namespace tesserae
