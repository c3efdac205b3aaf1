#include "core/contact/find_contacts.hpp"

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

}  // namespace

void find_contacts(BodyId a, const Shape& shape_a, const Pose& pose_a, BodyId b,
                   const Shape& shape_b, const Pose& pose_b, double margin,
                   std::vector<Contact>& list) {
    std::visit(
        [&]<class A, class B>(const A& first, const B& second) {
            if constexpr (HasContacts<A, B>) {
                PairContacts out{a, b, false, list};
                contacts_between(first, pose_a, second, pose_b, margin, out);
            } else if constexpr (HasContacts<B, A>) {
                PairContacts out{a, b, true, list};
                contacts_between(second, pose_b, first, pose_a, margin, out);
            } else {
                // Bodies without bounds never move: no pair function, and none is asked for.
                static_assert(!A::kBounded && !B::kBounded, "a pair without contacts_between()");
                TSR_ASSERT(is_bounded(shape_a) || is_bounded(shape_b));
            }
        },
        shape_a, shape_b);
}

}  // namespace tesserae
