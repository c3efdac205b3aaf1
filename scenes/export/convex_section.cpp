// SPDX-License-Identifier: Apache-2.0
#include "scenes/export/convex_section.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "core/convex/qhull_facets.hpp"

namespace tesserae::scenes {
namespace {

/// A point beyond both polygons of an edge is seen along one of them or along the bisector within
/// 45 degrees of where it lies: held back there by this part of the tolerance, it is within it.
const double kSafePart = std::sqrt(0.5);

/// Points nearer to each other than this part of the body's size are one to the hull.
constexpr double kSamePoint = 1e-10;

/// Rounds after which points are no longer added: never met, but a mesh is worth more than a
/// program that does not end.
constexpr int kMostRounds = 64;

/// A section's farthest points.
class SectionSupport {
  public:
    SectionSupport(const Shape& shape, const PlacedShape& at)
        : shape_(shape), at_(at), down_(-at.turn.row(3).transpose()) {}

    /// The slice comes into the body.
    bool is_cut() const { return support(down_)[3] < 0 && support(-down_)[3] > 0; }

    /// A point of the section that is farthest along a unit direction. By Lagrange the body's
    /// farthest points along the direction, turned toward the height by an angle, sink or rise with
    /// it; at one angle they pass the slice. Where they jump past it, between two points of one
    /// flat piece of the body, the point in between is as far.
    Vec3 farthest(const Vec3& direction) const {
        const Vec4 along = at_.turn.transpose() * Vec4(direction[0], direction[1], direction[2], 0);
        const auto at_angle = [&](double angle) {
            return support(std::cos(angle) * along + std::sin(angle) * down_);
        };
        constexpr double kRight = 0.5 * std::numbers::pi;
        constexpr int kHalvings = 60;
        double low_angle = -kRight, high_angle = kRight;
        Vec4 high = at_angle(low_angle), low = at_angle(high_angle);
        for (int i = 0; i < kHalvings; ++i) {
            const double middle = 0.5 * (low_angle + high_angle);
            const Vec4 point = at_angle(middle);
            if (point[3] == 0) return point.head<3>();
            (point[3] > 0 ? low_angle : high_angle) = middle;
            (point[3] > 0 ? high : low) = point;
        }
        const double part = high[3] / (high[3] - low[3]);
        return ((1 - part) * high + part * low).head<3>();
    }

  private:
    /// @param direction   in the body's frame
    /// @return in the coordinates of the frame
    Vec4 support(const Vec4& direction) const {
        return at_.centre + at_.turn * std::visit(
                                           [&](const auto& s) -> Vec4 {
                                               return tesserae::support(s, direction);
                                           },
                                           shape_);
    }

