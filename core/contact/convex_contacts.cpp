// SPDX-License-Identifier: Apache-2.0
#include "core/contact/convex_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/contact/manifold.hpp"

namespace tesserae {
namespace {

/// Separations along a cell's normal that are this part of the size from the largest are it: bodies
/// that lie on a cell do not lose it by rounding.
constexpr double kFlushHeight = 1e-11;
/// A normal with this much of a cell's has more points over that cell (25 degrees), and a piece
/// that faces it so is one that points of the cell lie over.
constexpr double kCellPart = 0.9;
/// The same for a cell whose sides are flat (72 degrees). Along its ridge, a polygon, another
/// body's cell may lie: one point would be at another place of it each step.
constexpr double kRidgePart = 0.3;
/// Cells are larger by this part of the size for clipping, so that a body that lies along a border
/// does not lose and win points by rounding.
constexpr double kBorder = 1e-10;

/// Points nearer than this part of the size are one.
constexpr double kSamePoint = 1e-6;
/// Separations that differ by less than this part of the size are one: it is how much bodies at
/// rest still rock.
constexpr double kAsNear = 1e-7;

// What a point is called: what kind it is, whose, and of which vertices.
enum class PointKind : std::uint32_t { kNearest, kVertex, kEdgeBegin, kEdgeEnd, kCrossing };
std::uint32_t name_of(PointKind kind, bool of_b, std::uint32_t first, std::uint32_t second) {
    return static_cast<std::uint32_t>(kind) << 28 | (of_b ? 1u << 27 : 0u) | first << 12 | second;
}

/// What a piece is within, beside its plane.
struct Sides {
    std::vector<HalfSpace> flat;
    std::vector<RoundSide> round;
};

/// How far a point is out of a round side, and the way out.
Level level_of(const RoundSide& side, const Vec4& p) {
    const Vec4 from = side.axes * (p - side.centre);
    const double distance = from.norm();
    return {distance - side.radius, distance > 0 ? Vec4(from / distance) : Vec4(Vec4::Zero())};
}

bool is_within(const Vec4& p, const Sides& sides, double border) {
    return std::all_of(
               sides.flat.begin(), sides.flat.end(),
               [&](const HalfSpace& side) { return side.normal.dot(p) - side.offset <= border; }) &&
           std::all_of(sides.round.begin(), sides.round.end(), [&](const RoundSide& side) {
               return (side.axes * (p - side.centre)).norm() <= side.radius + border;
           });
}

/// The part of the segment p + t d with 0 <= t <= 1 that is within all sides.
struct Clipped {
    double begin = 0, end = 1;
    bool is_empty() const { return !(begin <= end); }
};
Clipped clipped(const Vec4& p, const Vec4& d, const Sides& sides, double border) {
    Clipped part;
    for (const HalfSpace& side : sides.flat) {
        const double height = side.normal.dot(p) - side.offset - border;
        const double slope = side.normal.dot(d);
        if (slope == 0) {
            if (height > 0) return {1, 0};
            continue;
        }
        const double meets = -height / slope;
        if (slope < 0)
            part.begin = std::max(part.begin, meets);
        else
            part.end = std::min(part.end, meets);
    }
    for (const RoundSide& side : sides.round) {
        const Vec4 from = side.axes * (p - side.centre), along = side.axes * d;
        const double radius = side.radius + border, square = along.squaredNorm();
        const double outside = from.squaredNorm() - radius * radius;
        if (square == 0) {
            if (outside > 0) return {1, 0};
            continue;
        }
        const double middle = -from.dot(along) / square;
        const double half = middle * middle - outside / square;
        if (!(half >= 0)) return {1, 0};
        part.begin = std::max(part.begin, middle - std::sqrt(half));
        part.end = std::min(part.end, middle + std::sqrt(half));
    }
    return part;
}

/// A thread's own, from pair to pair: a pair's few points should not have to ask for memory.
struct Scratch {
    SurfacePiece a, b;
    Sides sides;
    std::vector<ContactPoint> points;

    void clear() {
        for (SurfacePiece* piece : {&a, &b}) {
            piece->sides.clear(), piece->round_sides.clear(), piece->vertices.clear();
            piece->names.clear(), piece->edges.clear();
            piece->is_flat = false, piece->top.radius = 0;
        }
        points.clear();
    }
};

/// Gathers a pair's points along one normal.
class PieceContacts {
  public:
    PieceContacts(const Vec4& normal, double radius_a, double radius_b, double size,
                  Scratch& scratch)
        : normal_(normal),
          radius_a_(radius_a),
          radius_b_(radius_b),
          size_(size),
          border_(kBorder * size),
          points_(scratch.points),
          sides_(scratch.sides) {}

