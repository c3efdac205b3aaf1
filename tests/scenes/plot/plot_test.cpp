// SPDX-License-Identifier: Apache-2.0
#include "scenes/plot/plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "core/error.hpp"
#include "scenes/plot/gnuplot.hpp"
#include "tests/error_of.hpp"
#include "tests/scenes/program/program.hpp"
#include "tests/scenes/trajectory/trajectory_rows.hpp"

namespace tesserae::scenes::testing {
namespace {

/// Steps of a body that falls, with a peak of overlap at one of them.
std::vector<StepFacts> falling(std::size_t steps) {
    std::vector<StepFacts> facts(steps);
    for (std::size_t i = 0; i < steps; ++i) {
        StepFacts& f = facts[i];
        f.step = i, f.time = static_cast<double>(i) / 240;
        f.kinetic_energy = f.time, f.potential_energy = 5 - f.time;
        f.momentum = {1, 2, 3, 4};
        f.angular_momentum.zw = 7;
        f.report.penetration = i == steps / 3 ? 0.25 : 0;
    }
    return facts;
}

TEST(ObservablesPlot, ShowsWhatATrajectoryStores) {
    const auto panels = observables_plot(falling(10));
    ASSERT_EQ(panels.size(), 6u);
    EXPECT_EQ(panels[0].title, "energy [J]");
    ASSERT_EQ(panels[0].lines.size(), 3u);
    EXPECT_EQ(panels[0].lines[2].name, "total");
    EXPECT_EQ(panels[0].lines[2].value, std::vector<double>(10, 5));
    EXPECT_EQ(panels[1].lines[3].value, std::vector<double>(10, 4));
    EXPECT_EQ(panels[2].lines[5].value, std::vector<double>(10, 7));
    EXPECT_TRUE(panels[4].logarithmic);
    EXPECT_EQ(panels[4].lines[0].value[3], 0.25);
}

TEST(ObservablesPlot, KeepsPeaksOfManySteps) {
    const auto panels = observables_plot(falling(100'000));
    for (const PlotPanel& panel : panels)
        for (const PlotLine& line : panel.lines) {
            EXPECT_LE(line.time.size(), 2000u);
            EXPECT_TRUE(std::is_sorted(line.time.begin(), line.time.end()));
        }
    const auto& overlap = panels[4].lines[0].value;
    EXPECT_EQ(*std::max_element(overlap.begin(), overlap.end()), 0.25);
}

TEST(JointsPlot, ShowsPositionsOfJointsThatHaveOne) {
    std::vector<StepFacts> facts = falling(10);
    for (StepFacts& f : facts)
        f.joints = {{1, 2, 3}, {4, 5, 6}, {0, 0, 7}, {0, 0, 0}, {f.time, 8, 9}, {0, 0, 0}};
    const auto panels = joints_plot(facts, {{"door", "deg"}, {"rope", ""}, {"lift", "m"}});
    ASSERT_EQ(panels.size(), 6u);
    EXPECT_EQ(panels[0].title, "impulse in a step [N s]");
    ASSERT_EQ(panels[0].lines.size(), 3u);
    EXPECT_EQ(panels[0].lines[1].name, "rope");
    EXPECT_EQ(panels[0].lines[1].value, std::vector<double>(10, 2));
    EXPECT_EQ(panels[1].lines[0].value, std::vector<double>(10, 4));
    EXPECT_EQ(panels[2].lines[2].value, std::vector<double>(10, 7));
    EXPECT_EQ(panels[4].title, "position [m]");
    ASSERT_EQ(panels[4].lines.size(), 1u);
    EXPECT_EQ(panels[4].lines[0].value, std::vector<double>(10, 9));
    EXPECT_EQ(panels[5].lines[0].name, "door");
    EXPECT_EQ(panels[5].lines[0].value, panels[5].lines[0].time);
    EXPECT_EQ(joints_plot(facts, {{"a", ""}, {"b", ""}, {"c", ""}}).size(), 4u);
}

TEST(PlotScript, TextsCannotLeaveTheirPlace) {
    const std::vector<PlotPanel> panels = {{"a", false, {{"b'\nsystem 'ls", {0, 1}, {2, 3}}}}};
    const std::string script = plot_script(panels, "x'; system('ls') #\n", "svg");
    EXPECT_NE(script.find("title 'x ; system( ls ) # '"), std::string::npos) << script;
    EXPECT_NE(script.find("title 'b  system  ls'"), std::string::npos) << script;
    EXPECT_NE(gnuplot_output(script).find("</svg>"), std::string::npos);
}

TEST(PlotScript, DrawsWhatHasNoLogarithmAndNoLength) {
    // One step; zeros on a logarithmic axis; numbers that are none.
    for (const double value : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        const std::vector<PlotPanel> panels = {{"a", true, {{"b", {3}, {value}}, {"c", {3}, {0}}}}};
        EXPECT_NE(gnuplot_output(plot_script(panels, "t", "svg")).find("</svg>"),
                  std::string::npos);
    }
}

TEST(Gnuplot, ItsErrorsAreOurs) {
    EXPECT_NE(tesserae::testing::error_of<RunError>([] {
                  gnuplot_output("plot nothing\n");
              }).find("gnuplot: failed"),
              std::string::npos);
}

TEST(PlotProgram, DrawsTheSamePictureEveryTime) {
    const Folder folder("plot");
    const auto scene = folder.write("drop.toml", small_scene(0.5));
    const auto trajectory = folder.file("drop.h5");
    ASSERT_EQ(tesserae({"simulate", scene, "-o", trajectory}).status, 0);
    for (const char* name : {"a.svg", "it's $(a) \"name\".svg", "a.png"}) {
        const Outcome plot = tesserae({"plot", trajectory, "-o", folder.file(name)});
        ASSERT_EQ(plot.status, 0) << plot.err;
        EXPECT_EQ(plot.out, folder.file(name) + "\n");
    }
    const std::string svg = content(folder / "a.svg");
    EXPECT_EQ(svg.substr(0, 5), "<?xml");
    for (const char* text : {">energy [J]<", ">angular momentum [kg m²/s]<", ">time [s]<",
                             ">drop: 29 bodies, steps 0 to "})
        EXPECT_NE(svg.find(text), std::string::npos) << text;
    EXPECT_EQ(content(folder / "it's $(a) \"name\".svg"), svg);
    EXPECT_EQ(content(folder / "a.png").substr(1, 3), "PNG");
    const Outcome again = tesserae({"plot", trajectory, "-o", folder.file("a.png")});
    EXPECT_EQ(again.out, folder.file("a.png") + ": complete already\n");

    folder.write("other.svg", "mine");
    EXPECT_EQ(tesserae({"plot", trajectory, "-o", folder.file("other.svg")}).status, 2);
    EXPECT_EQ(content(folder / "other.svg"), "mine");
    const std::vector<std::string> replace = {"plot", trajectory, "-o", folder.file("other.svg"),
                                              "--overwrite"};
    EXPECT_EQ(tesserae(replace).status, 0);
    EXPECT_EQ(content(folder / "other.svg"), svg);
}

TEST(PlotProgram, DrawsJointsByTheirNames) {
    const Folder folder("plot");
    const auto trajectory = folder.file("film.h5");
    {
        TrajectoryWriter writer(trajectory, make_header(3, 3), make_steps(9), false);
        append_rows(writer, 9, 3, 3);
        writer.finish();
    }
    const Outcome plot = tesserae({"plot", trajectory, "-o", folder.file("a.svg"), "--joint",
                                   "joint-2", "--joint", "d\xc3\xa9j\xc3\xa0"});
    ASSERT_EQ(plot.status, 0) << plot.err;
    const std::string svg = content(folder / "a.svg");
    for (const char* text : {">joint-2<", ">d\xc3\xa9j\xc3\xa0<", ">position [deg]<"})
        EXPECT_NE(svg.find(text), std::string::npos) << text;
    EXPECT_EQ(svg.find(">joint-1<"), std::string::npos);
    const Outcome wrong =
        tesserae({"plot", trajectory, "-o", folder.file("b.svg"), "--joint", "jiont-2"});
    EXPECT_EQ(wrong.status, 2);
    EXPECT_NE(wrong.err.find("has no joint \"jiont-2\"; did you mean \"joint-2\"?"),
              std::string::npos)
        << wrong.err;
}

TEST(PlotProgram, SaysWhatIsWrong) {
    const Folder folder("plot");
    const auto scene = folder.write("drop.toml", small_scene(0.1));
    const auto trajectory = folder.file("drop.h5");
    ASSERT_EQ(tesserae({"simulate", scene, "-o", trajectory}).status, 0);
    EXPECT_EQ(tesserae({"plot", trajectory, "-o", folder.file("a.pdf")}).status, 2);
    EXPECT_EQ(tesserae({"plot", scene, "-o", folder.file("a.svg")}).status, 2);
    EXPECT_EQ(tesserae({"plot", trajectory, "-o", folder.file("none/a.svg")}).status, 1);
    const std::string path = std::getenv("PATH");
    ::setenv("PATH", folder.path().c_str(), 1);
    const Outcome without = tesserae({"plot", trajectory, "-o", folder.file("a.svg")});
    ::setenv("PATH", path.c_str(), 1);
    EXPECT_EQ(without.status, 1);
    EXPECT_NE(without.err.find("apt-get install gnuplot-nox"), std::string::npos) << without.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "a.svg"));
}

}  // namespace
}  // namespace tesserae::scenes::testing
