#pragma once

#include "core/contact/separating_axes.hpp"

namespace tesserae {

/// The contact solid under a cell of a: the cell of b that faces it, cut by the six side
/// hyperplanes of a's cell. Its vertices with a separation of at most `margin` (in units) along
/// that cell's normal, each with the faces that meet there.
///
/// Along the normal both cells are seen as parallelepipeds in three dimensions, and the solid is
/// what they share. Its vertices are b's inside a, a's inside b, b's edges crossing a's sides and
/// a's edges crossing b's; each edge is clipped by the other's three slabs (Cyrus and Beck 1978).
/// This gives the vertices that Sutherland-Hodgman cuts out cut by cut, but each on its own: no cut
/// builds on another's rounding, there are no caps, and both boxes' faces come along. The cell of b
/// is always seen at a steep angle: its normal has at least half of its length along a's.
/// Points on a clip plane (within kBoxSlack) are kept.
void clip_cell(const BoxPair& pair, const CellAxis& axis, double margin, BoxPoints& points);

}  // namespace tesserae
