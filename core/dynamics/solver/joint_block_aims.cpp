// SPDX-License-Identifier: Apache-2.0
// Where the joints of a block will be if the bodies go on as they move now.
#include <algorithm>
#include <utility>

#include "core/dynamics/constraints/pose_joints.hpp"
#include "core/dynamics/solver/joint_block.hpp"

namespace tesserae {
namespace {

/// The most new aims of joints in a sweep, and the part of what they missed by before that they may
/// miss by.
constexpr int kAims = 3;
constexpr double kNearer = 0.5;
/// The most projections in a sweep, and the part of what joints missed by before that is enough.
/// The links of whips need 3, or 15 where they turn by more than a right angle in a sub-step.
constexpr int kProjections = 10;
constexpr double kProjected = 1e-3;

}  // namespace

/// Sets missed_by_, and returns the largest of it.
double JointBlock::farthest_miss(const Simulation& simulation, const StepData& step) {
    double farthest = 0;
    missed_by_.resize(joints_.size());
    for (std::size_t i = 0; i < joints_.size(); ++i) {
        const Constraint& c = step.constraints[joints_[i].constraint];
        const bool aims_again =
            c.set == ImpulseSet::kAll && simulation.joints.in_loop[c.joint] == 0;
        missed_by_[i] = aims_again ? missed_by(simulation, step, c) : RowVector();
        if (aims_again) farthest = std::max(farthest, missed_by_[i].cwiseAbs().maxCoeff());
    }
    return farthest;
}

/// Joints aim at where they hold if the bodies went on as before the load. Where they then miss,
/// for they move otherwise now, they aim so that they do not (Newton's method). It fails where no
/// impulses along the present rows hold them.
void JointBlock::aim_again(const Simulation& simulation, StepData& step) {
    double missed = farthest_miss(simulation, step);
    for (int i = 0; i < kAims && missed > step.h * simulation.settings.tolerance; ++i) {
        aims_.clear();
        for (std::size_t k = 0; k < joints_.size(); ++k) {
            Constraint& c = step.constraints[joints_[k].constraint];
            aims_.push_back(c.aim);
            if (missed_by_[k].size() > 0) c.aim -= missed_by_[k] / step.h;
        }
        solve_directly(simulation, step);
        const double before = std::exchange(missed, farthest_miss(simulation, step));
        if (missed < kNearer * before) continue;
        for (std::size_t k = 0; k < joints_.size(); ++k)
            step.constraints[joints_[k].constraint].aim = aims_[k];
        solve_directly(simulation, step);
        has_uneven_work_ = true;
        return project(simulation, step);
    }
}

/// Lists the rows as they will be in the middle of the next sub-step, with what is missed there.
void JointBlock::list_rows_ahead(const Simulation& simulation, const StepData& step) {
    for (std::size_t k = 0; k < joints_.size(); ++k) {
        const Joint& joint = joints_[k];
        Constraint ahead = step.constraints[joint.constraint];
        RowVector left = left_of(step, ahead);
        if (missed_by_[k].size() > 0) {
            pose_ahead(simulation, step, ahead);
            left = -missed_by_[k] / step.h;
        }
        for (int i = 0; i < ahead.size; ++i) {
            const Wrench& unit = ahead.rows[static_cast<std::size_t>(i)];
            rows_[joint.first + static_cast<std::size_t>(i)] = {
                -roots_[joint.a].of(ahead.r_a, unit), roots_[joint.b].of(ahead.r_b, unit), left[i]};
        }
    }
}

/// Counts what impulses along rows ahead do beside what they do along the present rows.
void JointBlock::add_moments_of_rows_ahead(const StepData& step) {
    const auto add = [&](std::size_t body, const Part& beside, double change) {
        if (body < bodies_.size()) gain_.add(body, roots_[body].motion_of(change * beside));
    };
    for (const Joint& joint : joints_) {
        const Constraint& c = step.constraints[joint.constraint];
        for (std::size_t i = joint.first; i < joint.end; ++i) {
            const Wrench& unit = c.rows[i - joint.first];
            add(joint.a, rows_[i].a + roots_[joint.a].of(c.r_a, unit), rows_[i].change);
            add(joint.b, rows_[i].b - roots_[joint.b].of(c.r_b, unit), rows_[i].change);
        }
    }
}

/// Where links turn so far in a sub-step that impulses along the present rows do not hold them,
/// impulses along the rows at its end do: each projection takes what is missed there, by the rows
/// there. It takes energy from the links that turn so (fast projection: R. Goldenthal et al.,
/// "Efficient simulation of inextensible cloth", ACM Trans. Graph. 26, 2007).
void JointBlock::project(const Simulation& simulation, StepData& step) {
    double missed = farthest_miss(simulation, step);
    const double enough = std::max(kProjected * missed, step.h * simulation.settings.tolerance);
    for (; projections_ < kProjections && missed > enough; ++projections_) {
        list_rows_ahead(simulation, step);
        factorize();
        solve();
        set_changes();
        add_moments_of_rows_ahead(step);
        apply_motion(step);
        missed = farthest_miss(simulation, step);
    }
    for (const Joint& joint : joints_) {  // later sweeps keep these velocities
        Constraint& c = step.constraints[joint.constraint];
        if (c.set == ImpulseSet::kAll) c.aim = velocities_of(step, c);
    }
    list_rows(simulation, step);
    factorize();
}

}  // namespace tesserae
