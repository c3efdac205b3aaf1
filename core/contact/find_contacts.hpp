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
void find_contacts(BodyId a, const Shape& shape_a, const Pose& pose_a, BodyId b,
                   const Shape& shape_b, const Pose& pose_b, double margin,
                   std::vector<Contact>& list);

}  // namespace tesserae
