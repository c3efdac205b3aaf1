#pragma once

#include "core/contact/box_distance.hpp"

namespace tesserae {

/// Where an edge of b meets a 2-face of a: the closest points of a line and a plane. If a 2-face of
/// b through that edge is parallel to the axis too (its separation changes by at most `bias`), the
/// two 2-faces share a segment and its two ends are taken: boxes that are extruded 3D boxes would
/// else turn about one point. Needs axis.face_of_b = false.
void meet_at_edge(const BoxPair& pair, const EdgeAxis& axis, double bias, BoxPoints& points);

/// The closest points of boxes apart. If axes of a and b are parallel and the boxes could slide
/// along them without the separation changing by more than `bias`, all closest points are a product
/// of segments: its corners are taken, at most eight.
void meet_at_witness(const BoxPair& pair, const BoxWitness& witness, double bias,
                     BoxPoints& points);

}  // namespace tesserae
