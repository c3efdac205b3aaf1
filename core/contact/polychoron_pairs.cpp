#include "core/contact/polychoron_pairs.hpp"

#include <algorithm>
#include <vector>

#include "core/contact/convex_views.hpp"
#include "core/contact/hypersphere_shape.hpp"
#include "core/contact/manifold.hpp"

namespace tesserae {

void contacts_between(const Polychoron& a, const Pose& pose_a, const Polychoron& b,
                      const Pose& pose_b, double margin, PairContacts& out) {
    general_contacts(a, pose_a, b, pose_b, margin, out);
}

void contacts_between(const Polychoron& a, const Pose& pose_a, const Hyperbox& b,
                      const Pose& pose_b, double margin, PairContacts& out) {
    general_contacts(a, pose_a, b, pose_b, margin, out);
}

void contacts_between(const Polychoron& a, const Pose& pose_a, const Hypercapsule& b,
                      const Pose& pose_b, double margin, PairContacts& out) {
    general_contacts(a, pose_a, b, pose_b, margin, out);
}

void contacts_between(const Hypersphere& sphere, const Pose& pose, const Polychoron& body,
                      const Pose& body_pose, double margin, PairContacts& out) {
    sphere_contacts(sphere, pose, body, body_pose, margin, out);
}

void contacts_between(const Polychoron& body, const Pose& pose, const Hyperplane& plane,
                      const Pose&, double margin, PairContacts& out) {
    const double height = plane.normal.dot(pose.position) - plane.offset;
    if (!(height - bounding_radius(body) <= margin)) return;
    const Mat4 rotation = to_matrix(pose.rotor);
    const Vec4 up = rotation.transpose() * plane.normal;
    const std::vector<Vec4>& vertices = body.body->hull.vertices;
    std::vector<ContactPoint> points;
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
        const double separation = height + up.dot(vertices[i]);
        if (separation <= margin) points.push_back({Vec4::Zero(), separation, i});
    }
    if (points.size() > kManifoldInput) {
        std::sort(points.begin(), points.end(), [](const ContactPoint& p, const ContactPoint& q) {
            return p.separation != q.separation ? p.separation < q.separation
                                                : p.feature < q.feature;
        });
        points.resize(kManifoldInput);
    }
    for (ContactPoint& p : points)
        p.point =
            pose.position + rotation * vertices[p.feature] - 0.5 * p.separation * plane.normal;
    const std::size_t count = reduce_manifold(points, plane.normal);
    for (std::size_t i = 0; i < count; ++i)
        out.add(points[i].feature, -plane.normal, points[i].separation, points[i].point);
}

}  // namespace tesserae
