// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact/box_distance.hpp"

namespace tesserae {

/// Finds where an edge of b meets a 2-face of a: the closest points of a line and a plane. If a
/// 2-face of b through that edge is parallel to the axis too (its separation changes by at most
/// `bias`), the two 2-faces share a segment, and its two ends are taken. Otherwise boxes that are
/// extruded 3D boxes would turn about one point. Requires axis.face_of_b = false.
void meet_at_edge(const BoxPair& pair, const EdgeAxis& axis, double bias, BoxPoints& points);

/// Finds the closest points of boxes that lie apart. If axes of a and b are parallel and the boxes
/// could slide along them while the separation changes by at most `bias`, all closest points form a
/// product of segments. Its corners are taken, at most eight.
void meet_at_witness(const BoxPair& pair, const BoxWitness& witness, double bias,
                     BoxPoints& points);

}  // namespace tesserae
