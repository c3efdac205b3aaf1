// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact/separating_axes.hpp"

namespace tesserae {

/// Finds the vertices of the contact solid under a cell of a. The solid is the cell of b that faces
/// it, cut by the six side hyperplanes of a's cell. Vertices with a separation of at most `margin`
/// [units] along that cell's normal are taken, each with the faces that meet there.
///
/// Along the normal both cells are parallelepipeds in three dimensions, and the solid is their
/// common part. Its vertices are b's inside a, a's inside b, b's edges crossing a's sides and a's
/// edges crossing b's. Each edge is clipped by the other's three slabs (Cyrus and Beck 1978). This
/// gives the same vertices as Sutherland-Hodgman, which cuts step by step, but each on its own: no
/// cut builds on another's rounding, there are no caps, and the faces of both boxes are known. The
/// cell of b is never seen edge-on: its normal has at least half of its length along a's.
/// Points on a clip plane (within kBoxSlack) are kept.
void clip_cell(const BoxPair& pair, const CellAxis& axis, double margin, BoxPoints& points);

}  // namespace tesserae
