#include "core/dynamics/solver/joint_block.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace

std::size_t JointBlock::place_of(const Simulation& simulation, BodyId id) const {
    if (!simulation.type_of(id).movable) return bodies_.size();
    const auto place = std::lower_bound(bodies_.begin(), bodies_.end(), id);
    return static_cast<std::size_t>(place - bodies_.begin());
}

bool JointBlock::begin(const Simulation& simulation, const StepData& step,
                       std::span<const BodyId> bodies, std::span<const std::uint32_t> constraints) {
    bodies_ = bodies;
    constraints_ = constraints;
    if (bodies.size() > BlockCholesky::kMostRows || !arrange(simulation, step)) return false;
    list_rows(simulation, step);
    factorize();
    return true;
}

bool JointBlock::arrange(const Simulation& simulation, const StepData& step) {
    matrix_.begin(bodies_.size());
    joints_.clear();
    std::uint32_t rows = 0;
    for (const std::uint32_t i : constraints_) {
        const Constraint& c = step.constraints[i];
        if (c.set != ImpulseSet::kAll || c.compliance > 0) return false;
        const std::size_t a = place_of(simulation, c.a), b = place_of(simulation, c.b);
        joints_.push_back({i, rows, a, b, kBlockStiffness * c.size * c.step_mass});
        rows += static_cast<std::uint32_t>(c.size);
        if (std::max(a, b) < bodies_.size()) matrix_.couple(a, b);
    }
    return matrix_.arrange() <= kBlockWork * bodies_.size();
}

JointBlock::Part JointBlock::motion_by(std::size_t body, const Vec4& r, const Wrench& unit) const {
    const auto& [mass, map] = roots_[body];
    const Bivector moment = wedge(r, unit.impulse) + unit.moment;
    Part part;
    part << mass * unit.impulse, map.col(0) * moment.xy + map.col(1) * moment.xz +
                                     map.col(2) * moment.xw + map.col(3) * moment.yz +
                                     map.col(4) * moment.yw + map.col(5) * moment.zw;
    return part;
}

void JointBlock::list_rows(const Simulation& simulation, const StepData& step) {
    roots_.clear();
    for (const BodyId id : bodies_) {
        const TypeProperties& type = simulation.type_of(id);
        const auto& [xy, xz, xw, yz, yw, zw] = type.inverse_inertia;
        const Bivector roots = {std::sqrt(xy), std::sqrt(xz), std::sqrt(xw),
                                std::sqrt(yz), std::sqrt(yw), std::sqrt(zw)};
        roots_.push_back({std::sqrt(type.inverse_mass), world_map(roots, type, step.rotor[id])});
    }
    roots_.emplace_back();
    rows_.clear();
    for (const Joint& joint : joints_) {
        const Constraint& c = step.constraints[joint.constraint];
        for (int i = 0; i < c.size; ++i) {
            const Wrench& unit = c.rows[static_cast<std::size_t>(i)];
            rows_.push_back({-motion_by(joint.a, c.r_a, unit), motion_by(joint.b, c.r_b, unit), 0});
        }
    }
    motion_.assign(roots_.size(), Part::Zero());
}

void JointBlock::factorize() {
    matrix_.clear();
    for (std::size_t n = 0; n < joints_.size(); ++n) {
        const Joint& joint = joints_[n];
        const std::size_t end = n + 1 < joints_.size() ? joints_[n + 1].first : rows_.size();
        const double root = std::sqrt(joint.stiffness);
        for (std::size_t i = joint.first; i < end; ++i) {
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

/// Sets motion_ to what takes away what is left of all rows.
void JointBlock::solve() {
    for (Part& part : motion_) part.setZero();
    for (std::size_t n = 0; n < joints_.size(); ++n) {
        const Joint& joint = joints_[n];
        const std::size_t end = n + 1 < joints_.size() ? joints_[n + 1].first : rows_.size();
        for (std::size_t i = joint.first; i < end; ++i) {
            motion_[joint.a] += joint.stiffness * rows_[i].left * rows_[i].a;
            motion_[joint.b] += joint.stiffness * rows_[i].left * rows_[i].b;
        }
    }
    motion_.back().setZero();
    matrix_.solve(std::span(motion_).first(bodies_.size()));
}

double JointBlock::sweep(const Simulation& simulation, StepData& step) {
    double largest = 0;
    for (int solution = 0; solution < kSolutions; ++solution) {
        for (const Joint& joint : joints_) {
            const Constraint& c = step.constraints[joint.constraint];
            const RowVector left =
                c.aim - row_velocities(c, motion_of(step, c.a), motion_of(step, c.b));
            if (solution == 0) largest = std::max(largest, left.cwiseAbs().maxCoeff());
            for (int i = 0; i < c.size; ++i)
                rows_[joint.first + static_cast<std::size_t>(i)].left = left[i];
        }
        solve();
        for (const Joint& joint : joints_) {
            Constraint& c = step.constraints[joint.constraint];
            RowVector change(c.size);
            for (int i = 0; i < c.size; ++i) {
                const Row& row = rows_[joint.first + static_cast<std::size_t>(i)];
                change[i] = joint.stiffness *
                            (row.left - row.a.dot(motion_[joint.a]) - row.b.dot(motion_[joint.b]));
            }
            c.impulse += change;
            const auto of = tesserae::motion_by(simulation, step, c, change);
            for (const auto& [id, motion] : {std::pair(c.a, of[0]), std::pair(c.b, of[1])}) {
                if (!simulation.type_of(id).movable) continue;  // it may be in other islands too
                step.velocity[id] += motion.velocity;
                step.angular_velocity[id] += motion.angular_velocity;
            }
        }
    }
    return largest;
}

}  // namespace tesserae
