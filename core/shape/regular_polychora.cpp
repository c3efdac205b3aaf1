// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/shape/polychoron.hpp"

// Coordinates: Coxeter, Regular Polytopes (1973), sections 8.2 to 8.7; as scenes/FORMATS.md orders
// them.
namespace tesserae {
namespace {

/// All choices of signs of the coordinates that are not 0.
void add_signs(const Vec4& v, std::vector<Vec4>& all) {
    for (unsigned signs = 0; signs < 16; ++signs) {
        Vec4 turned = v;
        bool is_new = true;
        for (int i = 0; i < 4; ++i)
            if (signs >> i & 1u) {
                turned[i] = -turned[i];
                is_new = is_new && v[i] != 0;
            }
        if (is_new) all.push_back(turned);
    }
}

bool is_even(const std::array<int, 4>& order) {
    int inversions = 0;
    for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j)
            inversions += order[static_cast<std::size_t>(i)] > order[static_cast<std::size_t>(j)];
    return inversions % 2 == 0;
}

std::vector<Vec4> of_600_cell() {
    constexpr double phi = std::numbers::phi;
    std::vector<Vec4> all;
    add_signs(Vec4::Constant(0.5), all);
    for (int axis = 0; axis < 4; ++axis) add_signs(Vec4::Unit(axis), all);
    const Vec4 odd(phi / 2, 0.5, 0.5 / phi, 0);
    std::array<int, 4> order = {0, 1, 2, 3};
    do {
        if (!is_even(order)) continue;
        Vec4 v;
        for (std::size_t i = 0; i < 4; ++i) v[order[i]] = odd[static_cast<Eigen::Index>(i)];
        add_signs(v, all);
    } while (std::next_permutation(order.begin(), order.end()));
    return all;
}

/// The centres of the 600-cell's cells.
std::vector<Vec4> of_120_cell() {
    std::vector<Vec4> all;
    const Hull hull = hull_of(of_600_cell());
    for (const HullCell& cell : hull.cells) all.push_back(cell.plane.normal);
    return all;
}

std::vector<Vec4> unnormalized(RegularPolychoron which) {
    std::vector<Vec4> all;
    const double root = 1 / std::sqrt(5.0);
    switch (which) {
        case RegularPolychoron::kNone:
            break;
        case RegularPolychoron::k5Cell:
            return {{1, 1, 1, -root},
                    {1, -1, -1, -root},
                    {-1, 1, -1, -root},
                    {-1, -1, 1, -root},
                    {0, 0, 0, 4 * root}};
        case RegularPolychoron::k8Cell:
            add_signs(Vec4::Ones(), all);
            break;
        case RegularPolychoron::k16Cell:
            for (int axis = 0; axis < 4; ++axis) add_signs(Vec4::Unit(axis), all);
            break;
        case RegularPolychoron::k24Cell:
            for (int i = 0; i < 4; ++i)
                for (int j = i + 1; j < 4; ++j) add_signs(Vec4::Unit(i) + Vec4::Unit(j), all);
            break;
        case RegularPolychoron::k120Cell:
            return of_120_cell();
        case RegularPolychoron::k600Cell:
            return of_600_cell();
    }
    return all;
}

}  // namespace

std::vector<Vec4> regular_vertices(RegularPolychoron which) {
    std::vector<Vec4> all = unnormalized(which);
    for (Vec4& v : all) v.normalize();
    return all;
}

}  // namespace tesserae
