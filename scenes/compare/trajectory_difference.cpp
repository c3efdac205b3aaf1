// SPDX-License-Identifier: Apache-2.0
#include "scenes/compare/trajectory_difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/error.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/trajectory/trajectory_layout.hpp"

namespace tesserae::scenes {
namespace {

constexpr const char* kAxes[] = {"x", "y", "z", "w"};
constexpr const char* kPlanes[] = {"xy", "xz", "xw", "yz", "yw", "zw"};
constexpr const char* kRotorParts[] = {"s", "xy", "xz", "xw", "yz", "yw", "zw", "xyzw"};

/// "position.x"; the width tells vectors, bivectors and rotors apart.
std::string component_name(const char* name, std::size_t width, std::size_t component) {
    if (width == 1) return name;
    const char* part = width == 4   ? kAxes[component]
                       : width == 6 ? kPlanes[component]
                                    : kRotorParts[component];
    return fmt::format("{}.{}", name, part);
}

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// Rows of the same step in both trajectories.
struct RowPair {
    std::uint64_t a = 0, b = 0;
};

void add_step(LoneSteps& steps, std::uint64_t step) {
    if (steps.count++ == 0) steps.first = step;
    steps.last = step;
}

std::vector<RowPair> match_steps(const std::vector<std::uint64_t>& a,
                                 const std::vector<std::uint64_t>& b,
                                 TrajectoryDifference& difference) {
    std::vector<RowPair> pairs;
    std::size_t i = 0, j = 0;
    while (i < a.size() || j < b.size()) {
        if (j == b.size() || (i < a.size() && a[i] < b[j]))
            add_step(difference.only_a, a[i++]);
        else if (i == a.size() || b[j] < a[i])
            add_step(difference.only_b, b[j++]);
        else
            pairs.push_back({i++, j++});
    }
    return pairs;
}

/// Both trajectories, read at the same steps.
class RowComparison {
  public:
    RowComparison(const std::filesystem::path& a, const std::filesystem::path& b) : a_(a), b_(b) {}

    void compare(TrajectoryDifference& difference);

  private:
    void read(const RowPair& row) {
        a_.read_row(row.a, state_a_);
        b_.read_row(row.b, state_b_);
    }
    FirstDifference found(const RowPair& row) const {
        FirstDifference found;
        found.step = a_.steps()[row.a];
        found.time = a_.times()[row.a];
        return found;
    }
    std::optional<FirstDifference> first_in(const RowPair& row);
    std::optional<FirstDifference> first_state(const RowPair& row) const;
    std::optional<FirstDifference> first_observable(const RowPair& row) const;
    std::optional<FirstDifference> first_of_joints(const RowPair& row) const;
    bool is_same(std::size_t body, std::size_t element) const;
    StepDifference sum_up(const RowPair& row);

