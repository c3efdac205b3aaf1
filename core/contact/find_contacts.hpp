#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/shape.hpp"

namespace tesserae {

/// The one way into the pair functions. A pair of shapes is supported when a contacts_between()
/// for it exists, in either order; its header is included in find_contacts.cpp and nothing else
/// is edited.
bool is_supported(const Shape& a, const Shape& b);

/// Appends the contact points of bodies a < b whose separation is at most `margin` [m], ascending
/// by feature. Needs is_supported(shape_a, shape_b).
void find_contacts(BodyId a, const Shape& shape_a, const Pose& pose_a, BodyId b,
                   const Shape& shape_b, const Pose& pose_b, double margin,
                   std::vector<Contact>& list);

}  // namespace tesserae
