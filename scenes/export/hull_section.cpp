// SPDX-License-Identifier: Apache-2.0
#include "scenes/export/hull_section.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace tesserae::scenes {
namespace {

constexpr std::uint32_t kNowhere = ~std::uint32_t{0};

/// A polyhedron of less than this part of its size's cube has no inside but rounding.
constexpr double kFlat = 1e-14;

/// A polygon between two cells that is cut: a side of the polygons in which both are cut.
struct CutFace {
    std::array<std::uint32_t, 2> cells, points;  ///< points: numbers of the edges that are cut
};

/// What the cells' polygons are made of: the cut faces of each cell.
using FacesOfCells = std::vector<std::vector<std::uint32_t>>;

/// The faces that are cut, by two of their edges each; none where rounding says otherwise.
std::optional<std::vector<CutFace>> cut_faces(const HullFaces& hull,
                                              const std::vector<bool>& is_below) {
    std::vector<CutFace> cut;
    for (const HullFaces::Face& face : hull.faces) {
        std::size_t crossings = 0;
        CutFace found{face.cells, {}};
        for (const std::uint32_t e : face.edges) {
            const auto [a, b] = hull.edges[e];
            if (is_below[a] == is_below[b]) continue;
            if (crossings < 2) found.points[crossings] = e;
            ++crossings;
        }
        if (crossings == 0) continue;
        if (crossings != 2) return std::nullopt;
        cut.push_back(found);
    }
    return cut;
}

/// One cell's polygon: its cut faces as a chain, in either direction.
std::optional<std::vector<std::uint32_t>> chain_of(const std::vector<std::uint32_t>& faces,
                                                   const std::vector<CutFace>& cut) {
    std::vector<bool> is_used(faces.size());
    const std::uint32_t first = cut[faces[0]].points[0];
    std::vector<std::uint32_t> chain = {first};
    std::uint32_t at = cut[faces[0]].points[1];
    is_used[0] = true;
    while (at != first) {
        chain.push_back(at);
        std::uint32_t next = kNowhere;
        for (std::size_t i = 0; i < faces.size() && next == kNowhere; ++i) {
            const auto& points = cut[faces[i]].points;
            if (is_used[i] || (points[0] != at && points[1] != at)) continue;
            is_used[i] = true;
            next = points[0] == at ? points[1] : points[0];
        }
        if (next == kNowhere) return std::nullopt;
        at = next;
    }
    if (chain.size() != faces.size()) return std::nullopt;
    return chain;
}

/// Whether the chain passes a face from its first point to its second.
bool passes_forward(const std::vector<std::uint32_t>& chain, const CutFace& face) {
    for (std::size_t i = 0; i < chain.size(); ++i)
        if (chain[i] == face.points[0] && chain[(i + 1) % chain.size()] == face.points[1])
            return true;
    return false;
}

/// Turns chains round until each face is passed once in either direction, from cell to cell.
bool orient(std::vector<std::vector<std::uint32_t>>& chains, const FacesOfCells& of_cell,
            const std::vector<CutFace>& cut) {
    std::vector<bool> is_done(chains.size());
    std::vector<std::uint32_t> queue;
    for (std::uint32_t c = 0; c < chains.size() && queue.empty(); ++c)
        if (!chains[c].empty()) queue.push_back(c), is_done[c] = true;
    for (std::size_t i = 0; i < queue.size(); ++i) {
        const std::uint32_t cell = queue[i];
        for (const std::uint32_t f : of_cell[cell]) {
            const std::uint32_t other = cut[f].cells[0] == cell ? cut[f].cells[1] : cut[f].cells[0];
            const bool here = passes_forward(chains[cell], cut[f]);
            const bool is_same = here == passes_forward(chains[other], cut[f]);
            if (is_same && is_done[other]) return false;
            if (is_same) std::reverse(chains[other].begin(), chains[other].end());
            if (!is_done[other]) queue.push_back(other), is_done[other] = true;
        }
    }
    const auto is_cut = [](const auto& chain) { return !chain.empty(); };
    return static_cast<std::size_t>(std::count_if(chains.begin(), chains.end(), is_cut)) ==
           queue.size();
}

/// The points of the cut, each once: edges that meet in a vertex of the slice share it.
struct CutPoints {
    std::vector<Vec3> points;
    std::vector<std::uint32_t> of_edge, of_vertex;

    CutPoints(const HullFaces& hull, const std::vector<Vec4>& placed,
              const std::vector<double>& height)
        : of_edge(hull.edges.size(), kNowhere), of_vertex(placed.size(), kNowhere) {
        for (std::size_t e = 0; e < hull.edges.size(); ++e) {
            const auto [a, b] = hull.edges[e];
            if ((height[a] < 0) == (height[b] < 0)) continue;
            const std::uint32_t above = height[a] < 0 ? b : a;
            std::uint32_t& place = height[above] == 0 ? of_vertex[above] : of_edge[e];
            if (place == kNowhere) {
                place = static_cast<std::uint32_t>(points.size());
                const double part = height[a] / (height[a] - height[b]);
                points.push_back(height[above] == 0 ? Vec3(placed[above].head<3>())
                                                    : Vec3((1 - part) * placed[a].head<3>() +
                                                           part * placed[b].head<3>()));
            }
            of_edge[e] = place;
        }
    }
};

/// The heights above the slice; what is in it to rounding is at 0.
std::vector<double> heights_of(const std::vector<Vec4>& placed) {
    double size = 0;
    for (const Vec4& v : placed) size = std::max(size, (v - placed[0]).norm());
    std::vector<double> height;
    for (const Vec4& v : placed)
        height.push_back(std::abs(v[3]) <= kVertexInSlice * size ? 0 : v[3]);
    return height;
}

}  // namespace

