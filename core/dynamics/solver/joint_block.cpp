// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/joint_block.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tesserae {
namespace {

/// The most products of blocks that a factor may take, for each body. A chain takes 2, a net of 8
/// by 8 about 20.
constexpr std::size_t kBlockWork = 32;
/// The stiffness of a row, as a multiple of the mass that it moves. Less: more solutions are
/// needed. More: rounding is left.
constexpr double kBlockStiffness = 1e7;
/// The number of solutions of a sweep. Two leave 1e-9 of what there was where a link bears a
/// thousand times its mass.
constexpr int kSolutions = 3;
/// The square of the frequency of a swing across the pulls, times (h/2)^2, from which on it gets
/// geometric stiffness. Without, it is unstable from 1 on.
constexpr double kFastSwing = 0.25;
/// From this part of a body's radius on by which its joint goes round it in a sub-step [rad], the
/// joint's gains and losses are not even. A tenth: they are even to some 0.5 % of the energy there.
constexpr double kFarTurn = 0.1;
/// The part of a row's own response below which the block holds it, and its impulse moves nothing.
constexpr double kHeldByBlock = 1e-6;

Bivector unit_plane(int plane) {
    const auto at = [plane](int i) { return i == plane ? 1.0 : 0.0; };
    return {at(0), at(1), at(2), at(3), at(4), at(5)};
}

void apply_impulses(const Simulation& simulation, StepData& step, Constraint& c,
                    const RowVector& change) {
    c.impulse += change;
    const auto of = motion_by(simulation, step, c, change);
    for (const auto& [id, motion] : {std::pair(c.a, of[0]), std::pair(c.b, of[1])}) {
        if (!simulation.is_movable(id)) continue;  // it may be in other islands too
        step.velocity[id] += motion.velocity;
        step.angular_velocity[id] += motion.angular_velocity;
    }
}

}  // namespace

RowVector JointBlock::velocities_of(const StepData& step, const Constraint& c) {
    const auto motion = [&](BodyId id) {
        return id == kWorld ? BodyMotion{} : motion_of(step, id);
    };
    return row_velocities(c, motion(c.a), motion(c.b));
}

RowVector JointBlock::left_of(const StepData& step, const Constraint& c) {
    return c.aim - velocities_of(step, c) - c.compliance * c.impulse;
}

/// Whether the block holds it: what has no bound. A spring does nothing in the instant of an
/// impact.
bool JointBlock::is_direct(const Constraint& constraint) const {
    const bool is_spring = constraint.set == ImpulseSet::kBox &&
                           constraint.most == std::numeric_limits<double>::infinity();
    return constraint.set == ImpulseSet::kAll || (is_spring && cause_ == Cause::kLoad);
}

std::size_t JointBlock::place_of(const Simulation& simulation, BodyId id) const {
    if (!simulation.is_movable(id)) return bodies_.size();
    const auto place = std::lower_bound(bodies_.begin(), bodies_.end(), id);
    return static_cast<std::size_t>(place - bodies_.begin());
}

void JointBlock::list_bodies(const Simulation& simulation, const StepData& step) {
    bodies_.clear();
    for (const std::uint32_t i : constraints_)
        for (const BodyId id : {step.constraints[i].a, step.constraints[i].b})
            if (simulation.is_movable(id)) bodies_.push_back(id);
    std::sort(bodies_.begin(), bodies_.end());
    bodies_.erase(std::unique(bodies_.begin(), bodies_.end()), bodies_.end());
}

bool JointBlock::begin(const Simulation& simulation, StepData& step,
                       std::span<const std::uint32_t> constraints, Cause cause,
                       bool follows_impact) {
    constraints_ = constraints;
    cause_ = cause;
    list_bodies(simulation, step);
    const bool is_one = bodies_.size() <= BlockCholesky::kMostRows && arrange(simulation, step);
    for (const std::uint32_t i : constraints) step.constraints[i].in_block = is_one;
    if (!is_one) return false;
    list_rows(simulation, step);
    list_stiffness(step);
    factorize();
    list_bounded(simulation, step);
    gain_.begin(simulation, step, bodies_, cause);
    projections_ = 0;
    // After an impact joints have to do some work, as bodies begin to turn otherwise.
    has_uneven_work_ = !follows_impact && turns_far(simulation, step);
    return true;
}

