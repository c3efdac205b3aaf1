// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hyperbox.hpp"
#include "core/shape/hypercapsule.hpp"

namespace tesserae {

/// Finds at most two points whose separation is at most `margin` [m], with one normal. The first is
/// where the core is closest to the box, or where their overlap is least. If that is at a cell or
/// nearly so, the second is the other end of the stretch of the core over the cell.
/// Features are 0 and 1 for the core's ends towards the capsule's -y and +y; 2 + 2 i + side where
/// the stretch ends at the border of the box across its axis i (side 1: the positive one); 10 for a
/// point between that belongs to an edge or a vertex of the box.
/// A core that meets the box is moved out along the best of the ten normals of the facets of their
/// Minkowski difference. Among equally good ones a cell's normal is taken, the one across the
/// lowest axis.
void contacts_between(const Hypercapsule& capsule, const Pose& pose, const Hyperbox& box,
                      const Pose& box_pose, double margin, PairContacts& out);

/// Finds the points over one cell of the box, whichever features are closest: at most 2, with their
/// separations along the cell's normal. There are none if the core does not pass over the cell.
/// @param outward   a direction near the cell's normal, world
void contacts_over_face(const Hypercapsule& capsule, const Pose& pose, const Hyperbox& box,
                        const Pose& box_pose, bool face_of_box, const Vec4& outward, double margin,
                        PairContacts& out);

}  // namespace tesserae
