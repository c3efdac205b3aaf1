// SPDX-License-Identifier: Apache-2.0
#include "core/contact/convex_pairs.hpp"

#include <algorithm>
#include <vector>

#include "core/contact/convex_views.hpp"
#include "core/contact/hypersphere_shape.hpp"
#include "core/contact/manifold.hpp"

namespace tesserae {
namespace {

/// Those of some points of a body that are at a plane.
/// @param points   in the body's frame
void plane_contacts(const std::vector<NamedPoint>& points, const Pose& pose,
                    const Hyperplane& plane, double margin, PairContacts& out) {
    const Mat4 rotation = to_matrix(pose.rotor);
    const Vec4 up = rotation.transpose() * plane.normal;
    const double height = plane.normal.dot(pose.position) - plane.offset;
    std::vector<ContactPoint> near;
    for (const NamedPoint& p : points) {
        const double separation = height + up.dot(p.point);
        if (separation <= margin) near.push_back({p.point, separation, p.name});
    }
    if (near.size() > kManifoldInput) {
        std::sort(near.begin(), near.end(), [](const ContactPoint& p, const ContactPoint& q) {
            return p.separation != q.separation ? p.separation < q.separation
                                                : p.feature < q.feature;
        });
        near.resize(kManifoldInput);
    }
    for (ContactPoint& p : near)
        p.point = pose.position + rotation * p.point - 0.5 * p.separation * plane.normal;
    const std::size_t count = reduce_corners(near, plane.normal);
    for (std::size_t i = 0; i < count; ++i)
        out.add(near[i].feature, -plane.normal, near[i].separation, near[i].point);
}

bool is_beyond(double bounding_radius, const Pose& pose, const Hyperplane& plane, double margin) {
    return !(plane.normal.dot(pose.position) - plane.offset - bounding_radius <= margin);
}

}  // namespace

void contacts_between(const HullShape& a, const Pose& pose_a, const HullShape& b,
                      const Pose& pose_b, double margin, PairContacts& out) {
    general_contacts(a, pose_a, b, pose_b, margin, out);
}

void contacts_between(const HullShape& a, const Pose& pose_a, const Hyperbox& b, const Pose& pose_b,
                      double margin, PairContacts& out) {
    general_contacts(a, pose_a, b, pose_b, margin, out);
}

void contacts_between(const HullShape& a, const Pose& pose_a, const Hypercapsule& b,
                      const Pose& pose_b, double margin, PairContacts& out) {
    general_contacts(a, pose_a, b, pose_b, margin, out);
}

void contacts_between(const HullShape& a, const Pose& pose_a, const BallProduct& b,
                      const Pose& pose_b, double margin, PairContacts& out) {
    general_contacts(a, pose_a, b, pose_b, margin, out);
}

void contacts_between(const BallProduct& a, const Pose& pose_a, const BallProduct& b,
                      const Pose& pose_b, double margin, PairContacts& out) {
    general_contacts(a, pose_a, b, pose_b, margin, out);
}

void contacts_between(const BallProduct& a, const Pose& pose_a, const Hyperbox& b,
                      const Pose& pose_b, double margin, PairContacts& out) {
    general_contacts(a, pose_a, b, pose_b, margin, out);
}

void contacts_between(const BallProduct& a, const Pose& pose_a, const Hypercapsule& b,
                      const Pose& pose_b, double margin, PairContacts& out) {
    general_contacts(a, pose_a, b, pose_b, margin, out);
}

void contacts_over_face(const HullShape& a, const Pose& pose_a, const HullShape& b,
                        const Pose& pose_b, bool face_of_b, const Vec4& outward, double margin,
                        PairContacts& out) {
    general_contacts_over_face(a, pose_a, b, pose_b, face_of_b, outward, margin, out);
}

void contacts_over_face(const HullShape& a, const Pose& pose_a, const Hyperbox& b,
                        const Pose& pose_b, bool face_of_b, const Vec4& outward, double margin,
                        PairContacts& out) {
    general_contacts_over_face(a, pose_a, b, pose_b, face_of_b, outward, margin, out);
}

void contacts_over_face(const HullShape& a, const Pose& pose_a, const Hypercapsule& b,
                        const Pose& pose_b, bool face_of_b, const Vec4& outward, double margin,
                        PairContacts& out) {
    general_contacts_over_face(a, pose_a, b, pose_b, face_of_b, outward, margin, out);
}

void contacts_over_face(const HullShape& a, const Pose& pose_a, const BallProduct& b,
                        const Pose& pose_b, bool face_of_b, const Vec4& outward, double margin,
                        PairContacts& out) {
    general_contacts_over_face(a, pose_a, b, pose_b, face_of_b, outward, margin, out);
}

void contacts_over_face(const BallProduct& a, const Pose& pose_a, const Hyperbox& b,
                        const Pose& pose_b, bool face_of_b, const Vec4& outward, double margin,
                        PairContacts& out) {
    general_contacts_over_face(a, pose_a, b, pose_b, face_of_b, outward, margin, out);
}

void contacts_between(const Hypersphere& sphere, const Pose& pose, const HullShape& body,
                      const Pose& body_pose, double margin, PairContacts& out) {
    sphere_contacts(sphere, pose, body, body_pose, margin, out);
}

void contacts_between(const Hypersphere& sphere, const Pose& pose, const BallProduct& body,
                      const Pose& body_pose, double margin, PairContacts& out) {
    sphere_contacts(sphere, pose, body, body_pose, margin, out);
}

void contacts_between(const HullShape& body, const Pose& pose, const Hyperplane& plane, const Pose&,
                      double margin, PairContacts& out) {
    if (is_beyond(bounding_radius(body), pose, plane, margin)) return;
    const std::vector<Vec4>& vertices = body.body->hull.vertices;
    std::vector<NamedPoint> points;
    for (std::uint16_t i = 0; i < vertices.size(); ++i) points.push_back({vertices[i], i});
    plane_contacts(points, pose, plane, margin, out);
}

void contacts_between(const BallProduct& body, const Pose& pose, const Hyperplane& plane,
                      const Pose&, double margin, PairContacts& out) {
    if (is_beyond(bounding_radius(body), pose, plane, margin)) return;
    const Vec4 down = to_matrix(pose.rotor).transpose() * -plane.normal;
    plane_contacts(points_along(body, down), pose, plane, margin, out);
}

}  // namespace tesserae