bool JointBlock::arrange(const Simulation& simulation, const StepData& step) {
    matrix_.begin(bodies_.size());
    joints_.clear();
    std::uint32_t rows = 0;
    for (const std::uint32_t i : constraints_) {
        const Constraint& c = step.constraints[i];
        if (!is_direct(c)) continue;
        const std::size_t a = place_of(simulation, c.a), b = place_of(simulation, c.b);
        const auto end = rows + static_cast<std::uint32_t>(c.size);
        const double response =
            (c.response - c.compliance * RowMatrix::Identity(c.size, c.size)).norm();
        const double stiff = response > 0 ? kBlockStiffness * c.size / response : 0;
        const double stiffness = stiff / (1 + stiff * c.compliance);
        joints_.push_back({i, rows, end, a, b, stiffness});
        rows = end;
        if (std::max(a, b) < bodies_.size()) matrix_.couple(a, b);
    }
    return matrix_.arrange() <= kBlockWork * bodies_.size();
}

void JointBlock::list_rows(const Simulation& simulation, const StepData& step) {
    roots_.clear();
    for (const BodyId id : bodies_) roots_.emplace_back(simulation, step, id);
    roots_.emplace_back();
    rows_.clear();
    for (const Joint& joint : joints_) {
        const Constraint& c = step.constraints[joint.constraint];
        for (int i = 0; i < c.size; ++i) {
            const Wrench& unit = c.rows[static_cast<std::size_t>(i)];
            rows_.push_back({-roots_[joint.a].of(c.r_a, unit), roots_[joint.b].of(c.r_b, unit)});
        }
    }
    motion_.assign(roots_.size(), Part::Zero());
}

/// By the last sub-step's pulls.
void JointBlock::list_stiffness(const StepData& step) {
    stiffness_.clear();
    if (cause_ != Cause::kLoad) return;
    pulls_.assign(bodies_.size(), Angles::Zero());
    const auto add = [&](std::size_t body, const Vec4& r, const Vec4& pull) {
        if (body == bodies_.size()) return;
        Eigen::Matrix<double, 4, 6> of_r, of_pull;
        for (int plane = 0; plane < 6; ++plane) {
            of_r.col(plane) = velocity_at(unit_plane(plane), r);
            of_pull.col(plane) = velocity_at(unit_plane(plane), pull);
        }
        const Angles angles = of_pull.transpose() * of_r;
        pulls_[body] += 0.5 * (angles + angles.transpose());
    };
    for (const Joint& joint : joints_) {
        const Constraint& c = step.constraints[joint.constraint];
        const Vec4 pull = step.joint_impulses[c.part].impulse / step.h;
        add(joint.a, c.r_a, -pull);
        add(joint.b, c.r_b, pull);
    }
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
        const auto root = roots_[body].inertia.topRows<6>();
        const Angles swings = 0.25 * step.h * step.h * root.transpose() * pulls_[body] * root;
        if (!(swings.norm() > kFastSwing)) continue;
        const Eigen::SelfAdjointEigenSolver<Angles> parts(swings);
        for (int i = 0; i < 6; ++i) {
            if (!(parts.eigenvalues()[i] > 0)) continue;
            Part part = Part::Zero();
            part.segment<6>(4) = std::sqrt(parts.eigenvalues()[i]) * parts.eigenvectors().col(i);
            stiffness_.emplace_back(body, part);
        }
    }
}

