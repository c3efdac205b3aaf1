#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/shape.hpp"

namespace tesserae {

/// The one way into the pair functions. A pair's contacts_between() is written for its shapes in
/// either order and its header is included in find_contacts.cpp; nothing else is edited. A shape
/// that lacks a pair does not compile.
///
/// Appends the contact points of bodies a < b whose separation is at most `margin` [m], ascending
/// by feature. At least one shape must be bounded.
/// @return PairContacts::apart
double find_contacts(BodyId a, const Shape& shape_a, const Pose& pose_a, BodyId b,
                     const Shape& shape_b, const Pose& pose_b, double margin,
                     std::vector<Contact>& list);

/// As above, of bodies of which one has a face that the other lies over: its points, along the
/// face's normal, whichever features are closest. None for shapes that have one point: if it lies
/// over the face it is the closest.
/// @param face_of_b   the face is b's, otherwise a's
/// @param outward     near the face's normal, world
void find_contacts_over_face(BodyId a, const Shape& shape_a, const Pose& pose_a, BodyId b,
                             const Shape& shape_b, const Pose& pose_b, bool face_of_b,
                             const Vec4& outward, double margin, std::vector<Contact>& list);

/// What find_contacts() calls a point of one body that lies over a face of the other.
/// @param on_plane   what it calls the point where there is a hyperplane in the face's place
/// @param outward    the face's normal, in its body's frame
std::uint32_t feature_over_face(const Shape& shape_a, const Shape& shape_b, bool face_of_b,
                                const Vec4& outward, std::uint32_t on_plane);

}  // namespace tesserae