    /// Corners of a piece that lie over a cell, and where the cell's edges cross a piece with an
    /// area, as of a cubinder that lies on a narrower box.
    /// @param of_b   the piece is b's and the cell a's, or the other way round
    void add_over_cell(const SurfacePiece& piece, bool of_b, const SurfacePiece& cell) {
        const double rise = (of_b ? 1 : -1) * cell.plane.normal.dot(normal_);
        const double least = cell.round_sides.empty() ? kRidgePart : kCellPart;
        if (!cell.is_flat || !(rise >= least)) return;
        // Where a cell leans, a border makes points deeper.
        const double leans = std::min(1.0, rise / kCellPart);
        border_ = leans * leans * kBorder * size_;
        find_sides_along_normal(cell);
        add_corners(piece, of_b, [&](const Vec4& p) {
            return (cell.plane.normal.dot(p) - cell.plane.offset) / rise;
        });
        // Of a disc times something of two dimensions.
        if (piece.top.radius > 0 && piece.top.axes.trace() < 2.5)
            add_crossings(piece, of_b, cell, rise);
    }

    /// Corners of a piece that lie beside another, neither of them flat, and look the same way.
    /// @param level   of the other body's core: near an end that is what the end says, and so taken
    ///                only where the piece does not say what it is a part of
    void add_beside(const SurfacePiece& piece, bool of_b, const SurfacePiece& other,
                    const FunctionRef<Level(const Vec4&)>& level) {
        if (piece.is_flat || other.is_flat) return;
        border_ = kBorder * size_;
        sides_.flat = other.sides, sides_.round = other.round_sides;
        add_corners(piece, of_b, [&](const Vec4& p) {
            const Level there = other.top.radius > 0 ? level_of(other.top, p) : level(p);
            const double rise = (of_b ? 1 : -1) * there.gradient.dot(normal_);
            return rise >= kCellPart ? there.value : kMiss;
        });
    }

    /// The nearest points; another that is as near stands for them: of flat pieces that lie on each
    /// other it would be another place each step, which no warm start survives. It is at their
    /// place if it is there but for the border.
    void add_nearest(const ConvexSeparation& nearest, double separation) {
        const Vec4 middle =
            0.5 * (nearest.on_a + nearest.on_b) + 0.5 * (radius_a_ - radius_b_) * normal_;
        for (ContactPoint& point : points_)
            if (point.separation <= separation + kAsNear * size_) {
                point.separation = separation;
                if (are_one(point.point, middle)) point.point = middle;
                return;
            }
        points_.push_back({middle, separation, name_of(PointKind::kNearest, false, 0, 0)});
    }

    /// @param separation   of the pair: corners a hair beyond a border are no nearer
    void put(double separation, const Vec4& origin, double margin, PairContacts& out) {
        for (ContactPoint& p : points_) p.separation = std::max(p.separation, separation);
        std::erase_if(points_, [&](const ContactPoint& p) { return !(p.separation <= margin); });
        const auto is_before = [](const ContactPoint& p, const ContactPoint& q) {
            return p.separation != q.separation ? p.separation < q.separation
                                                : p.feature < q.feature;
        };
        if (points_.size() > kManifoldInput) {
            std::sort(points_.begin(), points_.end(), is_before);
            points_.resize(kManifoldInput);
        }
        const std::size_t count = reduce_manifold(points_, normal_);
        for (std::size_t i = 0; i < count; ++i)
            out.add(points_[i].feature, normal_, points_[i].separation, origin + points_[i].point);
    }

  private:
    /// Corners of a piece within sides_.
    /// @param height_of   a core's point over the other, along the normal; none: kMiss
    template <class HeightOf>
    void add_corners(const SurfacePiece& piece, bool of_b, HeightOf&& height_of) {
        const auto add = [&](const Vec4& p, std::uint32_t name) {
            const double height = height_of(p);
            if (height < kMiss) add_point(p, height, of_b, name);
        };
        for (std::size_t i = 0; i < piece.vertices.size(); ++i)
            if (is_within(piece.vertices[i], sides_, border_))
                add(piece.vertices[i], name_of(PointKind::kVertex, of_b, piece.names[i], 0));
        for (const auto& edge : piece.edges) {
            const std::size_t from = edge[0], to = edge[1];
            const Vec4 &p = piece.vertices[from], d = piece.vertices[to] - p;
            const Clipped part = clipped(p, d, sides_, border_);
            if (part.is_empty()) continue;
            const auto name = [&](PointKind kind) {
                return name_of(kind, of_b, piece.names[from], piece.names[to]);
            };
            if (part.begin > 0) add(p + part.begin * d, name(PointKind::kEdgeBegin));
            if (part.end < 1) add(p + part.end * d, name(PointKind::kEdgeEnd));
        }
    }

    /// Where edges of a cell lie over a piece that is level in two dimensions.
    void add_crossings(const SurfacePiece& piece, bool of_b, const SurfacePiece& cell,
                       double rise) {
        // Of the disc's plane: up from the piece and across it.
        const Vec4 up = stable_normalized(piece.top.axes * normal_);
        Vec4 across = Vec4::Zero();
        for (int i = 0; i < 4; ++i) {
            const Vec4 axis = piece.top.axes.col(i) - up[i] * up;
            if (axis.squaredNorm() > across.squaredNorm()) across = axis;
        }
        const Vec4& level = piece.vertices[0];
        sides_.flat = piece.sides, sides_.round = piece.round_sides;
        for (const auto& [from, to] : cell.edges) {
            const Vec4 &p = cell.vertices[from], d = cell.vertices[to] - p;
            const double slope = across.dot(d), t = -across.dot(p - level) / slope;
            if (slope == 0 || !(t >= 0 && t <= 1)) continue;
            const Vec4 on_edge = p + t * d;
            const Vec4 on_piece = on_edge - up.dot(on_edge - level) / up.dot(normal_) * normal_;
            if (!is_within(on_piece, sides_, border_)) continue;
            add_point(on_piece, (cell.plane.normal.dot(on_piece) - cell.plane.offset) / rise, of_b,
                      name_of(PointKind::kCrossing, !of_b, cell.names[from], cell.names[to]));
        }
    }

