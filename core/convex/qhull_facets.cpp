// SPDX-License-Identifier: Apache-2.0
#include "core/convex/qhull_facets.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <memory>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include "core/error.hpp"

// Apart from all else: Qhull's header is a list of macros.
namespace tesserae {
namespace {

/// Qhull and its memory; what it says goes nowhere.
struct Qhull {
    qhT state;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> nowhere{std::fopen("/dev/null", "w"),
                                                            std::fclose};

    Qhull() {
        if (!nowhere) throw RunError("/dev/null: cannot be opened");
        QHULL_LIB_CHECK
        qh_zero(&state, nowhere.get());
    }
    ~Qhull() {
        qh_freeqhull(&state, !qh_ALL);
        int blocks, bytes;
        qh_memfreeshort(&state, &blocks, &bytes);
    }
    Qhull(const Qhull&) = delete;
    Qhull& operator=(const Qhull&) = delete;
};

/// Twice a polygon's area, along its normal.
Eigen::Vector3d area_of(const std::vector<std::uint32_t>& polygon,
                        const std::vector<Eigen::Vector3d>& points) {
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    const Eigen::Vector3d& first = points[polygon[0]];
    for (std::size_t i = 2; i < polygon.size(); ++i)
        area += (points[polygon[i - 1]] - first).cross(points[polygon[i]] - first);
    return area;
}

}  // namespace

QhullFacets qhull_facets(const std::vector<Vec4>& points) {
    static_assert(sizeof(Vec4) == 4 * sizeof(coordT));
    std::vector<Vec4> copy = points;  // Qhull's argument is not constant
    Qhull qhull;
    qhT* qh = &qhull.state;  // the macros' name for it
    // It stops after so many points: of 1000 vertices in 4D there are at most half a million
    // facets.
    char command[] = "qhull Pp TA1100";
    QhullFacets facets;
    if (qh_new_qhull(qh, 4, static_cast<int>(copy.size()), copy[0].data(), False, command,
                     qhull.nowhere.get(), qhull.nowhere.get()) != 0)
        return facets;
    std::vector<bool> is_vertex(points.size());
    facetT* facet;
    FORALLfacets {
        facets.planes.push_back(
            {Vec4(facet->normal[0], facet->normal[1], facet->normal[2], facet->normal[3]),
             -facet->offset});
        vertexT *vertex, **vertexp;
        FOREACHvertex_(facet->vertices)
            is_vertex[static_cast<std::size_t>(qh_pointid(qh, vertex->point))] = true;
    }
    for (std::size_t i = 0; i < points.size(); ++i)
        if (is_vertex[i]) facets.vertices.push_back(i);
    return facets;
}

std::vector<std::vector<std::uint32_t>> qhull_polygons(std::vector<Eigen::Vector3d> points) {
    std::vector<std::vector<std::uint32_t>> polygons;
    if (points.size() < 4) return polygons;
    Qhull qhull;
    qhT* qh = &qhull.state;
    char command[] = "qhull Pp";
    if (qh_new_qhull(qh, 3, static_cast<int>(points.size()), points[0].data(), False, command,
                     qhull.nowhere.get(), qhull.nowhere.get()) != 0)
        return polygons;
    facetT* facet;
    FORALLfacets {
        std::vector<std::uint32_t> polygon;
        setT* corners = qh_facet3vertex(qh, facet);
        vertexT *vertex, **vertexp;
        FOREACHvertex_(corners)
            polygon.push_back(static_cast<std::uint32_t>(qh_pointid(qh, vertex->point)));
        qh_settempfree(qh, &corners);
        // Which way round depends on how Qhull was built.
        if (area_of(polygon, points).dot(Eigen::Map<const Eigen::Vector3d>(facet->normal)) < 0)
            std::reverse(polygon.begin(), polygon.end());
        polygons.push_back(std::move(polygon));
    }
    return polygons;
}

}  // namespace tesserae
