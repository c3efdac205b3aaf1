#pragma once

#include <memory>
#include <vector>

#include "core/convex/hull.hpp"
#include "core/convex/linear_forms.hpp"
#include "core/convex/principal_axes.hpp"
#include "core/shape/room.hpp"

namespace tesserae {

struct PolychoronBody;

/// Which regular polychoron; its vertices stand as FORMATS.md says.
enum class RegularPolychoron { kNone, k5Cell, k8Cell, k16Cell, k24Cell, k120Cell, k600Cell };

/// The convex hull of points, about its centre of mass.
struct Polychoron {
    static constexpr const char* kName = "polychoron";
    static constexpr bool kBounded = true;

    std::vector<Vec4> vertices;  ///< points [m]; empty if regular
    RegularPolychoron regular = RegularPolychoron::k5Cell;
    double radius = 1;  ///< circumradius, if regular [m], > 0

    std::shared_ptr<const PolychoronBody> body;  ///< complete() makes it; equal ones share it

    friend bool operator==(const Polychoron& a, const Polychoron& b) {
        return a.vertices == b.vertices && a.regular == b.regular && a.radius == b.radius;
    }
    /// Those in use.
    template <class Self, class Visit>
    static void parameters(Self& self, Visit&& visit) {
        if (self.regular == RegularPolychoron::kNone) {
            visit("vertices", self.vertices, Rule::kFinite);
        } else {
            visit("regular", self.regular, Rule::kFinite);
            visit("radius", self.radius, Rule::kPositive);
        }
    }
};

/// What a hull's functions need, made once.
struct PolychoronBody {
    explicit PolychoronBody(Hull hull);

    Hull hull;
    LinearForms corners;  ///< x . vertex
    LinearForms planes;   ///< of the cells
    LinearForms normals;  ///< x . a cell's normal
    double radius = 0;    ///< of the ball about the centre
    PrincipalAxes axes;   ///< of 1 kg and a hull of size 1
};

/// Makes the hull.
/// @throws InputError   as hull_of()
void complete(Polychoron&);
double volume(const Polychoron& shape);
/// Along its principal axes.
Vec4 second_moments(const Polychoron& shape, double mass);
/// What takes them to the body's axes; null if they are those.
const Rotor* principal_axes(const Polychoron& shape);
double bounding_radius(const Polychoron& shape);
Vec4 half_extents(const Polychoron& shape, const Mat4& rotation);
double half_extent_along(const Polychoron& shape, const Vec4& direction);
Vec4 support(const Polychoron& shape, const Vec4& direction);
double signed_distance(const Polychoron& shape, const Vec4& point);
Vec4 normal(const Polychoron& shape, const Vec4& point);
double ray_hit(const Polychoron& shape, const Vec4& origin, const Vec4& direction);
double ray_exit(const Polychoron& shape, const Vec4& origin, const Vec4& direction);
/// Of a point of the surface: the mean of the normals of all cells there. In a slice two cells may
/// be as one, and which of them is nearer is rounding.
Vec4 shading_normal(const Polychoron& shape, const Vec4& point);
/// The largest of the cells' planes' distances.
Level quick_level(const Polychoron& shape, const Vec4& point);
Rim rim(const Polychoron& shape, const Vec4& origin, const Vec4& direction, const RimRange& range);

/// Memory of what equal polychora share.
std::size_t shared_bytes(const Polychoron& shape);

/// As scene files call them, in their order from k5Cell on.
constexpr const char* kRegularNames[] = {"5-cell",  "8-cell",   "16-cell",
                                         "24-cell", "120-cell", "600-cell"};
/// The vertices of a regular polychoron, on the unit sphere.
std::vector<Vec4> regular_vertices(RegularPolychoron which);

}  // namespace tesserae
