// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/bodies/needs.hpp"

#include <algorithm>
#include <cmath>

#include "core/dynamics/constants.hpp"

namespace tesserae {
namespace {

/// A rotor that is no rotation counts, so that the step that checks what turns finds it.
bool turns(const Rotor& rotor, const Bivector& omega) {
    return !(omega == Bivector{}) ||
           !std::isfinite(rotor.s * rotor.s + dot(rotor.b, rotor.b) + rotor.p * rotor.p);
}

}  // namespace

Needs needs_of(const Bodies& bodies, std::span<const TypeProperties> types) {
    const auto any = [&](auto&& has) { return std::any_of(types.begin(), types.end(), has); };
    Needs needs;
    // A pair's friction is the geometric mean, its restitution the larger one.
    needs.friction = any([](const auto& type) { return type.movable && type.friction > 0; });
    needs.very_rough = any([](const auto& type) { return type.friction > kMostConjugateFriction; });
    // The larger rolling friction counts, of a pair that has friction.
    needs.rolling =
        any([](const auto& type) { return type.friction > 0 && type.rolling_friction > 0; }) &&
        any([](const auto& type) {
            return type.movable && type.friction > 0 && !(type.inverse_inertia == Bivector{});
        });
    needs.restitution = any([](const auto& type) { return type.restitution > 0; });
    needs.uneven_inertia = any([](const auto& type) { return !type.isotropic; });
    needs.internal_edges =
        std::any_of(bodies.types.begin(), bodies.types.end(), [](const BodyType& type) {
            return std::visit([]<class S>(const S&) { return S::kBounded && HasFaces<S>; },
                              type.shape);
        });
    std::size_t flat = 0;
    for (BodyId id = 0; id < bodies.size() && flat < 2; ++id) flat += types[bodies.type[id]].flat;
    needs.manifolds = flat == 2;
    needs.turning = any([](const auto& type) { return !(type.inverse_inertia == Bivector{}); });
    for (BodyId id = 0; id < bodies.size() && !needs.turning; ++id)
        needs.turning = turns(bodies.rotor[id], bodies.angular_velocity[id]);
    needs.damping = any([](const auto& type) { return type.damping + type.angular_damping > 0; });
    needs.rims = needs.turning && any([](const auto& type) { return type.has_rim; });
    return needs;
}

}  // namespace tesserae