void JointBlock::factorize() {
    matrix_.clear();
    for (const auto& [body, part] : stiffness_) matrix_.add(body, part);
    for (const Joint& joint : joints_) {
        const double root = std::sqrt(joint.stiffness);
        for (std::size_t i = joint.first; i < joint.end; ++i) {
            const Part a = root * rows_[i].a, b = root * rows_[i].b;
            if (std::max(joint.a, joint.b) < bodies_.size())
                matrix_.add(joint.a, a, joint.b, b);
            else if (joint.a < bodies_.size())
                matrix_.add(joint.a, a);
            else
                matrix_.add(joint.b, b);
        }
    }
    matrix_.factorize();
}

/// A unit impulse of each, with what the rows of the block answer.
void JointBlock::list_bounded(const Simulation& simulation, const StepData& step) {
    bounded_.clear();
    answers_.clear();
    for (const std::uint32_t i : constraints_) {
        const Constraint& c = step.constraints[i];
        if (is_direct(c) || (cause_ == Cause::kImpact && !c.is_firm())) continue;
        const std::size_t place_a = place_of(simulation, c.a), place_b = place_of(simulation, c.b);
        for (int row = 0; row < c.size; ++row) {
            const Wrench& unit = c.rows[static_cast<std::size_t>(row)];
            const Part a = -roots_[place_a].of(c.r_a, unit), b = roots_[place_b].of(c.r_b, unit);
            for (Part& part : motion_) part.setZero();
            motion_[place_a] += a;
            motion_[place_b] += b;
            motion_.back().setZero();
            matrix_.solve(std::span(motion_).first(bodies_.size()));
            const double own = a.squaredNorm() + b.squaredNorm();
            const double response = a.dot(motion_[place_a]) + b.dot(motion_[place_b]);
            if (!(response > kHeldByBlock * own)) continue;
            bounded_.push_back({i, row, response + c.compliance, answers_.size()});
            for (const Joint& joint : joints_)
                for (std::size_t k = joint.first; k < joint.end; ++k)
                    answers_.push_back(-joint.stiffness * (rows_[k].a.dot(motion_[joint.a]) +
                                                           rows_[k].b.dot(motion_[joint.b])));
        }
    }
}

/// A row's velocity by motion_.
double JointBlock::answer_of(const Joint& joint, const Row& row) const {
    return row.a.dot(motion_[joint.a]) + row.b.dot(motion_[joint.b]);
}

/// Sets motion_ to what takes away what is left of all rows.
void JointBlock::solve() {
    for (Part& part : motion_) part.setZero();
    for (const Joint& joint : joints_) {
        for (std::size_t i = joint.first; i < joint.end; ++i) {
            motion_[joint.a] += joint.stiffness * rows_[i].left * rows_[i].a;
            motion_[joint.b] += joint.stiffness * rows_[i].left * rows_[i].b;
        }
    }
    motion_.back().setZero();
    matrix_.solve(std::span(motion_).first(bodies_.size()));
}

/// Sets the changes of the rows' impulses by motion_.
void JointBlock::set_changes() {
    for (const Joint& joint : joints_)
        for (std::size_t i = joint.first; i < joint.end; ++i)
            rows_[i].change = joint.stiffness * (rows_[i].left - answer_of(joint, rows_[i]));
}

/// The changes of the rows' impulses.
void JointBlock::apply(const Simulation& simulation, StepData& step) const {
    for (const Joint& joint : joints_) {
        Constraint& c = step.constraints[joint.constraint];
        RowVector change(c.size);
        for (int i = 0; i < c.size; ++i)
            change[i] = rows_[joint.first + static_cast<std::size_t>(i)].change;
        apply_impulses(simulation, step, c, change);
    }
}

