#include "core/dynamics/state/type_properties.hpp"

#include <algorithm>
#include <limits>

namespace tesserae {
namespace {

Bivector plane_inertias(const Vec4& J) {
    return {J[0] + J[1], J[0] + J[2], J[0] + J[3], J[1] + J[2], J[1] + J[3], J[2] + J[3]};
}

Bivector inverse(const Bivector& b) {
    return {1 / b.xy, 1 / b.xz, 1 / b.xw, 1 / b.yz, 1 / b.yw, 1 / b.zw};
}

Bivector at_least(double least, const Bivector& b) {
    return {std::max(b.xy, least), std::max(b.xz, least), std::max(b.xw, least),
            std::max(b.yz, least), std::max(b.yw, least), std::max(b.zw, least)};
}

TypeProperties properties_of(const BodyType& type) {
    TypeProperties p;
    p.friction = type.friction;
    p.rolling_friction = type.rolling_friction;
    p.restitution = type.restitution;
    p.slop = std::numeric_limits<double>::infinity();
    p.bounded = is_bounded(type.shape);
    if (!p.bounded) return p;

    p.mass = type.mass;
    p.inertia = std::visit(
        [&](const auto& shape) { return plane_inertias(second_moments(shape, type.mass)); },
        type.shape);
    if (const Rotor* axes = principal_axes_of(type.shape)) p.has_axes = true, p.axes = *axes;
    p.radius = bounding_radius(type.shape);
    p.inertia = at_least(kLeastInertia * p.mass * p.radius * p.radius, p.inertia);
    const double least_half_size = std::visit(
        [](const auto& shape) { return half_extents(shape, Mat4::Identity()).minCoeff(); },
        type.shape);
    p.slop = kSlop * least_half_size;
    p.arm = least_half_size < p.radius ? p.radius : 0;

    p.flat = std::visit([]<class S>(const S&) { return S::kBounded && IsPolytope<S>; }, type.shape);
    p.movable = is_movable(type);
    p.falls = !type.fixed_position;
    if (!type.fixed_position) p.inverse_mass = 1 / type.mass;
    const bool slips_round = p.arm == 0 && type.friction == 0;
    if (!type.fixed_rotation && !slips_round) p.inverse_inertia = inverse(p.inertia);
    const double first = p.inverse_inertia.xy;
    p.isotropic = p.inverse_inertia == Bivector{first, first, first, first, first, first};
    return p;
}

/// Applies an operator that is diagonal in a frame.
Bivector apply(const Bivector& diagonal, const Rotor& rotor, const Bivector& b) {
    return rotate(rotor, scaled(diagonal, rotate(reverse(rotor), b)));
}

}  // namespace

std::vector<TypeProperties> type_properties(const Bodies& bodies) {
    std::vector<TypeProperties> all;
    all.reserve(bodies.types.size());
    for (const BodyType& type : bodies.types) all.push_back(properties_of(type));
    return all;
}

Bivector angular_response(const TypeProperties& type, const Rotor& rotor, const Bivector& impulse) {
    if (type.isotropic) return type.inverse_inertia.xy * impulse;
    return apply(type.inverse_inertia, principal_rotor(type, rotor), impulse);
}

Bivector angular_momentum(const TypeProperties& type, const Rotor& rotor, const Bivector& omega) {
    return apply(type.inertia, principal_rotor(type, rotor), omega);
}

}  // namespace tesserae