    /// What holds the points that lie over a cell, seen along the contact's normal.
    void find_sides_along_normal(const SurfacePiece& cell) {
        const HalfSpace& plane = cell.plane;
        const double rise = plane.normal.dot(normal_);
        sides_.flat = cell.sides, sides_.round = cell.round_sides;
        for (HalfSpace& side : sides_.flat) {
            const double lean = side.normal.dot(normal_) / rise;
            side.normal -= lean * plane.normal;
            side.offset -= lean * plane.offset;
        }
        for (RoundSide& side : sides_.round) {
            side.centre += (plane.offset - plane.normal.dot(side.centre)) * plane.normal;
            side.axes -= side.axes * normal_ * (plane.normal / rise).transpose();
        }
    }
    /// @param height   of a core's point over the other's plane, along the normal
    void add_point(const Vec4& p, double height, bool of_b, std::uint32_t name) {
        const double separation = height - radius_a_ - radius_b_;
        const Vec4 to_other = of_b ? Vec4(-normal_) : normal_;
        const double own = of_b ? radius_b_ : radius_a_;
        const Vec4 middle = p + (own + 0.5 * separation) * to_other;
        // Where corners of both bodies meet they are one point.
        for (const ContactPoint& point : points_)
            if (are_one(point.point, middle)) return;
        points_.push_back({middle, separation, name});
    }
    bool are_one(const Vec4& p, const Vec4& q) const {
        const double near = kSamePoint * size_;
        return (p - q).squaredNorm() <= near * near;
    }

    const Vec4& normal_;
    double radius_a_, radius_b_, size_, border_;
    std::vector<ContactPoint>& points_;
    Sides& sides_;
};

/// How far apart two cores are along a direction.
double gap_along(const ConvexBody& a, const ConvexBody& b, const Vec4& direction) {
    return direction.dot(b.core(-direction)) - direction.dot(a.core(direction));
}

}  // namespace

void convex_contacts(const ConvexBody& a, const ConvexBody& b, const ConvexSeparation& nearest,
                     double size, const Vec4& origin, double margin, PairContacts& out) {
    const double radii = a.radius + b.radius;
    out.apart = nearest.distance - radii;
    if (!(out.apart <= margin)) return;
    Vec4 normal = nearest.normal;
    double distance = nearest.distance;
    thread_local Scratch scratch;
    scratch.clear();
    SurfacePiece &of_a = scratch.a, &of_b = scratch.b;
    a.surface_piece(normal, of_a);
    b.surface_piece(-normal, of_b);
    // A cell's own normal, where it serves as well.
    const auto try_normal = [&](const SurfacePiece& piece, double sign) {
        if (!piece.is_flat) return false;
        const Vec4 own = sign * piece.plane.normal;
        const double gap = gap_along(a, b, own);
        if (!(gap >= nearest.distance - kFlushHeight * size)) return false;
        normal = own, distance = gap;
        return true;
    };
    if (!try_normal(of_a, 1)) try_normal(of_b, -1);

    PieceContacts points(normal, a.radius, b.radius, size, scratch);
    points.add_over_cell(of_b, true, of_a);
    points.add_over_cell(of_a, false, of_b);
    points.add_beside(of_b, true, of_a, a.level);
    points.add_beside(of_a, false, of_b, b.level);
    points.add_nearest(nearest, distance - radii);
    points.put(distance - radii, origin, margin, out);
}

void convex_contacts_over_face(const ConvexBody& a, const ConvexBody& b, bool face_of_b,
                               const Vec4& outward, double size, const Vec4& origin, double margin,
                               PairContacts& out) {
    thread_local Scratch scratch;
    scratch.clear();
    SurfacePiece& cell = face_of_b ? scratch.b : scratch.a;
    (face_of_b ? b : a).surface_piece(outward, cell);
    const Vec4 normal = face_of_b ? Vec4(-cell.plane.normal) : cell.plane.normal;
    if (face_of_b)
        a.surface_piece(normal, scratch.a);
    else
        b.surface_piece(-normal, scratch.b);
    PieceContacts points(normal, a.radius, b.radius, size, scratch);
    points.add_over_cell(scratch.b, true, scratch.a);
    points.add_over_cell(scratch.a, false, scratch.b);
    points.put(-kMiss, origin, margin, out);
}

std::uint32_t feature_of_corner(bool of_b, std::uint32_t name) {
    return name_of(PointKind::kVertex, of_b, name, 0);
}

}  // namespace tesserae
