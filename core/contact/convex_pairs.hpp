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
void contacts_between(const Hypersphere& sphere, const Pose& pose, const HullShape& body,
                      const Pose& body_pose, double margin, PairContacts& out);
void contacts_between(const Hypersphere& sphere, const Pose& pose, const BallProduct& body,
                      const Pose& body_pose, double margin, PairContacts& out);
void contacts_between(const HullShape& body, const Pose& pose, const Hyperplane& plane, const Pose&,
                      double margin, PairContacts& out);
void contacts_between(const BallProduct& body, const Pose& pose, const Hyperplane& plane,
                      const Pose&, double margin, PairContacts& out);

}  // namespace tesserae
