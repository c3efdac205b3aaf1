// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "core/dynamics/solver/block_cholesky.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// The roots of a body's inverse mass and inverse inertia, in units of which motions are solved for
/// as blocks: the kinetic energy is then half the square of a motion. The default does not move.
struct MotionRoots {
    double mass = 0;
    BivectorMap inertia = BivectorMap::Zero();

    MotionRoots() = default;
    MotionRoots(const Simulation& simulation, const StepData& step, BodyId id) {
        const TypeProperties& type = simulation.type_of(id);
        const auto& [xy, xz, xw, yz, yw, zw] = type.inverse_inertia;
        mass = std::sqrt(type.inverse_mass);
        inertia = world_map({std::sqrt(xy), std::sqrt(xz), std::sqrt(xw), std::sqrt(yz),
                             std::sqrt(yw), std::sqrt(zw)},
                            type, step.rotor[id]);
    }

    /// Returns what an impulse at an offset from the centre does, with a moment.
    BlockCholesky::Part of(const Vec4& r, const Wrench& wrench) const {
        const Bivector moment = wedge(r, wrench.impulse) + wrench.moment;
        BlockCholesky::Part part;
        part << mass * wrench.impulse, inertia.col(0) * moment.xy + inertia.col(1) * moment.xz +
                                           inertia.col(2) * moment.xw + inertia.col(3) * moment.yz +
                                           inertia.col(4) * moment.yw + inertia.col(5) * moment.zw;
        return part;
    }
    /// Returns a motion that is in these units.
    BodyMotion motion_of(const BlockCholesky::Part& part) const {
        const Eigen::Matrix<double, 8, 1> turning = inertia * part.segment<6>(4);
        return {mass * part.head<4>(),
                {turning[0], turning[1], turning[2], turning[3], turning[4], turning[5]}};
    }
};

}  // namespace tesserae
