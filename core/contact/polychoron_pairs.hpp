#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hyperbox.hpp"
#include "core/shape/hypercapsule.hpp"
#include "core/shape/hyperplane.hpp"
#include "core/shape/hypersphere.hpp"
#include "core/shape/polychoron.hpp"

// A polychoron against every shape: the general pair function, but for balls (their centre's
// distance) and planes (the lowest vertices).
namespace tesserae {

void contacts_between(const Polychoron& a, const Pose& pose_a, const Polychoron& b,
                      const Pose& pose_b, double margin, PairContacts& out);
void contacts_between(const Polychoron& a, const Pose& pose_a, const Hyperbox& b,
                      const Pose& pose_b, double margin, PairContacts& out);
void contacts_between(const Polychoron& a, const Pose& pose_a, const Hypercapsule& b,
                      const Pose& pose_b, double margin, PairContacts& out);
void contacts_between(const Hypersphere& sphere, const Pose& pose, const Polychoron& body,
                      const Pose& body_pose, double margin, PairContacts& out);
void contacts_between(const Polychoron& body, const Pose& pose, const Hyperplane& plane,
                      const Pose&, double margin, PairContacts& out);

}  // namespace tesserae
