#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hyperbox.hpp"

namespace tesserae {

/// At most 8 points, ascending by feature; none if the boxes' separation exceeds `margin` [m], at
/// least one otherwise. The separation is the distance of boxes apart and minus the least overlap
/// of all directions otherwise.
///
/// Points lie along one normal: a cell's, if its axis is within cell_bias() of the best or its
/// normal nearly is the best's, with the vertices of the contact solid under it; else the best axis
/// of an edge and a 2-face, with one point, or two where they meet along a segment; boxes apart
/// whose closest features span no axis have their closest points. Each point carries its own
/// separation along the normal; the least of them is the pair's separation within cell_bias(). A
/// feature names the two faces that meet, 81 (face of a) + (face of b) (see BoxFace).
void contacts_between(const Hyperbox& a, const Pose& pose_a, const Hyperbox& b, const Pose& pose_b,
                      double margin, PairContacts& out);

/// The points under one cell of one box, whichever features are closest: at most 8, ascending by
/// feature, each with its separation along the cell's normal; none where nothing is over the cell.
/// @param face_of_b   the cell is b's, otherwise a's
/// @param outward     near the cell's normal, world
void contacts_over_face(const Hyperbox& a, const Pose& pose_a, const Hyperbox& b,
                        const Pose& pose_b, bool face_of_b, const Vec4& outward, double margin,
                        PairContacts& out);

/// The feature of a vertex of one box over a cell of the other, both as contacts_between() names
/// it.
/// @param vertex      as hyperbox_hyperplane names it
/// @param face_of_b   the cell is b's, otherwise a's
/// @param normal      the cell's, in its box's frame
std::uint32_t feature_over_cell(const Hyperbox& a, const Hyperbox& b, bool face_of_b,
                                const Vec4& normal, std::uint32_t vertex);

}  // namespace tesserae
