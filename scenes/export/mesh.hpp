// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/body_id.hpp"

namespace tesserae::scenes {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// A surface of flat convex polygons. That of a body is closed: every edge belongs to two polygons,
/// which pass it in opposite directions, and seen from outside their corners go round
/// counter-clockwise.
struct Mesh {
    std::vector<Vec3> vertices;           ///< [m]
    std::vector<std::uint32_t> corners;   ///< of all polygons: indices into vertices
    std::vector<std::uint32_t> face_end;  ///< where each polygon's corners end

    std::size_t faces() const { return face_end.size(); }
    bool is_empty() const { return face_end.empty(); }
    std::span<const std::uint32_t> face(std::size_t i) const {
        const std::uint32_t begin = i == 0 ? 0 : face_end[i - 1];
        return {corners.data() + begin, face_end[i] - begin};
    }
    void add_face(std::span<const std::uint32_t> polygon) {
        corners.insert(corners.end(), polygon.begin(), polygon.end());
        face_end.push_back(static_cast<std::uint32_t>(corners.size()));
    }
};

/// The volume that a closed mesh encloses [m^3]; negative if it is inside out.
double volume_of(const Mesh& mesh);

/// A body's mesh in a frame.
struct BodyMesh {
    BodyId body = 0;
    Mesh mesh;
};

}  // namespace tesserae::scenes
