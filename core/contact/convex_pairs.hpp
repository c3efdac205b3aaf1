#pragma once

#include <concepts>
#include <cstdint>

#include "core/contact/contact.hpp"
#include "core/contact/convex_contacts.hpp"
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

/// Pairs of which contacts_over_face() is.
template <class A, class B>
concept IsGeneralPairWithFaces = (std::derived_from<A, HullShape> &&
                                  (std::derived_from<B, HullShape> ||
                                   std::derived_from<B, BallProduct> || std::same_as<B, Hyperbox> ||
                                   std::same_as<B, Hypercapsule>)) ||
                                 (std::derived_from<A, BallProduct> && std::same_as<B, Hyperbox>);

/// The feature of a vertex of one body over a face of the other, as the general pair names it.
/// @param vertex   as it is named over a plane
template <class A, class B>
requires IsGeneralPairWithFaces<A, B> std::uint32_t feature_over_cell(const A&, const B&,
                                                                      bool face_of_b, const Vec4&,
                                                                      std::uint32_t vertex) {
    return feature_of_corner(!face_of_b, vertex);
}

void contacts_between(const Hypersphere& sphere, const Pose& pose, const HullShape& body,
                      const Pose& body_pose, double margin, PairContacts& out);
void contacts_between(const Hypersphere& sphere, const Pose& pose, const BallProduct& body,
                      const Pose& body_pose, double margin, PairContacts& out);
void contacts_between(const HullShape& body, const Pose& pose, const Hyperplane& plane, const Pose&,
                      double margin, PairContacts& out);
void contacts_between(const BallProduct& body, const Pose& pose, const Hyperplane& plane,
                      const Pose&, double margin, PairContacts& out);

}  // namespace tesserae
