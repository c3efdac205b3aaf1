// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/shape/shape.hpp"
#include "render/description.hpp"

namespace tesserae::render {

/// Where on a body's surface a pattern is asked for.
struct PatternPoint {
    const Shape& shape;
    Vec4 local;     ///< in the body's frame [m]; a hyperplane's is the world
    Vec4 normal;    ///< unit, out of the body, in its frame
    double w = 0;   ///< of the point, in the world [m]
    double body_w;  ///< of the body's centre, in the world [m]
};

/// Colour of a material with a pattern at a point of a surface.
/// Checker, stripes and noise are functions of the body's four axes, see colour_in_space(). Grid
/// has lines where the surface meets the hyperplanes x_i = k pattern_size of those axes. Edges has
/// them where two cells of a box or a polytope meet, cells a hue for each cell of them; other
/// shapes have the plain albedo. Lines are line_width wide, measured along the surface. W
/// multiplies the albedo by kSideColors, through white at w = 0, in full at pattern_size.
Color pattern_albedo(const Material& material, const PatternPoint& at);

/// Colour of a pattern that is a function of space, at a point of it. Checker: cells of edge
/// pattern_size, one of them centred on the origin, coloured by the parity of their four indices.
/// Stripes: slabs of width pattern_size across the x axis, one of them centred on the origin. Odd
/// cells have the pattern's albedo. Noise: smooth random values at the corners of cells, and two
/// finer octaves of them.
Color colour_in_space(const Material& material, const Vec4& point);

/// The number of the cell of a box or polytope on which a point of its surface lies: of a box twice
/// the axis, and one more on the positive side; of a polytope the cell's place in its hull. -1 for
/// other shapes.
/// @param normal   out of the body, in its frame
int cell_number(const Shape& shape, const Vec4& normal);

/// How far a point of a box's or polytope's surface is from the next cell, along its own cell [m];
/// infinite for other shapes.
double distance_to_edge(const Shape& shape, const Vec4& point, const Vec4& normal);

}  // namespace tesserae::render
