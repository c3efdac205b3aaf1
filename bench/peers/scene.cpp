// SPDX-License-Identifier: Apache-2.0
#include "bench/peers/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "bench/bodies.hpp"

namespace tesserae::bench {
namespace {

constexpr double kDensity = 1000;  ///< [kg/m^d]

PeerKind sphere_kind(int dimension, double radius) {
    PeerKind kind;
    kind.radius = radius;
    kind.sides.setConstant(2 * radius);
    const double volume =
        dimension == 4 ? 0.5 * pi * pi * std::pow(radius, 4) : 4.0 / 3 * pi * std::pow(radius, 3);
    kind.mass = kDensity * volume;
    return kind;
}

PeerKind box_kind(int dimension, const Vec4& sides) {
    PeerKind kind;
    kind.sides = sides;
    kind.mass = kDensity * sides.head(dimension).prod();
    return kind;
}

PeerScene empty_scene(const std::string& name, int dimension) {
    PeerScene scene;
    scene.name = name;
    scene.dimension = dimension;
    scene.walls.push_back({1, 1, 0});
    return scene;
}

}  // namespace

PeerScene sphere_pile(int dimension, int count) {
    constexpr double kLayers = 10, kSpacing = 1.02, kJitter = 0.02;
    PeerScene scene = empty_scene("sphere_pile", dimension);
    scene.settling_steps = 960;
    for (double radius : {0.4, 0.45, 0.5}) scene.kinds.push_back(sphere_kind(dimension, radius));

    const int across =
        static_cast<int>(std::lround(std::pow(count / kLayers, 1.0 / (dimension - 1))));
    scene.half_width = 0.5 * kSpacing * across;
    const std::vector<int> axes =
        dimension == 4 ? std::vector<int>{0, 2, 3} : std::vector<int>{0, 2};
    for (int axis : axes)
        for (double side : {-1.0, 1.0}) scene.walls.push_back({axis, side, -scene.half_width});

    std::mt19937_64 engine(1);
    std::uniform_real_distribution<> jitter(-kJitter, kJitter);
    std::uniform_int_distribution<std::size_t> kind(0, 2);
    for (int i = 0; i < count; ++i) {
        Vec4 x = Vec4::Zero();
        int place = i;
        for (int axis : axes) {
            x[axis] = kSpacing * (place % across - 0.5 * (across - 1)) + jitter(engine);
            place /= across;
        }
        x[1] = kSpacing * (place + 0.5) + jitter(engine);
        scene.position.push_back(x);
        scene.kind.push_back(kind(engine));
    }
    return scene;
}

PeerScene box_wall(int dimension, int count) {
    constexpr int kRows = 20;
    constexpr double kSpacing = 1.05;
    PeerScene scene = empty_scene("box_wall", dimension);
    scene.settling_steps = 240;
    scene.kinds.push_back(box_kind(dimension, {1, 0.5, 0.5, 0.5}));

    const int columns = count / kRows;
    scene.half_width = 0.5 * kSpacing * (columns + 1);
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double shift = row % 2 == 0 ? 0 : 0.25;
            const double x = kSpacing * (column - 0.5 * (columns - 1)) + shift;
            scene.position.push_back({x, 0.5 * (row + 0.5), 0, 0});
            scene.kind.push_back(0);
        }
    return scene;
}

PeerScene board_stacks(int dimension, int count) {
    constexpr int kInStack = 10;
    PeerScene scene = empty_scene("board_stacks", dimension);
    scene.kinds.push_back(box_kind(dimension, {2, 0.1, 0.5, 0.5}));
    scene.half_width = std::max(1.0, 0.5 * count / kInStack);
    for (int i = 0; i < count; ++i) {
        scene.position.push_back({0, 0.1 * (i % kInStack) + 0.05, 1.0 * (i / kInStack), 0});
        scene.kind.push_back(0);
    }
    return scene;
}

PeerScene box_pyramid(int dimension, int count) {
    constexpr double kSpacing = 1.05;
    PeerScene scene = empty_scene("box_pyramid", dimension);
    scene.kinds.push_back(box_kind(dimension, Vec4::Ones()));
    int rows = 1;
    while ((rows + 1) * (rows + 2) / 2 <= count) ++rows;
    scene.half_width = 0.5 * kSpacing * rows;
    for (int row = 0; row < rows; ++row)
        for (int i = 0; i < rows - row; ++i) {
            scene.position.push_back({kSpacing * (i - 0.5 * (rows - row - 1)), row + 0.5, 0, 0});
            scene.kind.push_back(0);
        }
    return scene;
}

PeerScene tumbled_boxes(int dimension, int count) {
    constexpr double kSpacing = 1.1, kJitter = 0.045;
    PeerScene scene = empty_scene("tumbled_boxes", dimension);
    scene.settling_steps = 480;
    scene.kinds.push_back(box_kind(dimension, {0.9, 0.5, 0.7, 0.6}));
    // In three dimensions the second turn is about the first axis instead.
    const double xy = 20 * pi / 180, other = 35 * pi / 180;
    scene.rotor = dimension == 4 ? exp(Bivector{-0.5 * xy, 0, 0, 0, 0, -0.5 * other})
                                 : exp(Bivector{-0.5 * xy, 0, 0, -0.5 * other});

    const std::vector<int> axes =
        dimension == 4 ? std::vector<int>{3, 2, 0} : std::vector<int>{2, 0};
    const int across = static_cast<int>(std::ceil(std::pow(2.0 * count, 1.0 / dimension) - 1e-9));
    scene.half_width = 0.5 * kSpacing * across + 0.1;
    for (const int axis : axes)
        for (const double side : {-1.0, 1.0})
            scene.walls.push_back({axis, side, -scene.half_width});

    std::mt19937_64 engine(1);
    std::uniform_real_distribution<> jitter(-kJitter, kJitter);
    for (int i = 0; i < count; ++i) {
        Vec4 x = Vec4::Zero();
        int place = i;
        for (const int axis : axes) {
            x[axis] = kSpacing * (place % across - 0.5 * (across - 1)) + jitter(engine);
            place /= across;
        }
        x[1] = 0.7 + kSpacing * place + jitter(engine);
        scene.position.push_back(x);
        scene.kind.push_back(0);
    }
    return scene;
}

double deepest_sphere_overlap(const PeerScene& scene, const std::vector<Vec4>& position) {
    const auto radius = [&](std::size_t i) { return scene.kinds[scene.kind[i]].radius; };
    double largest = 0, deepest = 0;
    for (const PeerKind& kind : scene.kinds) largest = std::max(largest, kind.radius);

    std::vector<std::size_t> order(scene.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](std::size_t i, std::size_t j) { return position[i].x() < position[j].x(); });
    for (std::size_t k = 0; k < order.size(); ++k) {
        const std::size_t i = order[k];
        for (const Wall& wall : scene.walls) {
            const double gap = wall.side * position[i][wall.axis] - wall.offset - radius(i);
            deepest = std::max(deepest, -gap);
        }
        for (std::size_t l = k + 1; l < order.size(); ++l) {
            const std::size_t j = order[l];
            if (position[j].x() - position[i].x() > radius(i) + largest) break;
            const double gap = (position[j] - position[i]).norm() - radius(i) - radius(j);
            deepest = std::max(deepest, -gap);
        }
    }
    return deepest;
}

}  // namespace tesserae::bench
