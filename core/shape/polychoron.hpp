// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/shape/hull_shape.hpp"

namespace tesserae {

/// Names a regular polychoron. scenes/FORMATS.md says where its vertices are.
enum class RegularPolychoron { kNone, k5Cell, k8Cell, k16Cell, k24Cell, k120Cell, k600Cell };

/// A Polychoron is the convex hull of points, or a regular polychoron, about its centre of mass.
struct Polychoron : HullShape {
    static constexpr const char* kName = "polychoron";
    static constexpr bool kBounded = true;

    std::vector<Vec4> vertices;  ///< points [m]; empty if regular
    RegularPolychoron regular = RegularPolychoron::k5Cell;
    double radius = 1;  ///< circumradius, if regular [m], > 0

    friend bool operator==(const Polychoron& a, const Polychoron& b) {
        return a.vertices == b.vertices && a.regular == b.regular && a.radius == b.radius;
    }
    /// Visits only the parameters in use: the vertices, or the name and the radius.
    template <class Self, class Visit>
    static void parameters(Self& self, Visit&& visit) {
        if (self.regular == RegularPolychoron::kNone) {
            visit({"vertices", "m",
                   "The body is the convex hull of these points, about its centre of mass; at "
                   "least five, not all in one flat space."},
                  self.vertices, Rule::kFinite);
        } else {
            visit({"regular", "",
                   "The body is this regular polychoron; it stands instead of vertices."},
                  self.regular, Rule::kFinite);
            visit({"radius", "m", "The vertices of a regular one are this far from its centre."},
                  self.radius, Rule::kPositive);
        }
    }
};

/// Makes the hull from the parameters.
/// @throws InputError   as hull_of()
void complete(Polychoron&);

/// Scene files use these names for the regular polychora, in their order from k5Cell on.
constexpr const char* kRegularNames[] = {"5-cell",  "8-cell",   "16-cell",
                                         "24-cell", "120-cell", "600-cell"};
/// Returns the vertices of a regular polychoron, on the unit sphere.
std::vector<Vec4> regular_vertices(RegularPolychoron which);

}  // namespace tesserae
