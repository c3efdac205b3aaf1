// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/bodies/type_properties.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>

#include "core/algebra/twin_quaternion.hpp"
#include "core/dynamics/constants.hpp"

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

double slenderness(const Bivector& b) {
    const auto [least, most] = std::minmax({b.xy, b.xz, b.xw, b.yz, b.yw, b.zw});
    return least > 0 ? most / least : 1;
}

TypeProperties properties_of(const BodyType& type, bool jointed) {
    TypeProperties p;
    p.friction = type.friction;
    p.rolling_friction = type.rolling_friction;
    p.restitution = type.restitution;
    p.group = type.group;
    p.collides_with = type.collides_with;
    p.slop = std::numeric_limits<double>::infinity();
    p.fixed = type.fixed_position || type.fixed_rotation;
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
    p.flat = std::visit([]<class S>(const S&) { return S::kBounded && IsPolytope<S>; }, type.shape);
    p.has_rim =
        std::visit([]<class S>(const S&) { return std::derived_from<S, BallProduct>; }, type.shape);
    // A 16-cell is as wide as a ball along all its axes.
    p.arm = p.flat || least_half_size < p.radius ? p.radius : 0;
    p.movable = is_movable(type);
    if (!type.fixed_position) {
        p.inverse_mass = 1 / type.mass;
        p.gravity_scale = type.gravity_scale;
        p.damping = type.damping;
    }
    if (!type.fixed_rotation) p.angular_damping = type.damping;
    const bool slips_round = p.arm == 0 && type.friction == 0 && !jointed;
    if (!type.fixed_rotation && !slips_round) p.inverse_inertia = inverse(p.inertia);
    const double first = p.inverse_inertia.xy;
    p.isotropic = p.inverse_inertia == Bivector{first, first, first, first, first, first};
    p.round = !p.movable || (p.arm == 0 && p.isotropic);
    p.fits_floats =
        !p.movable || (p.radius > 1e-9 && p.radius < 1e9 && slenderness(p.inverse_inertia) <= 1e5);
    return p;
}

/// Applies an operator that is diagonal in a frame.
Bivector apply(const Bivector& diagonal, const Rotor& rotor, const Bivector& b) {
    return rotate(rotor, scaled(diagonal, rotate(reverse(rotor), b)));
}

}  // namespace

std::vector<TypeProperties> type_properties(const Bodies& bodies, std::span<const BodyId> jointed) {
    std::vector<bool> of_jointed(bodies.types.size(), false);
    for (const BodyId id : jointed) of_jointed[bodies.type[id]] = true;
    std::vector<TypeProperties> all;
    all.reserve(bodies.types.size());
    for (std::size_t i = 0; i < bodies.types.size(); ++i)
        all.push_back(properties_of(bodies.types[i], of_jointed[i]));
    return all;
}

Bivector angular_response(const TypeProperties& type, const Rotor& rotor, const Bivector& impulse) {
    if (type.isotropic) return type.inverse_inertia.xy * impulse;
    return apply(type.inverse_inertia, principal_rotor(type, rotor), impulse);
}

Bivector angular_momentum(const TypeProperties& type, const Rotor& rotor, const Bivector& omega) {
    return apply(type.inertia, principal_rotor(type, rotor), omega);
}

BivectorMap world_map(const Bivector& diagonal, const TypeProperties& type, const Rotor& rotor) {
    using simd::Double4;
    // Turn the three principal planes that contain the first axis. The planes orthogonal to these
    // are their duals: the same numbers, with those of each pair swapped.
    const std::array<DualPlanes, 3> planes = turned_planes(to_twin(principal_rotor(type, rotor)));
    const DualPlanes each = to_dual_planes_unsigned(diagonal);
    const std::array<Double2, 3> entries{each.x, each.y, each.z};

    // One product of these has in its lanes those of two pairs, then those with one pair swapped.
    std::array<std::array<Double4, 3>, 3> twice, crossed;
    for (int k = 0; k < 3; ++k) {
        const Double2 of_axis[] = {planes[k].x, planes[k].y, planes[k].z};
        for (int i = 0; i < 3; ++i) {
            twice[k][i] = __builtin_shufflevector(of_axis[i], of_axis[i], 0, 1, 0, 1);
            crossed[k][i] = __builtin_shufflevector(of_axis[i], of_axis[i], 0, 1, 1, 0);
        }
    }
    BivectorMap map;
    map.bottomRows<2>().setZero();
    // The places of the pairs (xy, zw), (xz, wy), (xw, yz) and the sign of wy = -yw.
    constexpr int kFirst[] = {0, 1, 2}, kSecond[] = {5, 4, 3};
    constexpr double kSign[] = {1, -1, 1};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) {
            Double4 sum{}, of_duals{};
            for (int k = 0; k < 3; ++k) {
                const Double4 products = twice[k][i] * crossed[k][j];
                sum += entries[k][0] * products;
                of_duals += entries[k][1] * products;
            }
            // A dual's products are its plane's with the lanes swapped.
            sum += __builtin_shufflevector(of_duals, of_duals, 1, 0, 3, 2);
            const auto set = [&](int row, int column, double value) {
                map(row, column) = map(column, row) = value;
            };
            set(kFirst[i], kFirst[j], sum[0]);
            set(kSecond[i], kSecond[j], kSign[i] * kSign[j] * sum[1]);
            set(kFirst[i], kSecond[j], kSign[j] * sum[2]);
            set(kSecond[i], kFirst[j], kSign[i] * sum[3]);
        }
    return map;
}

}  // namespace tesserae
