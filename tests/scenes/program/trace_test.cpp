// SPDX-License-Identifier: Apache-2.0
#include "parallel/trace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "scenes/generate/generate.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

constexpr int kSteps = 12, kSubsteps = 2;
const std::set<std::string> kStagesOfSubstep = {
    "advance_first_half", "find_pairs",          "find_contacts",
    "build_islands",      "solve_impacts",       "integrate_velocities",
    "solve_islands",      "advance_second_half", "apply_corrections"};

std::vector<std::string> arguments(const Folder& folder, const std::string& trace) {
    return {"simulate",
            folder.write("stacks.toml", generated_scene("stacks", 400)),
            "-o",
            folder.file("stacks.h5"),
            "--store-every=1",
            "--set=physics.duration=0.05",
            "--set=physics.substeps=" + std::to_string(kSubsteps),
            "--threads=2",
            "--json",
            "--trace=" + trace};
}

/// What a stage does lies within its span, whichever thread did it.
TEST(ProgramTrace, HasASpanForEveryStageAndMessagesOfIslandsWithinTheirs) {
    const Folder folder("trace");
    const Outcome run = tesserae(arguments(folder, folder.file("trace.json")));
    ASSERT_EQ(run.status, 0) << run.err;
    ASSERT_EQ(nlohmann::json::parse(run.out)["last_step"], kSteps);

    std::map<std::string, int> count;
    std::set<int> threads;
    std::map<std::string, std::uint64_t> size;
    struct Span {
        double begin, end;
    };
    std::vector<Span> solving, messages;
    const auto trace = nlohmann::json::parse(content(folder / "trace.json"));
    for (const auto& event : trace["traceEvents"]) {
        const std::string name = event["name"];
        ++count[name];
        size[name] += event["args"]["size"].get<std::uint64_t>();
        threads.insert(event["tid"].get<int>());
        const double begin = event["ts"], duration = event["dur"];
        EXPECT_GE(begin, 0);
        EXPECT_GE(duration, 0);
        if (name == "solve_impacts" || name == "solve_islands" || name == "apply_corrections")
            solving.push_back({begin, begin + duration});
        if (name == parallel::kIslandsSpan) messages.push_back({begin, begin + duration});
    }
    for (const std::string& stage : kStagesOfSubstep)
        EXPECT_EQ(count[stage], kSteps * kSubsteps) << stage;
    EXPECT_EQ(count["finish_step"], kSteps);
    EXPECT_EQ(count.size(), kStagesOfSubstep.size() + 2);
    EXPECT_GE(threads.size(), 1u);
    EXPECT_LE(threads.size(), 2u);
    // Every contact is solved once and its correction dropped once, in several messages a
    // stage.
    EXPECT_EQ(size[parallel::kIslandsSpan], 2 * size["build_islands"]);
    EXPECT_GT(messages.size(), 2 * solving.size());
    for (const Span& message : messages) {
        // Times are rounded to 1 ns.
        const bool within = std::any_of(solving.begin(), solving.end(), [&](const Span& stage) {
            return stage.begin - 0.002 <= message.begin && message.end <= stage.end + 0.002;
        });
        EXPECT_TRUE(within) << message.begin << " to " << message.end << " us";
    }
}

TEST(ProgramTrace, RefusesAFileThatCannotBeWrittenBeforeItSimulates) {
    const Folder folder("trace");
    const Outcome run = tesserae(arguments(folder, folder.file("no-such-folder/trace.json")));
    EXPECT_EQ(run.status, 1);
    EXPECT_NE(run.err.find("no-such-folder"), std::string::npos) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "stacks.h5"));
}

}  // namespace
}  // namespace tesserae::scenes::testing
