// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/constraint.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {
namespace {

/// The part of the largest response below which a row has none: what it would move cannot move.
constexpr double kNoRowResponse = 1e-12;

/// The inverse of a symmetric matrix where it has one: along its other directions, 0.
template <class Matrix>
Matrix inverse_of(const Matrix& matrix) {
    const Eigen::LLT<Matrix> factor(matrix);
    if (factor.info() == Eigen::Success && factor.rcond() > kNoRowResponse)
        return factor.solve(Matrix::Identity(matrix.rows(), matrix.cols()));
    const Eigen::SelfAdjointEigenSolver<RowMatrix> solver{RowMatrix(matrix)};
    const RowVector& values = solver.eigenvalues();
    const double least = kNoRowResponse * values.cwiseAbs().maxCoeff();
    const RowVector inverse =
        values.unaryExpr([&](double value) { return value > least ? 1 / value : 0; });
    return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

BodyMotion motion_by(const Simulation& simulation, const StepData& step, BodyId id, const Vec4& r,
                     const Wrench& wrench) {
    if (!simulation.is_movable(id)) return {};
    const TypeProperties& type = simulation.type_of(id);
    BodyMotion motion{type.inverse_mass * wrench.impulse, {}};
    if (simulation.needs.turning)
        motion.angular_velocity =
            angular_response(simulation, step, id, wedge(r, wrench.impulse) + wrench.moment);
    return motion;
}

/// Of one row after the other.
RowVector solve_one_by_one(const Constraint& constraint, RowVector left) {
    RowVector change = RowVector::Zero(constraint.size);
    for (int i = 0; i < constraint.size; ++i) {
        const double response = constraint.response(i, i), before = constraint.impulse[i];
        if (!(response > 0)) continue;
        const double wanted = before + left[i] / response;
        const double after = constraint.set == ImpulseSet::kHalfLine
                                 ? std::max(0.0, wanted)
                                 : std::clamp(wanted, -constraint.most, constraint.most);
        change[i] = after - before;
        left -= change[i] * constraint.response.col(i);
    }
    return change;
}

RowVector in_ball(const RowVector& impulse, double radius) {
    const double squared = impulse.squaredNorm();
    if (squared <= radius * radius) return impulse;
    return radius / std::sqrt(squared) * impulse;
}

}  // namespace

std::array<BodyMotion, 2> motion_by(const Simulation& simulation, const StepData& step,
                                    const Constraint& constraint, const RowVector& impulses) {
    const Wrench on_b = wrench_of(constraint, impulses);
    const Wrench on_a = {-on_b.impulse, -on_b.moment};
    return {motion_by(simulation, step, constraint.a, constraint.r_a, on_a),
            motion_by(simulation, step, constraint.b, constraint.r_b, on_b)};
}

RowVector row_velocities(const Constraint& constraint, const BodyMotion& a, const BodyMotion& b) {
    const Bivector turning = b.angular_velocity - a.angular_velocity;
    const Vec4 velocity = b.velocity + velocity_at(b.angular_velocity, constraint.r_b) -
                          a.velocity - velocity_at(a.angular_velocity, constraint.r_a);
    RowVector along(constraint.size);
    for (int i = 0; i < constraint.size; ++i)
        along[i] =
            constraint.rows[i].impulse.dot(velocity) + dot(constraint.rows[i].moment, turning);
    return along;
}

Wrench wrench_of(const Constraint& constraint, const RowVector& impulses) {
    Wrench sum;
    for (int i = 0; i < constraint.size; ++i) {
        sum.impulse += impulses[i] * constraint.rows[i].impulse;
        sum.moment += impulses[i] * constraint.rows[i].moment;
    }
    return sum;
}

RowVector impulses_of(const Constraint& constraint, const Wrench& wrench) {
    RowVector along(constraint.size);
    for (int i = 0; i < constraint.size; ++i)
        along[i] = constraint.rows[i].impulse.dot(wrench.impulse) +
                   dot(constraint.rows[i].moment, wrench.moment);
    switch (constraint.set) {
        case ImpulseSet::kAll:
            return along;
        case ImpulseSet::kHalfLine:
            return along.cwiseMax(0);
        case ImpulseSet::kBall:
            return in_ball(along, constraint.most);
        default:
            return along.cwiseMax(-constraint.most).cwiseMin(constraint.most);
    }
}

void set_response(const Simulation& simulation, const StepData& step, Constraint& constraint) {
    const int size = constraint.size;
    constraint.response.resize(size, size);
    for (int i = 0; i < size; ++i) {
        const auto [a, b] = motion_by(simulation, step, constraint, RowVector::Unit(size, i));
        constraint.response.col(i) = row_velocities(constraint, a, b);
    }
    constraint.response.diagonal().array() += constraint.compliance;
    if (size == 4)  // the same bits in two thirds of the time
        constraint.mass = inverse_of(Mat4(constraint.response));
    else
        constraint.mass = inverse_of(constraint.response);
    const double norm = constraint.response.norm();
    constraint.step_mass = norm > 0 ? 1 / norm : 0;
}

RowVector solve_rows(Constraint& constraint, const RowVector& velocities) {
    const RowVector left = constraint.aim - velocities - constraint.compliance * constraint.impulse;
    RowVector next = constraint.impulse;
    if (constraint.set == ImpulseSet::kAll || constraint.set == ImpulseSet::kBall) {
        next += constraint.mass.lazyProduct(left);
        // Against what is left itself, see friction_impulse().
        if (constraint.set == ImpulseSet::kBall && next.norm() > constraint.most)
            next = in_ball(constraint.impulse + constraint.step_mass * left, constraint.most);
    } else {
        next += solve_one_by_one(constraint, left);
    }
    const RowVector change = next - constraint.impulse;
    constraint.impulse = next;
    return change;
}

}  // namespace tesserae
