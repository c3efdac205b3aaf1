// SPDX-License-Identifier: Apache-2.0
#include "scenes/plan/in_slice.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parallel/threads.hpp"
#include "scenes/film/simulate.hpp"
#include "scenes/timeline.hpp"
#include "tests/scenes/load/load_scene_text.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae::scenes {
namespace {

/// What a trajectory of two seconds without gravity shows to a camera at z = -10.
SliceReport report_of(const std::string& bodies, const std::vector<std::string>& sets = {}) {
    const Scene scene = load_text(
        "[physics]\nduration = 2\ngravity = [0, 0, 0, 0]\n[render]\nsize = [80, 60]\n"
        "frames_per_second = 60\n[camera]\nposition = [0, 0, -10, 0]\nlook_at = [0, 0, 0, 0]\n" +
            bodies,
        sets);
    const tesserae::testing::TemporaryFolder folder("in_slice");
    SliceReport report;
    parallel::Threads(1).run([&] {
        simulate(scene, make_plan(scene, 1), folder / "a.h5", {.quiet = true});
        report = look_at_slice(scene, folder / "a.h5", parse_frames("", frame_count(scene)));
    });
    return report;
}

std::string ball(const std::string& name, const std::string& position,
                 const std::string& velocity) {
    return "[[body]]\nname = \"" + name +
           "\"\nshape = \"hypersphere\"\nradius = 0.5\nposition = " + position +
           "\nvelocity = " + velocity + "\n";
}

TEST(InSlice, ABallIsSeenWhileTheSliceCutsIt) {
    const SliceReport report =
        report_of(ball("through", "[0, 0, 0, -1]", "[0, 0, 0, 1]") +
                  ball("never", "[3, 0, 0, 2]", "[0, 0, 0, 1]") +
                  ball("behind", "[0, 0, -20, 0]", "[0, 0, 0, 0]") +
                  "[[body]]\nname = \"floor\"\nshape = \"hyperplane\"\nnormal = [0, 1, 0, 0]\n"
                  "offset = -9\n");
    ASSERT_EQ(report.names.size(), 3u) << "a hyperplane is always there";
    const InPicture& through = report.names[0];
    ASSERT_EQ(through.times.size(), 1u);
    EXPECT_NEAR(through.times[0].first, 0.5, 1.1 / 60);
    EXPECT_NEAR(through.times[0].second, 1.5, 1.1 / 60);
    // As a circle about the axis: twice the tangent of the angle under which it is seen.
    const double half = std::tan(std::asin(0.5 / 10)), view = std::tan(25 * 0.017453292519943295);
    EXPECT_NEAR(through.largest, half / view, 0.02 * half / view);
    EXPECT_TRUE(report.names[1].times.empty());
    EXPECT_TRUE(report.names[2].times.empty());
    EXPECT_EQ(text_of(report.names[1]), "\"never\" is never in the picture");
    EXPECT_EQ(text_of(through).find("\"through\" in the picture from 0.5"), 0u) << text_of(through);
    EXPECT_TRUE(report.warnings.empty()) << "half of the frames show it";
}

TEST(InSlice, LatticesAreCountedAndTimesListed) {
    const SliceReport report = report_of(
        "[[lattice]]\nname = \"row\"\nshape = \"hypersphere\"\nradius = 0.2\ncount = [1, 1, 1, 4]\n"
        "spacing = [1, 1, 1, 0.6]\nvelocity = [0, 0, 0, 1]\nposition = [0, 0, 0, -0.9]\n");
    ASSERT_EQ(report.names.size(), 1u);
    EXPECT_EQ(report.names[0].bodies, 4u);
    EXPECT_EQ(report.names[0].most_bodies, 1u);
    EXPECT_EQ(report.names[0].times.size(), 4u) << text_of(report.names[0]);
    EXPECT_NE(text_of(report.names[0]).find(": up to 1 of 4"), std::string::npos);
}

TEST(InSlice, WarnsOfEmptyFilmsAndOfFacesInTheSlice) {
    const auto warning = [](const SliceReport& report) {
        return report.warnings.size() == 1 ? report.warnings[0] : "not one warning";
    };
    EXPECT_NE(warning(report_of(ball("b", "[0, 0, 0, 3]", "[0, 0, 0, 0]"))).find("120 of 120"),
              std::string::npos);
    const auto box = [](const char* at, const char* more = "") {
        return std::string(
                   "[[body]]\nname = \"box\"\nshape = \"hyperbox\"\nsize = [1, 1, 1, 1]\n") +
               "position = " + at + "\n" + more;
    };
    EXPECT_NE(warning(report_of(box("[0, 0, 0, 0.5]"))).find("a face of \"box\" lies in the slice"),
              std::string::npos);
    EXPECT_TRUE(report_of(box("[0, 0, 0, 0.4999]")).warnings.empty());
    EXPECT_TRUE(report_of(box("[0, 0, 0, 0.5]"),
                          {"camera.position=[0, 0, -10, 0.1]", "camera.look_at=[0, 0, 0, 0.1]"})
                    .warnings.empty());
    // Any flat cell of any body: a 24-cell's lie at 1/sqrt 2 of its radius.
    const std::string cell =
        "[[body]]\nname = \"cell\"\nshape = \"polychoron\"\nregular = \"8-cell\"\nradius = 1\n"
        "position = [0, 0, 0, -0.5]\n";
    EXPECT_NE(warning(report_of(cell)).find("\"cell\""), std::string::npos);
}

}  // namespace
}  // namespace tesserae::scenes
