// SPDX-License-Identifier: Apache-2.0
#include "core/convex/placed_hull.hpp"

#include "core/convex/vertex_search.hpp"

namespace tesserae {

Vec4 support(const PlacedHull& body, const Vec4& direction) {
    const Vec4 own = body.turn.transpose() * direction;
    return body.centre + body.turn * body.vertices[body.corners.largest_at(own).number];
}

ConvexSeparation separation_of(const PlacedHull& a, const PlacedHull& b, const Vec4& guess,
                               double size, double enough) {
    VertexSearch search(a, b);
    const bool is_direction = guess.allFinite() && !guess.isZero(0);
    const VertexSearch::End end =
        search.run(is_direction ? stable_normalized(guess) : Vec4(Vec4::UnitX()), enough);
    std::array<VertexPair, 5> first;
    for (int i = 0; i < search.count(); ++i) {
        const VertexSearch::Pair& pair = search.pair(i);
        first[static_cast<std::size_t>(i)] = {a.centre + a.turn * a.vertices[pair.of_a],
                                              b.centre + b.turn * b.vertices[pair.of_b]};
    }
    if (end == VertexSearch::End::kFar) {
        const Vec4& normal = search.far_direction();
        const double gap = normal.dot(first[0].on_b - first[0].on_a);
        const Vec4 middle = (first[0].on_a + first[0].on_b) / 2, half = gap / 2 * normal;
        return {normal, gap, middle - half, middle + half};
    }
    const auto support_a = [&](const Vec4& n) -> Vec4 { return support(a, n); };
    const auto support_b = [&](const Vec4& n) -> Vec4 { return support(b, n); };
    return separation_of(support_a, support_b,
                         std::span(first.data(), static_cast<std::size_t>(search.count())), size,
                         enough);
}

}  // namespace tesserae
