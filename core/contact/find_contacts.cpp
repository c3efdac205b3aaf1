// SPDX-License-Identifier: Apache-2.0
#include "core/contact/find_contacts.hpp"

#include "core/contact/convex_pairs.hpp"
#include "core/contact/hyperbox_hyperbox.hpp"
#include "core/contact/hyperbox_hyperplane.hpp"
#include "core/contact/hypercapsule_hyperbox.hpp"
#include "core/contact/hypercapsule_hypercapsule.hpp"
#include "core/contact/hypercapsule_hyperplane.hpp"
#include "core/contact/hypersphere_hyperbox.hpp"
#include "core/contact/hypersphere_hypercapsule.hpp"
#include "core/contact/hypersphere_hyperplane.hpp"
#include "core/contact/hypersphere_hypersphere.hpp"
#include "core/error.hpp"

namespace tesserae {
namespace {

template <class A, class B>
concept HasContacts = requires(const A& a, const B& b, const Pose& pose, double margin,
                               PairContacts& out) {
    contacts_between(a, pose, b, pose, margin, out);
};

template <class A, class B>
concept HasContactsOverFace = requires(const A& a, const B& b, const Pose& pose, const Vec4& normal,
                                       double margin, PairContacts& out) {
    contacts_over_face(a, pose, b, pose, true, normal, margin, out);
};

template <class A, class B>
concept NamesFeaturesOverCell = requires(const A& a, const B& b, const Vec4& normal,
                                         std::uint32_t feature) {
    feature_over_cell(a, b, true, normal, feature);
};

}  // namespace

double find_contacts(BodyId a, const Shape& shape_a, const Pose& pose_a, BodyId b,
                     const Shape& shape_b, const Pose& pose_b, double margin,
                     std::vector<Contact>& list) {
    return std::visit(
        [&]<class A, class B>(const A& first, const B& second) {
            PairContacts out{a, b, !HasContacts<A, B>, list};
            if constexpr (HasContacts<A, B>) {
                contacts_between(first, pose_a, second, pose_b, margin, out);
            } else if constexpr (HasContacts<B, A>) {
                contacts_between(second, pose_b, first, pose_a, margin, out);
            } else {
                // Bodies without bounds never move: no pair function, and none is asked for.
                static_assert(!A::kBounded && !B::kBounded, "a pair without contacts_between()");
                TSR_ASSERT(is_bounded(shape_a) || is_bounded(shape_b));
            }
            return out.apart;
        },
        shape_a, shape_b);
}

void find_contacts_over_face(BodyId a, const Shape& shape_a, const Pose& pose_a, BodyId b,
                             const Shape& shape_b, const Pose& pose_b, bool face_of_b,
                             const Vec4& outward, double margin, std::vector<Contact>& list) {
    std::visit(
        [&]<class A, class B>(const A& first, const B& second) {
            if constexpr (HasContactsOverFace<A, B>) {
                PairContacts out{a, b, false, list};
                contacts_over_face(first, pose_a, second, pose_b, face_of_b, outward, margin, out);
            } else if constexpr (HasContactsOverFace<B, A>) {
                PairContacts out{a, b, true, list};
                contacts_over_face(second, pose_b, first, pose_a, !face_of_b, outward, margin, out);
            }
        },
        shape_a, shape_b);
}

std::uint32_t feature_over_face(const Shape& shape_a, const Shape& shape_b, bool face_of_b,
                                const Vec4& outward, std::uint32_t on_plane) {
    return std::visit(
        [&]<class A, class B>(const A& a, const B& b) {
            if constexpr (NamesFeaturesOverCell<A, B>)
                return feature_over_cell(a, b, face_of_b, outward, on_plane);
            else if constexpr (NamesFeaturesOverCell<B, A>)
                return feature_over_cell(b, a, !face_of_b, outward, on_plane);
            else
                return on_plane;
        },
        shape_a, shape_b);
}

}  // namespace tesserae