    TrajectoryReader a_, b_;
    Bodies state_a_, state_b_;
    std::vector<StepFacts> facts_a_, facts_b_;
};

void set_values(FirstDifference& first, double a, double b) {
    first.a = fmt::format("{}", a);
    first.b = fmt::format("{}", b);
    first.difference = std::abs(a - b);
}

bool RowComparison::is_same(std::size_t body, std::size_t element) const {
    const std::size_t width = kStateElements[element].width;
    return std::memcmp(state_arrays(state_a_)[element] + body * width,
                       state_arrays(state_b_)[element] + body * width, width * sizeof(double)) == 0;
}

/// The first body that differs, and its first component.
std::optional<FirstDifference> RowComparison::first_state(const RowPair& row) const {
    for (std::size_t body = 0; body < state_a_.size(); ++body)
        for (std::size_t e = 0; e < kStateElements.size(); ++e) {
            if (is_same(body, e)) continue;
            const StateElement& element = kStateElements[e];
            const double* a = state_arrays(state_a_)[e] + body * element.width;
            const double* b = state_arrays(state_b_)[e] + body * element.width;
            std::size_t c = 0;
            while (same_bits(a[c], b[c])) ++c;
            FirstDifference first = found(row);
            first.body = body;
            first.body_name = body_name(a_.header().effective, body);
            first.component = component_name(element.name, element.width, c);
            set_values(first, a[c], b[c]);
            return first;
        }
    return std::nullopt;
}

std::optional<FirstDifference> RowComparison::first_observable(const RowPair& row) const {
    const StepFacts &facts_a = facts_a_[row.a], &facts_b = facts_b_[row.b];
    FirstDifference first = found(row);
    if (!same_bits(facts_a.time, facts_b.time)) {
        first.component = "time";
        set_values(first, facts_a.time, facts_b.time);
        return first;
    }
    const auto values_a = observable_values(facts_a), values_b = observable_values(facts_b);
    for (std::size_t o = 0; o < kObservables.size(); ++o)
        for (std::size_t c = 0; c < kObservables[o].width; ++c) {
            std::uint64_t a, b;
            std::memcpy(&a, static_cast<const char*>(values_a[o]) + 8 * c, 8);
            std::memcpy(&b, static_cast<const char*>(values_b[o]) + 8 * c, 8);
            if (a == b) continue;
            first.component = component_name(kObservables[o].name, kObservables[o].width, c);
            if (!kObservables[o].is_count) {
                set_values(first, std::bit_cast<double>(a), std::bit_cast<double>(b));
            } else {
                first.a = fmt::format("{}", a), first.b = fmt::format("{}", b);
                first.difference = static_cast<double>(std::max(a, b) - std::min(a, b));
            }
            return first;
        }
    return std::nullopt;
}

/// The first joint that differs, and its first element.
std::optional<FirstDifference> RowComparison::first_of_joints(const RowPair& row) const {
    const std::vector<JointDescription>& joints = a_.header().joints;
    if (joints.empty() || joints.size() != b_.header().joints.size()) return std::nullopt;
    const JointFacts facts_a = a_.joints(row.a), facts_b = b_.joints(row.b);
    for (std::size_t joint = 0; joint < joints.size(); ++joint)
        for (std::size_t e = 0; e < kJointElements.size(); ++e) {
            const double a = joint_value(facts_a, e, joint), b = joint_value(facts_b, e, joint);
            if (same_bits(a, b)) continue;
            FirstDifference first = found(row);
            first.joint = joint;
            first.joint_name = joints[joint].name;
            first.component = kJointElements[e].name;
            set_values(first, a, b);
            return first;
        }
    return std::nullopt;
}

std::optional<FirstDifference> RowComparison::first_in(const RowPair& row) {
    read(row);
    auto first = first_state(row);
    if (!first) first = first_observable(row);
    return first ? first : first_of_joints(row);
}

StepDifference RowComparison::sum_up(const RowPair& row) {
    read(row);
    StepDifference sum;
    sum.step = a_.steps()[row.a];
    sum.time = a_.times()[row.a];
    for (std::size_t body = 0; body < state_a_.size(); ++body) {
        bool differs = false;
        for (std::size_t e = 0; e < kStateElements.size(); ++e) {
            if (is_same(body, e)) continue;
            differs = true;
            const std::size_t width = kStateElements[e].width;
            for (std::size_t i = body * width; i < (body + 1) * width; ++i)
                sum.largest[e] = std::max(sum.largest[e], std::abs(state_arrays(state_a_)[e][i] -
                                                                   state_arrays(state_b_)[e][i]));
        }
        sum.bodies += differs ? 1 : 0;
    }
    return sum;
}

void RowComparison::compare(TrajectoryDifference& difference) {
    const TrajectoryHeader &a = a_.header(), &b = b_.header();
    difference.bodies_a = a.bodies, difference.bodies_b = b.bodies;
    difference.joints_a = a.joints.size(), difference.joints_b = b.joints.size();
    difference.scene = first_difference(a.effective, b.effective);
    difference.motion = first_motion_difference(a.effective, b.effective);
    const std::vector<RowPair> pairs = match_steps(a_.steps(), b_.steps(), difference);
    if (a.bodies != b.bodies || pairs.empty()) return;
    // Only a file with rows shows that it has so many bodies.
    state_a_ = state_b_ = room_for(a.bodies);
    facts_a_ = a_.facts(), facts_b_ = b_.facts();

    std::size_t begin = 0;
    while (begin < pairs.size() && !(difference.first = first_in(pairs[begin]))) ++begin;
    if (begin == pairs.size()) return;
    std::size_t row = begin;
    for (std::size_t later = 1; row < pairs.size(); later *= 2) {
        difference.growth.push_back(sum_up(pairs[row]));
        row = begin + later;
    }
    if (difference.growth.back().step != a_.steps()[pairs.back().a])
        difference.growth.push_back(sum_up(pairs.back()));
}

}  // namespace

TrajectoryDifference compare_trajectories(const std::filesystem::path& a,
                                          const std::filesystem::path& b) {
    TrajectoryDifference difference;
    try {
        RowComparison(a, b).compare(difference);
    } catch (const InputError& error) {
        difference.not_compared = error.what();
    }
    return difference;
}

}  // namespace tesserae::scenes
