// SPDX-License-Identifier: Apache-2.0
#include "scenes/export/mesh.hpp"

#include <Eigen/Geometry>

namespace tesserae::scenes {

double volume_of(const Mesh& mesh) {
    if (mesh.is_empty()) return 0;
    // Tetrahedra from one of its points, so that a body far away loses no digits.
    const Vec3& apex = mesh.vertices.front();
    double six_times = 0;
    for (std::size_t f = 0; f < mesh.faces(); ++f) {
        const auto corner = mesh.face(f);
        const Vec3 a = mesh.vertices[corner[0]] - apex;
        for (std::size_t i = 2; i < corner.size(); ++i)
            six_times +=
                a.dot((mesh.vertices[corner[i - 1]] - apex).cross(mesh.vertices[corner[i]] - apex));
    }
    return six_times / 6;
}

}  // namespace tesserae::scenes
