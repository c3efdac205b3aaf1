// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/algebra/rotor.hpp"
#include "core/algebra/vector.hpp"

namespace tesserae::bench {

constexpr double kPeerStep = 1.0 / 240;  ///< [s]
constexpr double kPeerGravity = 10;      ///< along -y [m/s^2]
constexpr double kPeerFriction = 0.5;    ///< of every pair

/// A fixed wall that lets bodies be where side * x[axis] > offset.
struct Wall {
    int axis;
    double side;    ///< 1 or -1
    double offset;  ///< [m]
};

/// Bodies of one kind of shape: a sphere where `radius` > 0, else a box.
struct PeerKind {
    double radius = 0;  ///< [m]
    Vec4 sides;         ///< [m]; w is unused in three dimensions
    double mass = 1;    ///< [kg]
};

/// A scene that every engine can build: spheres or boxes, at rest, with their sides along the axes
/// but for those of tumbled_boxes(), which ODE does not build. In three dimensions w = 0
/// everywhere. No restitution.
struct PeerScene {
    std::string name;
    int dimension = 4;        ///< 3 or 4
    int settling_steps = 0;   ///< before anything is measured
    double half_width = 0;    ///< nothing starts farther from the y axis along x, z or w [m]
    std::vector<Wall> walls;  ///< the first is the floor, y > 0
    std::vector<PeerKind> kinds;
    std::vector<std::size_t> kind;  ///< of every body
    std::vector<Vec4> position;     ///< of every body [m]
    Rotor rotor;                    ///< of every body

    std::size_t size() const { return position.size(); }
};

/// Spheres of radius 0.4, 0.45 and 0.5 m that start on a jittered lattice of about ten layers
/// between walls. After the settling of four seconds the last ones still roll, by 1 to 10 cm/s.
PeerScene sphere_pile(int dimension, int count);

/// Boxes of 1 by 0.5 by 0.5 (by 0.5) m, 20 rows high, one thick in z (and w), each row moved by a
/// quarter of a box: every box stands on two. Boxes of a row are 5 cm apart.
PeerScene box_wall(int dimension, int count);

/// Stacks of ten boards of 2 by 0.1 by 0.5 (by 0.5) m each, 1 m apart in z.
PeerScene board_stacks(int dimension, int count);

/// Cubes of 1 m, each on the middle between two that are 5 cm apart: n rows of n to 1, at most
/// `count` in all.
PeerScene box_pyramid(int dimension, int count);

/// Turned boxes of unequal sides in a pit, as `tesserae generate boxes` puts them: they fall into a
/// heap half as high as wide.
PeerScene tumbled_boxes(int dimension, int count);

/// Deepest overlap of two spheres or of a sphere and a wall, from positions alone [m], >= 0.
double deepest_sphere_overlap(const PeerScene& scene, const std::vector<Vec4>& position);

}  // namespace tesserae::bench
