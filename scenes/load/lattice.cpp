// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/lattice.hpp"

namespace tesserae::scenes {
namespace {

std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

}  // namespace

double lattice_random(std::uint64_t seed, std::uint64_t index, int axis) {
    const std::uint64_t draw = 4 * index + static_cast<std::uint64_t>(axis);
    return static_cast<double>(mixed(mixed(seed) + draw) >> 11) * 0x1p-53;
}

Vec4 lattice_point(const Lattice& lattice, std::uint64_t index) {
    Vec4 point;
    std::uint64_t rest = index;
    for (int axis = 3; axis >= 0; --axis) {
        const std::uint32_t count = lattice.count[static_cast<std::size_t>(axis)];
        const auto cell = static_cast<double>(rest % count);
        rest /= count;
        point[axis] = (cell - 0.5 * (count - 1)) * lattice.spacing[axis];
        if (lattice.jitter > 0)
            point[axis] += lattice.jitter * (2 * lattice_random(lattice.seed, index, axis) - 1);
    }
    return point;
}

}  // namespace tesserae::scenes
