#include "core/shape/hyperbox.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tesserae {
namespace {

double sign_of(double x) { return x < 0 ? -1 : 1; }

/// All four at once: one by one they would be stored, and to read them back as one vector stalls.
Vec4 signs_of(const Vec4& v) {
    using Four = double __attribute__((vector_size(4 * sizeof(double))));
    Four four;
    std::memcpy(&four, v.data(), sizeof four);
    four = four < 0 ? Four{-1, -1, -1, -1} : Four{1, 1, 1, 1};
    Vec4 signs;
    std::memcpy(signs.data(), &four, sizeof four);
    return signs;
}

/// Signed distances from the nearer of the two faces across every axis.
Vec4 face_distances(const Hyperbox& shape, const Vec4& point) {
    return point.cwiseAbs() - 0.5 * shape.size;
}

}  // namespace

double volume(const Hyperbox& shape) { return shape.size.prod(); }

/// M s_i^2 / 12.
Vec4 second_moments(const Hyperbox& shape, double mass) {
    return (mass * shape.size).cwiseProduct(shape.size) / 12;
}

/// Half the diagonal.
double bounding_radius(const Hyperbox& shape) { return stable_norm(0.5 * shape.size); }

Vec4 half_extents(const Hyperbox& shape, const Mat4& rotation) {
    return rotation.cwiseAbs() * (0.5 * shape.size);
}

double half_extent_along(const Hyperbox& shape, const Vec4& direction) {
    return direction.cwiseAbs().dot(0.5 * shape.size);
}

/// A vertex; across an axis that the direction has no part along, the one on the positive side.
Vec4 support(const Hyperbox& shape, const Vec4& direction) {
    return 0.5 * shape.size.cwiseProduct(signs_of(direction));
}

double signed_distance(const Hyperbox& shape, const Vec4& point) {
    const Vec4 faces = face_distances(shape, point);
    const double deepest = faces.maxCoeff();
    return deepest <= 0 ? deepest : stable_norm(faces.cwiseMax(0));
}

/// Inside, where several faces are equally near: the one across the lowest axis; in the middle
/// between two opposite faces: the positive one.
Vec4 normal(const Hyperbox& shape, const Vec4& point) {
    const Vec4 faces = face_distances(shape, point), sides = signs_of(point);
    if (faces.maxCoeff() > 0) return stable_normalized(faces.cwiseMax(0)).cwiseProduct(sides);
    int axis;
    faces.maxCoeff(&axis);
    return sides[axis] * Vec4::Unit(axis);
}

/// Source: Kay and Kajiya 1986, slabs; surfaces count as inside.
double ray_hit(const Hyperbox& shape, const Vec4& origin, const Vec4& direction) {
    const Vec4 faces = face_distances(shape, origin);
    if (faces.maxCoeff() <= 0) return 0;

    // The usual ray slants along every axis: all quotients at once.
    const Vec4 sides = 0.5 * signs_of(direction).cwiseProduct(shape.size);
    double enter = 0, leave = kMiss;
    if ((direction.array() != 0).all()) {
        enter = std::max(enter, (-sides - origin).cwiseQuotient(direction).maxCoeff());
        leave = std::min(leave, (sides - origin).cwiseQuotient(direction).minCoeff());
        return enter <= leave ? enter : kMiss;
    }
    for (int i = 0; i < 4; ++i) {
        if (direction[i] == 0) {
            if (faces[i] > 0) return kMiss;
            continue;
        }
        enter = std::max(enter, (-sides[i] - origin[i]) / direction[i]);
        leave = std::min(leave, (sides[i] - origin[i]) / direction[i]);
    }
    return enter <= leave ? enter : kMiss;
}

/// The first of the faces ahead.
double ray_exit(const Hyperbox& shape, const Vec4& origin, const Vec4& direction) {
    double leave = kMiss;
    for (int i = 0; i < 4; ++i) {
        if (direction[i] == 0) continue;
        const double side = sign_of(direction[i]) * 0.5 * shape.size[i];
        leave = std::min(leave, (side - origin[i]) / direction[i]);
    }
    return std::max(0.0, leave);
}

}  // namespace tesserae
