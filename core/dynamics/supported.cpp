#include "core/dynamics/supported.hpp"

#include <fmt/format.h>

#include <array>

#include "core/contact/find_contacts.hpp"

namespace tesserae {
namespace {

/// The bodies of one kind of shape.
struct Kind {
    const Shape* shape = nullptr;
    std::size_t count = 0, movable = 0;
};

bool can_meet(const Kind& a, const Kind& b) {
    if (&a == &b) return a.movable > 0 && a.count > 1;
    return a.count > 0 && b.count > 0 && a.movable + b.movable > 0;
}

}  // namespace

std::optional<std::string> unsupported_contacts(const Bodies& bodies) {
    std::array<Kind, std::variant_size_v<Shape>> kinds;
    for (BodyId id = 0; id < bodies.size(); ++id) {
        const Shape& shape = bodies.type_of(id).shape;
        Kind& kind = kinds[shape.index()];
        kind.shape = &shape;
        ++kind.count;
        if (bodies.is_movable(id)) ++kind.movable;
    }
    for (std::size_t i = 0; i < kinds.size(); ++i)
        for (std::size_t j = i; j < kinds.size(); ++j)
            if (can_meet(kinds[i], kinds[j]) && !is_supported(*kinds[i].shape, *kinds[j].shape))
                return fmt::format(
                    "{} against {}: contacts of this pair are not yet built; a scene that "
                    "simulates can hold hyperspheres and hyperplanes, beside a movable body of "
                    "another shape only if it is alone",
                    name_of(*kinds[i].shape), name_of(*kinds[j].shape));
    return std::nullopt;
}

}  // namespace tesserae
