#include "core/convex/qhull_facets.hpp"

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

}  // namespace tesserae
