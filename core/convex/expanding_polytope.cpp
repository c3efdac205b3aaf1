// SPDX-License-Identifier: Apache-2.0
#include "core/convex/expanding_polytope.hpp"

#include <limits>
#include <memory>
#include <utility>

#include "core/convex/simplex.hpp"

namespace tesserae {
namespace {

using Index = std::int16_t;
using FacetCorners = std::array<Index, 4>;

constexpr double kNever = std::numeric_limits<double>::infinity();
/// Multiples of rounding. A point not farther above a facet's hyperplane is in it: less, and flat
/// facets of many points shatter; more, and it adds to the overlap's error.
constexpr double kInPlane = 16;
/// Bounds on memory and time. Differences of polytopes of some dozens of vertices need 10 to 60
/// vertices; a body that reaches the bounds counts as round.
constexpr int kMaxVertices = 256, kMaxFacets = 2048, kMaxHorizon = 1024;
/// From so many vertices on the body counts as round, and the end is at this gap between the bounds
/// [units]; what is finer is for polishing.
constexpr int kRoundVertices = 96;
constexpr double kRoundGap = 1e-4;
/// From so many vertices on the direction is offered at this gap [units], once: what converges fast
/// needs no better start.
constexpr int kRoughVertices = 32;
constexpr double kRoughGap = 1e-3;

/// Orthogonal to three vectors, as long as the content that they span is large; the side changes
/// when two of them are exchanged.
Vec4 cross(const Vec4& a, const Vec4& b, const Vec4& c) {
    const double xy = b[0] * c[1] - b[1] * c[0], xz = b[0] * c[2] - b[2] * c[0],
                 xw = b[0] * c[3] - b[3] * c[0], yz = b[1] * c[2] - b[2] * c[1],
                 yw = b[1] * c[3] - b[3] * c[1], zw = b[2] * c[3] - b[3] * c[2];
    return assembled(-(a[1] * zw - a[2] * yw + a[3] * yz), a[0] * zw - a[2] * xw + a[3] * xz,
                     -(a[0] * yw - a[1] * xw + a[3] * xy), a[0] * yz - a[1] * xz + a[2] * xy);
}

/// The unit normal by orthonormal edges: good for slivers too. Zero: the points span no hyperplane.
Vec4 exact_normal(const Vec4& a, const Vec4& b, const Vec4& c) {
    constexpr double kDependent = 1e-15;
    const Vec4* edges[] = {&a, &b, &c};
    Vec4 q[3];
    for (int k = 0; k < 3; ++k) {
        const Vec4 own = orthogonal_part(*edges[k], q, k);
        const double length = own.norm();
        if (!(length > kDependent * edges[k]->norm())) return Vec4::Zero();
        q[k] = own / length;
    }
    return cross(q[0], q[1], q[2]).normalized();
}

Vec4 normal_of_edges(const Vec4& a, const Vec4& b, const Vec4& c) {
    // Of a less upright tetrahedron the products lose too many digits.
    constexpr double kUpright = 1e-2;
    const Vec4 n = cross(a, b, c);
    const double square = n.squaredNorm();
    const double product = a.squaredNorm() * b.squaredNorm() * c.squaredNorm();
    if (square > kUpright * kUpright * product) return n / std::sqrt(square);
    return exact_normal(a, b, c);
}

/// Facet: a tetrahedron. Neighbour k shares the triangle without corner k.
struct Facet {
    Vec4 normal;  ///< outward
    double offset;
    FacetCorners corner, neighbour;
    int seen;  ///< by which expansion
};

/// A triangle between what the new vertex sees and what it does not, and the facet to be over it:
/// the one that is seen, with the new vertex for the corner that the triangle lacks, turned outward
/// as that was.
struct Horizon {
    Index seen, unseen, side;
    FacetCorners corner;
    FacetCorners link;  ///< over the triangle without corner k: which of the horizon
};

/// What the polytope lives in, kept from call to call.
struct Memory {
    std::array<DifferencePoint, kMaxVertices> vertex;
    std::array<Facet, kMaxFacets> facet;
    /// How near a facet is to the origin; kNever for places without a facet, and facets done with.
    std::array<double, kMaxFacets> key;
    std::array<Index, kMaxFacets> free, visible;
    std::array<Horizon, kMaxHorizon> horizon;
    std::array<Index, kMaxHorizon> place;
    /// Who waits for its neighbour over an edge of the horizon, 1 + 4 horizon + side; 0 for nobody.
    std::array<Index, kMaxVertices * kMaxVertices> waiting{};
};

class ExpandingPolytope {
  public:
    ExpandingPolytope(const MinkowskiDifference& difference,
                      const std::array<DifferencePoint, 5>& start, Memory& memory)
        : difference_(difference), memory_(memory), flat_(kInPlane * difference.rounding()) {
        for (const DifferencePoint& p : start)
            memory_.vertex[static_cast<std::size_t>(vertices_++)] = p;
        build_simplex();
    }

