// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "scenes/trajectory/trajectory.hpp"

namespace tesserae::scenes {

/// Made-up rows, a pure function of their number: what a trajectory's tests store.
struct Row {
    StepFacts facts;
    Bodies bodies;
    StepMemory memory;
};

/// So many joints have twice as many parts; a third of their positions are no numbers. From row 5
/// on the last one is broken.
inline void add_joints(Row& made, std::uint64_t row, std::size_t joints) {
    std::mt19937_64 random(row + 1000);
    std::normal_distribution<double> normal;
    JointFacts& facts = made.facts.joints;
    for (std::size_t i = 0; i < joints; ++i) {
        facts.impulse.push_back(row == 0 ? 0 : normal(random));
        facts.angular_impulse.push_back(5e-324);
        facts.error.push_back(normal(random));
        facts.angular_error.push_back(0);
        facts.position.push_back(i % 3 == 0 ? std::numeric_limits<double>::quiet_NaN()
                                            : normal(random));
        facts.broken.push_back(row >= 5 && i + 1 == joints);
    }
    for (std::size_t i = 0; i < (row > 0 ? 2 * joints : 0); ++i)
        made.memory.joint_impulses.push_back(
            {{normal(random), -0.0, 1, 5e-324}, {normal(random), 1, -2, 3, 0, normal(random)}});
    if (row >= 5) made.memory.broken = facts.broken;
}

inline Row make_row(std::uint64_t row, std::size_t bodies, std::size_t joints = 0) {
    std::mt19937_64 random(row + 1);
    std::normal_distribution<double> normal;
    Row made;
    StepFacts& facts = made.facts;
    facts.step = 3 * row;
    facts.time = 0.0125 * static_cast<double>(row);
    facts.report.contacts = random() % 100;
    facts.report.penetration = normal(random);
    facts.report.mean_penetration = normal(random);
    facts.report.residual = normal(random);
    facts.report.sweeps = random() % 100;
    facts.report.asleep = random() % 100;
    facts.kinetic_energy = normal(random);
    facts.potential_energy = normal(random);
    facts.momentum = {normal(random), normal(random), -0.0, normal(random)};
    facts.angular_momentum = {normal(random), 0, normal(random), 5e-324, 1, normal(random)};
    Bodies& b = made.bodies;
    b.type.assign(bodies, 0);
    for (std::size_t i = 0; i < bodies; ++i) {
        b.position.push_back({normal(random), normal(random), normal(random), normal(random)});
        b.velocity.push_back({normal(random), normal(random), -0.0, 5e-324});
        b.angular_velocity.push_back(
            {normal(random), normal(random), normal(random), 0, 1, normal(random)});
        const double angle = normal(random);
        b.rotor.push_back({std::cos(angle), {0, 0, std::sin(angle), 0, 0, 0}, 0});
    }
    made.memory.time = made.facts.time;
    for (std::size_t i = 0; i < (row % 2 == 0 ? bodies : 0); ++i) {
        made.memory.asleep.push_back(random() % 3 == 0 ? kAwake : 0);
        made.memory.still.push_back(normal(random));
    }
    for (std::uint64_t i = 0; i < random() % 50; ++i)
        made.memory.impulses.push_back(
            {{normal(random), {static_cast<float>(normal(random)), 1e-45f, -0.0f, 1}},
             1,
             2,
             static_cast<std::uint32_t>(i)});
    for (std::uint32_t i = 0; i < (row % 4 == 0 ? bodies / 2 : 0); ++i) {
        if (i % 3 == 0) made.memory.kept.emplace_back();
        KeptManifold manifold;
        manifold.a = i, manifold.b = i + 1;
        manifold.offset = {normal(random), -0.0, 1, 5e-324};
        manifold.rotor = {normal(random), {1, 2, normal(random), 4, 5, 6}, normal(random)};
        made.memory.kept.back().push_back(std::make_shared<KeptManifold>(manifold));
    }
    for (std::size_t i = 0; i < (row % 3 == 0 ? made.memory.impulses.size() : 0); ++i)
        made.memory.angular_impulses.push_back({normal(random), 1, -0.0, 0, 5e-324, 2});
    add_joints(made, row, joints);
    return made;
}

constexpr std::size_t kMostDescribed = 50'000;

/// A floor, then balls and boxes by turns, all of one name but for the first.
inline BodyDescriptions make_descriptions(std::size_t bodies) {
    static const std::vector<BodyType> types = {
        {Hyperplane{{0, 1, 0, 0}, -1}}, {Hypersphere{0.5}, 2.5}, {Hyperbox{{1, 2, 3, 0.25}}, 1e-3}};
    static const std::vector<std::uint32_t> type = [] {
        std::vector<std::uint32_t> of_body = {0};
        while (of_body.size() < kMostDescribed) of_body.push_back(1 + of_body.size() % 2);
        return of_body;
    }();
    static const std::vector<NamedBodies> names = {{"floor", 0, 1},
                                                   {"d\xc3\xa9j\xc3\xa0", 1, kMostDescribed - 1}};
    TSR_ASSERT(bodies <= kMostDescribed);
    return {types, std::span(type).first(bodies), names};
}

/// Joints by turns without a position, with one in metres and with one in degrees.
inline std::vector<JointDescription> make_joint_descriptions(std::size_t joints) {
    const char* const units[] = {"", "m", "deg"};
    std::vector<JointDescription> described;
    for (std::size_t i = 0; i < joints; ++i)
        described.push_back(
            {i == 0 ? "d\xc3\xa9j\xc3\xa0" : "joint-" + std::to_string(i), units[i % 3]});
    return described;
}

inline TrajectoryHeader make_header(std::size_t bodies, std::size_t joints = 0) {
    return {"test",
            "# t\xc3\xa9xt\n",
            "effective",
            "0123",
            "4567",
            "tesserae",
            "0.1.0",
            bodies,
            240,
            3,
            {},
            1,
            make_descriptions(bodies),
            make_joint_descriptions(joints),
            2 * joints};
}

inline std::vector<std::uint64_t> make_steps(std::uint64_t rows) {
    std::vector<std::uint64_t> steps;
    for (std::uint64_t row = 0; row < rows; ++row) steps.push_back(3 * row);
    return steps;
}

/// Appends what is missing, up to a row; the caller finishes or not.
inline void append_rows(TrajectoryWriter& writer, std::uint64_t end, std::size_t bodies,
                        std::size_t joints = 0) {
    for (std::uint64_t i = writer.rows(); i < end; ++i) {
        const Row row = make_row(i, bodies, joints);
        writer.append(row.facts, row.bodies, row.memory);
    }
}

}  // namespace tesserae::scenes
