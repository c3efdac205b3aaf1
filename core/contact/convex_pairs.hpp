#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/ball_product.hpp"
#include "core/shape/hull_shape.hpp"
#include "core/shape/hyperbox.hpp"
#include "core/shape/hypercapsule.hpp"
#include "core/shape/hyperplane.hpp"
#include "core/shape/hypersphere.hpp"

// Hulls and products of balls against every shape: the general pair function, but for balls (their
// centre's distance) and planes (the points of the lowest piece).
namespace tesserae {

void contacts_between(const HullShape& a, const Pose& pose_a, const HullShape& b,
                      const Pose& pose_b, double margin, PairContacts& out);
void contacts_between(const HullShape& a, const Pose& pose_a, const Hyperbox& b, const Pose& pose_b,
                      double margin, PairContacts& out);
void contacts_between(const HullShape& a, const Pose& pose_a, const Hypercapsule& b,
                      const Pose& pose_b, double margin, PairContacts& out);
void contacts_between(const HullShape& a, const Pose& pose_a, const BallProduct& b,
                      const Pose& pose_b, double margin, PairContacts& out);
void contacts_between(const BallProduct& a, const Pose& pose_a, const BallProduct& b,
                      const Pose& pose_b, double margin, PairContacts& out);
void contacts_between(const BallProduct& a, const Pose& pose_a, const Hyperbox& b,
                      const Pose& pose_b, double margin, PairContacts& out);
void contacts_between(const BallProduct& a, const Pose& pose_a, const Hypercapsule& b,
                      const Pose& pose_b, double margin, PairContacts& out);

/// Those of them that have flat faces, see convex_contacts_over_face().
void contacts_over_face(const HullShape& a, const Pose& pose_a, const HullShape& b,
                        const Pose& pose_b, bool face_of_b, const Vec4& outward, double margin,
                        PairContacts& out);
void contacts_over_face(const HullShape& a, const Pose& pose_a, const Hyperbox& b,
                        const Pose& pose_b, bool face_of_b, const Vec4& outward, double margin,
                        PairContacts& out);
void contacts_over_face(const HullShape& a, const Pose& pose_a, const Hypercapsule& b,
                        const Pose& pose_b, bool face_of_b, const Vec4& outward, double margin,
                        PairContacts& out);
void contacts_over_face(const HullShape& a, const Pose& pose_a, const BallProduct& b,
                        const Pose& pose_b, bool face_of_b, const Vec4& outward, double margin,
                        PairContacts& out);
void contacts_over_face(const BallProduct& a, const Pose& pose_a, const Hyperbox& b,
                        const Pose& pose_b, bool face_of_b, const Vec4& outward, double margin,
                        PairContacts& out);

/// The feature of a vertex of one body over a face of the other, as the general pair names it.
/// @param vertex   as it is named over a plane
std::uint32_t feature_over_cell(const HullShape& a, const HullShape& b, bool face_of_b,
                                const Vec4& normal, std::uint32_t vertex);
std::uint32_t feature_over_cell(const HullShape& a, const Hyperbox& b, bool face_of_b,
                                const Vec4& normal, std::uint32_t vertex);
std::uint32_t feature_over_cell(const HullShape& a, const Hypercapsule& b, bool face_of_b,
                                const Vec4& normal, std::uint32_t vertex);
std::uint32_t feature_over_cell(const HullShape& a, const BallProduct& b, bool face_of_b,
                                const Vec4& normal, std::uint32_t vertex);
std::uint32_t feature_over_cell(const BallProduct& a, const Hyperbox& b, bool face_of_b,
                                const Vec4& normal, std::uint32_t vertex);

void contacts_between(const Hypersphere& sphere, const Pose& pose, const HullShape& body,
                      const Pose& body_pose, double margin, PairContacts& out);
void contacts_between(const Hypersphere& sphere, const Pose& pose, const BallProduct& body,
                      const Pose& body_pose, double margin, PairContacts& out);
void contacts_between(const HullShape& body, const Pose& pose, const Hyperplane& plane, const Pose&,
                      double margin, PairContacts& out);
void contacts_between(const BallProduct& body, const Pose& pose, const Hyperplane& plane,
                      const Pose&, double margin, PairContacts& out);

}  // namespace tesserae