    std::optional<LeastOverlap> run(const TakesDirection& takes) {
        best_.depth = kNever;
        best_.is_exact = false;
        while (true) {
            const int nearest = nearest_facet();
            if (nearest < 0) break;
            const double low = key(nearest);
            if (low >= best_.depth - flat_) {
                best_.is_exact = true;
                break;
            }
            if (vertices_ >= kRoughVertices && best_.depth - low <= kRoughGap && !offered_) {
                offered_ = true;
                if (takes(best_.normal)) return std::nullopt;
            }
            if (vertices_ >= kRoundVertices && best_.depth - low <= kRoundGap) break;
            if (vertices_ == kMaxVertices) break;
            // Either it grows, or it is done with.
            if (!grow(nearest)) key(nearest) = kNever;
        }
        return best_;
    }

  private:
    Facet& facet(int f) { return memory_.facet[static_cast<std::size_t>(f)]; }
    double& key(int f) { return memory_.key[static_cast<std::size_t>(f)]; }
    Index& visible(int i) { return memory_.visible[static_cast<std::size_t>(i)]; }
    Horizon& horizon(int i) { return memory_.horizon[static_cast<std::size_t>(i)]; }
    Index& place(int i) { return memory_.place[static_cast<std::size_t>(i)]; }
    const Vec4& at(int v) const { return memory_.vertex[static_cast<std::size_t>(v)].at; }

    void build_simplex() {
        // Facet i lacks vertex i; they are turned outward alternately, all by one sign.
        const Vec4 n = exact_normal(at(1) - at(0), at(2) - at(0), at(3) - at(0));
        const bool outward = n.dot(at(4) - at(0)) < 0;
        for (int i = 0; i < 5; ++i) {
            FacetCorners corner, neighbour;
            for (int k = 0, v = 0; v < 5; ++v) {
                if (v == i) continue;
                corner[static_cast<std::size_t>(k)] = static_cast<Index>(v);
                neighbour[static_cast<std::size_t>(k)] = static_cast<Index>(v);
                ++k;
            }
            if (outward != (i % 2 == 0)) {
                std::swap(corner[0], corner[1]);
                std::swap(neighbour[0], neighbour[1]);
            }
            facets_ = i + 1;
            place_facet(i, corner, neighbour);
        }
    }

    void place_facet(int f, const FacetCorners& corner, const FacetCorners& neighbour) {
        const Vec4& base = at(corner[0]);
        const Vec4 n =
            normal_of_edges(at(corner[1]) - base, at(corner[2]) - base, at(corner[3]) - base);
        const double offset = n.dot(base);
        facet(f) = {n, offset, corner, neighbour, -1};
        key(f) = n.isZero(0) ? kNever : offset;
    }

    int nearest_facet() {
        double least = kNever;
        int nearest = -1;
        for (int f = 0; f < facets_; ++f)
            if (key(f) < least) least = key(f), nearest = f;
        return nearest;
    }

    /// Takes in the farthest point along a facet's normal. False: there is nothing to take in.
    bool grow(int f) {
        const Facet& from = facet(f);
        const DifferencePoint p = difference_.support(from.normal);
        const double depth = from.normal.dot(p.at);
        if (depth < best_.depth) {
            best_.normal = from.normal;
            best_.depth = depth;
            for (std::size_t k = 0; k < 4; ++k)
                best_.facet[k] = memory_.vertex[static_cast<std::size_t>(from.corner[k])];
        }
        if (!(depth - from.offset > flat_)) return false;
        for (int v = 0; v < vertices_; ++v)
            if (at(v) == p.at) return false;
        find_visible(f, p.at);
        if (!find_horizon()) return false;
        if (!link_horizon()) return false;
        memory_.vertex[static_cast<std::size_t>(vertices_++)] = p;
        replace_visible();
        return true;
    }

