// SPDX-License-Identifier: Apache-2.0
#include "bench/peers/jointed.hpp"

namespace tesserae::bench {
namespace {

constexpr double kApart = 0.25;  ///< of neighbours [m]

Vec4 middle(const JointedScene& scene, std::size_t a, std::size_t b) {
    return 0.5 * (scene.position[a] + scene.position[b]);
}

void join(JointedScene& scene, std::size_t a, std::size_t b) {
    if (scene.mass[a] > 0 || scene.mass[b] > 0) scene.links.push_back({a, b, middle(scene, a, b)});
}

}  // namespace

JointedScene net(int side, int steps) {
    JointedScene scene;
    scene.name = "net";
    scene.steps = steps;
    const auto balls = static_cast<std::size_t>(side);
    for (std::size_t row = 0; row < balls; ++row)
        for (std::size_t i = 0; i < balls; ++i) {
            scene.mass.push_back(row > 0 ? 1 : 0);
            scene.position.emplace_back(kApart * static_cast<double>(i), 0,
                                        kApart * static_cast<double>(row), 0);
        }
    for (std::size_t ball = 0; ball < balls * balls; ++ball) {
        if (ball % balls > 0) join(scene, ball - 1, ball);
        if (ball >= balls) join(scene, ball - balls, ball);
    }
    return scene;
}

JointedScene rope(int balls, double load, int steps) {
    JointedScene scene;
    scene.name = "rope";
    scene.steps = steps;
    for (int i = 0; i <= balls; ++i) {
        scene.mass.push_back(i == 0 ? 0 : i == balls ? load : 1);
        scene.position.emplace_back(kApart * i, 0, 0, 0);
    }
    for (std::size_t ball = 1; ball < scene.mass.size(); ++ball) join(scene, ball - 1, ball);
    return scene;
}

}  // namespace tesserae::bench