HullFaces faces_of(const Hull& hull) {
    HullFaces result;
    result.vertices = hull.vertices;
    result.cells = hull.cells.size();
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> number;
    std::vector<std::vector<std::uint32_t>> cells_at(hull.vertices.size());
    std::vector<std::vector<std::uint32_t>> edges_of(hull.cells.size());
    for (std::uint32_t c = 0; c < hull.cells.size(); ++c) {
        const HullCell& cell = hull.cells[c];
        for (const auto v : cell.vertices) cells_at[v].push_back(c);
        for (const auto& edge : cell.edges) {
            std::array<std::uint32_t, 2> ends = {cell.vertices[edge[0]], cell.vertices[edge[1]]};
            if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
            const auto [at, is_new] =
                number.try_emplace(ends, static_cast<std::uint32_t>(result.edges.size()));
            if (is_new) result.edges.push_back(ends);
            edges_of[c].push_back(at->second);
        }
    }
    // Two cells that share more than an edge share a polygon.
    for (std::uint32_t c = 0; c < hull.cells.size(); ++c) {
        std::map<std::uint32_t, std::uint32_t> shared;
        for (const auto v : hull.cells[c].vertices)
            for (const std::uint32_t other : cells_at[v])
                if (other > c) ++shared[other];
        for (const auto& [other, vertices] : shared) {
            if (vertices < 3) continue;
            HullFaces::Face face{{c, other}, {}};
            const auto& theirs = edges_of[other];
            for (const std::uint32_t e : edges_of[c])
                if (std::find(theirs.begin(), theirs.end(), e) != theirs.end())
                    face.edges.push_back(e);
            result.faces.push_back(std::move(face));
        }
    }
    return result;
}

HullFaces faces_of_box(const Vec4& size) {
    static const HullFaces kTesseract = [] {
        std::vector<Vec4> corners;
        for (int i = 0; i < 16; ++i)
            corners.push_back(
                {i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0, i & 8 ? 1.0 : -1.0});
        HullFaces faces = faces_of(hull_of(corners));
        for (Vec4& v : faces.vertices) v = v.array().round();
        return faces;
    }();
    HullFaces box = kTesseract;
    for (Vec4& v : box.vertices) v = v.cwiseProduct(0.5 * size);
    return box;
}

std::optional<Mesh> hull_section(const HullFaces& hull, const std::vector<Vec4>& placed) {
    const std::vector<double> height = heights_of(placed);
    std::vector<bool> is_below;
    for (const double h : height) is_below.push_back(h < 0);
    const auto cut = cut_faces(hull, is_below);
    if (!cut) return std::nullopt;
    if (cut->empty()) return Mesh();

    FacesOfCells of_cell(hull.cells);
    for (std::uint32_t f = 0; f < cut->size(); ++f)
        for (const std::uint32_t cell : (*cut)[f].cells) of_cell[cell].push_back(f);
    std::vector<std::vector<std::uint32_t>> chains(hull.cells);
    for (std::size_t cell = 0; cell < hull.cells; ++cell) {
        if (of_cell[cell].empty()) continue;
        auto chain = chain_of(of_cell[cell], *cut);
        if (!chain) return std::nullopt;
        chains[cell] = std::move(*chain);
    }
    if (!orient(chains, of_cell, *cut)) return std::nullopt;

    // Corners that are one vertex of the polytope fall together; polygons without an inside vanish.
    const CutPoints points(hull, placed, height);
    Mesh mesh;
    mesh.vertices = points.points;
    for (const auto& chain : chains) {
        std::vector<std::uint32_t> polygon;
        for (const std::uint32_t e : chain)
            if (polygon.empty() || polygon.back() != points.of_edge[e])
                polygon.push_back(points.of_edge[e]);
        while (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
        if (polygon.size() > 2) mesh.add_face(polygon);
    }
    if (mesh.vertices.size() < 4 || mesh.faces() < 4) return Mesh();
    const double volume = volume_of(mesh);
    double size = 0;
    for (const Vec3& v : mesh.vertices) size = std::max(size, (v - mesh.vertices[0]).norm());
    if (volume < 0)
        for (std::size_t f = 0, begin = 0; f < mesh.faces(); begin = mesh.face_end[f++])
            std::reverse(mesh.corners.begin() + static_cast<std::ptrdiff_t>(begin),
                         mesh.corners.begin() + mesh.face_end[f]);
    return std::abs(volume) <= kFlat * size * size * size ? Mesh() : mesh;
}

}  // namespace tesserae::scenes