    /// All facets that the point sees, from one on over their neighbours.
    void find_visible(int first, const Vec4& point) {
        ++expansion_;
        visible_ = 1;
        memory_.visible[0] = static_cast<Index>(first);
        facet(first).seen = expansion_;
        for (int i = 0; i < visible_; ++i)
            for (const Index g : facet(visible(i)).neighbour) {
                Facet& next = facet(g);
                if (next.seen == expansion_) continue;
                if (!(next.normal.dot(point) - next.offset > flat_)) continue;
                next.seen = expansion_;
                visible(visible_++) = g;
            }
    }

    /// False: there is none, or too many facets would come of it.
    bool find_horizon() {
        const auto vertex = static_cast<Index>(vertices_);
        horizon_ = 0;
        for (int i = 0; i < visible_; ++i) {
            const Index f = visible(i);
            for (Index side = 0; side < 4; ++side) {
                const Index g = facet(f).neighbour[static_cast<std::size_t>(side)];
                if (facet(g).seen == expansion_) continue;
                if (horizon_ == kMaxHorizon) return false;
                Horizon& h = horizon(horizon_++);
                h = {f, g, side, facet(f).corner, {}};
                h.corner[static_cast<std::size_t>(side)] = vertex;
            }
        }
        return horizon_ > 0 && facets_ + horizon_ - free_ <= kMaxFacets;
    }

    Index& waiting(const Horizon& h, std::size_t side) {
        std::size_t edge[2], n = 0;
        for (std::size_t k = 0; k < 4; ++k)
            if (k != side && k != static_cast<std::size_t>(h.side))
                edge[n++] = static_cast<std::size_t>(h.corner[k]);
        if (edge[0] > edge[1]) std::swap(edge[0], edge[1]);
        return memory_.waiting[edge[0] * kMaxVertices + edge[1]];
    }

    /// Every edge of the horizon is of two of its triangles. False: not so, by rounding.
    bool link_horizon() {
        int open = 0;
        for (int i = 0; i < horizon_; ++i) {
            Horizon& h = horizon(i);
            for (std::size_t k = 0; k < 4; ++k) {
                if (k == static_cast<std::size_t>(h.side)) continue;
                Index& other = waiting(h, k);
                if (other == 0) {
                    other = static_cast<Index>(1 + 4 * i + static_cast<int>(k));
                    ++open;
                    continue;
                }
                const int partner = (other - 1) / 4;
                h.link[k] = static_cast<Index>(partner);
                horizon(partner).link[static_cast<std::size_t>((other - 1) % 4)] =
                    static_cast<Index>(i);
                other = 0;
                --open;
            }
        }
        if (open == 0) return true;
        for (int i = 0; i < horizon_; ++i)
            for (std::size_t k = 0; k < 4; ++k)
                if (k != static_cast<std::size_t>(horizon(i).side)) waiting(horizon(i), k) = 0;
        return false;
    }

    /// The visible facets make way for one facet over each triangle of the horizon.
    void replace_visible() {
        // None of the places that become free: neighbours know the old ones by them.
        for (int i = 0; i < horizon_; ++i)
            place(i) = free_ > 0 ? memory_.free[static_cast<std::size_t>(--free_)]
                                 : static_cast<Index>(facets_++);
        for (int i = 0; i < horizon_; ++i) {
            const Horizon& h = horizon(i);
            FacetCorners neighbour;
            for (std::size_t k = 0; k < 4; ++k)
                neighbour[k] = k == static_cast<std::size_t>(h.side) ? h.unseen : place(h.link[k]);
            place_facet(place(i), h.corner, neighbour);
            for (Index& g : facet(h.unseen).neighbour)
                if (g == h.seen) g = place(i);
        }
        for (int i = 0; i < visible_; ++i) {
            key(visible(i)) = kNever;
            memory_.free[static_cast<std::size_t>(free_++)] = visible(i);
        }
    }

    const MinkowskiDifference& difference_;
    Memory& memory_;
    double flat_;
    LeastOverlap best_;
    bool offered_ = false;
    int vertices_ = 0, facets_ = 0, free_ = 0, visible_ = 0, horizon_ = 0, expansion_ = 0;
};

}  // namespace

std::optional<LeastOverlap> least_overlap(const MinkowskiDifference& difference,
                                          const std::array<DifferencePoint, 5>& start,
                                          const TakesDirection& takes) {
    thread_local const std::unique_ptr<Memory> memory = std::make_unique<Memory>();
    return ExpandingPolytope(difference, start, *memory).run(takes);
}

}  // namespace tesserae