/// With geometric stiffness, or rows other than those of the constraints. Momentum stays to
/// rounding, as motion_ becomes what the impulses do.
void JointBlock::apply_motion(StepData& step) {
    moments_.clear();
    for (const auto& [body, part] : stiffness_) moments_.push_back(-part.dot(motion_[body]));
    for (Part& part : motion_) part.setZero();
    for (const Joint& joint : joints_) {
        Constraint& c = step.constraints[joint.constraint];
        for (std::size_t i = joint.first; i < joint.end; ++i) {
            c.impulse[static_cast<int>(i - joint.first)] += rows_[i].change;
            motion_[joint.a] += rows_[i].change * rows_[i].a;
            motion_[joint.b] += rows_[i].change * rows_[i].b;
        }
    }
    for (std::size_t i = 0; i < stiffness_.size(); ++i) {
        const auto& [body, part] = stiffness_[i];
        motion_[body] += moments_[i] * part;
        gain_.add(body, roots_[body].motion_of(moments_[i] * part));
    }
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
        const BodyMotion motion = roots_[body].motion_of(motion_[body]);
        step.velocity[bodies_[body]] += motion.velocity;
        step.angular_velocity[bodies_[body]] += motion.angular_velocity;
    }
}

double JointBlock::solve_direct(const Simulation& simulation, StepData& step) {
    double largest = 0;
    for (const Joint& joint : joints_) {
        const Constraint& c = step.constraints[joint.constraint];
        const RowVector left = left_of(step, c);
        largest = std::max(largest, left.cwiseAbs().maxCoeff());
        for (int i = 0; i < c.size; ++i)
            rows_[joint.first + static_cast<std::size_t>(i)].left = left[i];
    }
    solve();
    set_changes();
    if (stiffness_.empty())
        apply(simulation, step);
    else
        apply_motion(step);
    return largest;
}

double JointBlock::solve_bounded(const Simulation& simulation, StepData& step,
                                 const Bounded& bounded) {
    Constraint& c = step.constraints[bounded.constraint];
    const double before = c.impulse[bounded.row];
    const double left =
        c.aim[bounded.row] - velocities_of(step, c)[bounded.row] - c.compliance * before;
    const double wanted = before + left / bounded.response;
    const double after = c.set == ImpulseSet::kHalfLine ? std::max(0.0, wanted)
                                                        : std::clamp(wanted, -c.most, c.most);
    const double change = after - before;
    if (change == 0) return 0;
    RowVector own = RowVector::Zero(c.size);
    own[bounded.row] = change;
    apply_impulses(simulation, step, c, own);
    for (std::size_t k = 0; k < rows_.size(); ++k)
        rows_[k].change = change * answers_[bounded.answer + k];
    apply(simulation, step);
    return std::abs(change * bounded.response);
}

void JointBlock::solve_directly(const Simulation& simulation, StepData& step) {
    for (int solution = 0; solution < kSolutions; ++solution) solve_direct(simulation, step);
}

/// Whether some body turns far about a joint.
bool JointBlock::turns_far(const Simulation& simulation, const StepData& step) const {
    const auto turns = [&](BodyId id, const Vec4& r) {
        return simulation.is_movable(id) && step.h * norm(step.angular_velocity[id]) * r.norm() >
                                                kFarTurn * simulation.type_of(id).radius;
    };
    return std::any_of(joints_.begin(), joints_.end(), [&](const Joint& joint) {
        const Constraint& c = step.constraints[joint.constraint];
        return turns(c.a, c.r_a) || turns(c.b, c.r_b);
    });
}

double JointBlock::sweep(const Simulation& simulation, StepData& step, Pass pass) {
    double largest = 0;
    for (int solution = 0; solution < kSolutions && !joints_.empty(); ++solution) {
        const double left = solve_direct(simulation, step);
        if (solution == 0) largest = left;
    }
    if (cause_ == Cause::kLoad && pass == Pass::kSolve) aim_again(simulation, step);
    for (const Bounded& bounded : bounded_) {
        const Constraint& c = step.constraints[bounded.constraint];
        if (pass == Pass::kCorrection && !c.is_firm()) continue;
        largest = std::max(largest, solve_bounded(simulation, step, bounded));
    }
    return largest;
}

void JointBlock::end(const Simulation& simulation, StepData& step) {
    if (cause_ == Cause::kLoad) gain_.give_momentum_back(simulation, step, constraints_);
    if (has_uneven_work_ || has_stiffness()) gain_.give_energy_back(simulation, step, constraints_);
}

}  // namespace tesserae