    const Shape& shape_;
    const PlacedShape& at_;
    Vec4 down_;  ///< toward falling height, in the body's frame
};

/// The outward normal of a polygon, unit, by Newell's method; none of one without area.
std::optional<Vec3> normal_of(const Mesh& mesh, std::size_t face) {
    const auto corner = mesh.face(face);
    Vec3 sum = Vec3::Zero();
    const Vec3& from = mesh.vertices[corner[0]];
    for (std::size_t i = 2; i < corner.size(); ++i)
        sum += (mesh.vertices[corner[i - 1]] - from).cross(mesh.vertices[corner[i]] - from);
    const double length = sum.norm();
    if (!(length > 0)) return std::nullopt;
    return Vec3(sum / length);
}

/// Directions in which a section may reach beyond a mesh, each with a point of the mesh that is
/// farthest there.
struct Outlook {
    Vec3 direction, point;
};

/// The polygons' normals and, of every edge, the bisector of both sides' normals.
std::vector<Outlook> outlooks_of(const Mesh& mesh) {
    std::vector<Outlook> outlooks;
    std::map<std::pair<std::uint32_t, std::uint32_t>, Vec3> normal_at_edge;
    for (std::size_t f = 0; f < mesh.faces(); ++f) {
        const auto normal = normal_of(mesh, f);
        if (!normal) continue;
        const auto corner = mesh.face(f);
        outlooks.push_back({*normal, mesh.vertices[corner[0]]});
        for (std::size_t i = 0; i < corner.size(); ++i) {
            const std::uint32_t a = corner[i], b = corner[(i + 1) % corner.size()];
            const auto other = normal_at_edge.find({b, a});
            if (other == normal_at_edge.end()) {
                normal_at_edge.emplace(std::pair(a, b), *normal);
                continue;
            }
            const Vec3 sum = *normal + other->second;
            // Of a mesh as thin as paper any direction across is as good.
            if (sum.norm() > 1e-6) outlooks.push_back({sum.normalized(), mesh.vertices[a]});
        }
    }
    return outlooks;
}

/// Directions to begin with: corners, edges and faces of a cube, turned out of the axes, along
/// which bodies often have several farthest points.
std::vector<Vec3> first_directions() {
    std::vector<Vec3> directions;
    const Eigen::Quaterniond turn(0.83, 0.31, -0.42, 0.19);
    for (int x : {-1, 0, 1})
        for (int y : {-1, 0, 1})
            for (int z : {-1, 0, 1})
                if (x != 0 || y != 0 || z != 0)
                    directions.push_back(turn.normalized() * Vec3(x, y, z).normalized());
    return directions;
}

/// Points that span the section however thin it is: farthest along fixed directions, then about the
/// longest way between two of them, then across the widest plane through it.
std::vector<Vec3> first_points(const SectionSupport& section) {
    std::vector<Vec3> points;
    for (const Vec3& direction : first_directions()) points.push_back(section.farthest(direction));
    Vec3 way = Vec3::Zero();
    for (const Vec3& point : points)
        if ((point - points[0]).norm() > way.norm()) way = point - points[0];
    if (way.isZero(0)) return points;

    const Vec3 along = way.normalized(), across = along.unitOrthogonal();
    const Vec3 third = along.cross(across);
    Vec3 aside = Vec3::Zero();
    for (int i = 0; i < 8; ++i) {
        const double angle = 0.25 * std::numbers::pi * i + 0.1;
        points.push_back(section.farthest(std::cos(angle) * across + std::sin(angle) * third));
        const Vec3 from = points.back() - points[0], off = from - from.dot(along) * along;
        if (off.norm() > aside.norm()) aside = off;
    }
    if (aside.isZero(0)) return points;
    const Vec3 normal = along.cross(aside).normalized();
    points.push_back(section.farthest(normal));
    points.push_back(section.farthest(-normal));
    return points;
}

}  // namespace

Mesh hull_mesh(const std::vector<Vec3>& points) {
    Mesh mesh;
    std::vector<std::uint32_t> place(points.size(), ~std::uint32_t{0});
    for (std::vector<std::uint32_t>& polygon : qhull_polygons(points)) {
        for (std::uint32_t& corner : polygon) {
            if (place[corner] == ~std::uint32_t{0}) {
                place[corner] = static_cast<std::uint32_t>(mesh.vertices.size());
                mesh.vertices.push_back(points[corner]);
            }
            corner = place[corner];
        }
        mesh.add_face(polygon);
    }
    return mesh;
}

Mesh convex_section(const Shape& shape, const PlacedShape& at, double tolerance) {
    const SectionSupport section(shape, at);
    if (!section.is_cut()) return {};
    const double same = kSamePoint * bounding_radius(shape);
    std::vector<Vec3> points;
    const auto add = [&](const Vec3& point) {
        for (const Vec3& other : points)
            if ((point - other).cwiseAbs().maxCoeff() <= same) return false;
        points.push_back(point);
        return true;
    };
    for (const Vec3& point : first_points(section)) add(point);
    // Every round adds points that were beyond, usually in 5 to 12 rounds; one that adds none is
    // the last.
    bool is_growing = true;
    for (int round = 0; is_growing && round < kMostRounds; ++round) {
        is_growing = false;
        const Mesh mesh = hull_mesh(points);
        for (const Outlook& outlook : outlooks_of(mesh)) {
            const Vec3 point = section.farthest(outlook.direction);
            const double beyond = outlook.direction.dot(point - outlook.point);
            if (beyond > kSafePart * tolerance && add(point)) is_growing = true;
        }
    }
    return hull_mesh(points);
}

}  // namespace tesserae::scenes
