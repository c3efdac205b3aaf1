// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "core/dynamics/step/step.hpp"

namespace tesserae {
namespace {

/// Contacts of a few pieces and a part of one, some apart; of those only every other one pushes.
StepData random_contacts() {
    std::mt19937_64 random(9);
    std::uniform_real_distribution<> separation(-0.02, 0.01);
    StepData step;
    for (std::size_t i = 0; i < 5 * kReportPiece + 77; ++i) {
        Contact contact;
        contact.separation = separation(random);
        step.contacts.push_back(contact);
        ContactImpulse impulse;
        impulse.normal = i % 2 == 0 ? 1 : 0;
        step.impulses.push_back(impulse);
        step.hit.push_back(random() % 5 == 0);
    }
    return step;
}

StepReport committed(StepData step) {
    Simulation simulation = make_simulation(Bodies{}, PhysicsSettings{});
    return commit_step(simulation, step);
}

TEST(StepReport, CountsAndAveragesWhatTouchesOrPushes) {
    StepData step = random_contacts();
    begin_report(step);
    sum_contacts(step, {0, step.contacts.size()});
    const StepReport report = committed(step);

    std::uint64_t count = 0;
    double deepest = 0;
    long double sum = 0;
    for (std::size_t i = 0; i < step.contacts.size(); ++i) {
        const double s = step.contacts[i].separation;
        if (s > 0 && step.impulses[i].normal == 0 && !step.hit[i]) continue;
        ++count;
        if (s < 0) deepest = std::max(deepest, -s), sum += -s;
    }
    ASSERT_LT(count, step.contacts.size());
    EXPECT_EQ(report.contacts, count);
    EXPECT_EQ(report.penetration, deepest);
    // 5e3 roundings of half an ulp of the sum at most.
    const double mean = static_cast<double>(sum / static_cast<long double>(count));
    EXPECT_NEAR(report.mean_penetration, mean, 5e3 * 1.2e-16 * mean);
}

TEST(StepReport, HasTheSameBitsInWhateverOrderItsPiecesAreMade) {
    StepData forward = random_contacts(), backward = forward;
    const std::size_t count = forward.contacts.size();
    begin_report(forward);
    sum_contacts(forward, {0, count});
    begin_report(backward);
    for (std::size_t piece = backward.sums.size(); piece-- > 0;)
        sum_contacts(backward, {piece * kReportPiece, std::min(count, (piece + 1) * kReportPiece)});
    EXPECT_EQ(committed(forward).mean_penetration, committed(backward).mean_penetration);
}

}  // namespace
}  // namespace tesserae
