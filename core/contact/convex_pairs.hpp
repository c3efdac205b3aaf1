// SPDX-License-Identifier: Apache-2.0
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

// These functions find the contacts of hulls and products of balls with every shape. They use the
// general pair function, except for spheres (distance of the centre) and planes (points of the
// lowest piece).
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

/// Finds the points of two bodies over a flat face of one, see convex_contacts_over_face().
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

/// IsGeneralPairWithFaces holds for the pairs that contacts_over_face() exists for.
template <class A, class B>
concept IsGeneralPairWithFaces = (std::derived_from<A, HullShape> &&
                                  (std::derived_from<B, HullShape> ||
                                   std::derived_from<B, BallProduct> || std::same_as<B, Hyperbox> ||
                                   std::same_as<B, Hypercapsule>)) ||
                                 (std::derived_from<A, BallProduct> && std::same_as<B, Hyperbox>);

/// Returns the feature that the general pair gives to a vertex of one body over a face of the
/// other.
/// @param vertex   the feature of the vertex over a hyperplane
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
