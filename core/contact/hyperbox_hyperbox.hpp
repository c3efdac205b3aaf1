#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hyperbox.hpp"

namespace tesserae {

/// At most 8 points, ascending by feature; none if the boxes' separation exceeds `margin` [m], at
/// least one otherwise. The separation is the distance of boxes apart and minus the least overlap
/// of all directions otherwise.
///
/// Points lie along one normal: a cell's, if its axis is within cell_bias() of the best, with the
/// vertices of the contact solid under it; else the best axis of an edge and a 2-face, with one
/// point, or two where they meet along a segment; boxes apart whose closest features span no axis
/// have their closest points. Each point carries its own separation along the normal; the least of
/// them is the pair's separation within cell_bias().
/// A feature names the two faces that meet, 81 (face of a) + (face of b) (see BoxFace).
void contacts_between(const Hyperbox& a, const Pose& pose_a, const Hyperbox& b, const Pose& pose_b,
                      double margin, PairContacts& out);

}  // namespace tesserae
