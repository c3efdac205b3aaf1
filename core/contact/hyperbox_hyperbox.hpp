// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hyperbox.hpp"

namespace tesserae {

/// Finds the contact points of two boxes: at most 8, ascending by feature. There are none if the
/// boxes' separation exceeds `margin` [m], otherwise at least one. The separation is the distance
/// if the boxes lie apart, and minus the least overlap of all directions otherwise.
///
/// Points lie along one normal. It is a cell's if its axis is within cell_bias() of the best or its
/// normal nearly is the best's; the points are then the vertices of the contact solid under the
/// cell. Else it is the best axis of an edge and a 2-face, with one point, or two where they meet
/// along a segment. Boxes apart whose closest features span no axis have their closest points. Each
/// point has its own separation along the normal; the least of them is the pair's separation within
/// cell_bias(). A feature names the two faces that meet, 81 (face of a) + (face of b) (see
/// BoxFace).
void contacts_between(const Hyperbox& a, const Pose& pose_a, const Hyperbox& b, const Pose& pose_b,
                      double margin, PairContacts& out);

/// Finds the points under one cell of one box, whichever features are closest: at most 8, ascending
/// by feature. Each has its separation along the cell's normal. There are none if nothing is over
/// the cell.
/// @param face_of_b   the cell belongs to b, otherwise to a
/// @param outward     a direction near the cell's normal, world
void contacts_over_face(const Hyperbox& a, const Pose& pose_a, const Hyperbox& b,
                        const Pose& pose_b, bool face_of_b, const Vec4& outward, double margin,
                        PairContacts& out);

/// Returns the feature that contacts_between() gives to a vertex of one box over a cell of the
/// other.
/// @param vertex      the feature that hyperbox_hyperplane gives to the vertex
/// @param face_of_b   the cell belongs to b, otherwise to a
/// @param normal      the cell's, in its box's frame
std::uint32_t feature_over_cell(const Hyperbox& a, const Hyperbox& b, bool face_of_b,
                                const Vec4& normal, std::uint32_t vertex);

}  // namespace tesserae
