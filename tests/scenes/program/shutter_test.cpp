// SPDX-License-Identifier: Apache-2.0
// What a film with an open shutter takes from its trajectory.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

nlohmann::json done(std::vector<std::string> words) {
    words.push_back("--json");
    const Outcome outcome = tesserae(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
}

TEST(Shutter, StepsInsideItAreStoredAndUsed) {
    const Folder folder("shutter");
    const auto scene = folder.write("drop.toml", small_scene(0.35));  // 7 frames of 3 steps
    const std::string with = folder.file("with.h5"), without = folder.file("without.h5");
    const std::vector<std::string> open = {"--set", "camera.shutter=1"};
    done({"simulate", scene, "-o", without});
    done({"simulate", scene, "-o", with, open[0], open[1]});
    EXPECT_EQ(done({"info", without})["rows"], 7);
    EXPECT_EQ(done({"info", with})["rows"], 22);
    // A trajectory without them will do, but tells less.
    const auto preview = [&](const std::string& trajectory, const std::string& out) {
        done({"render", scene, "--trajectory", trajectory, "--frames", "2", open[0], open[1], "-o",
              folder.file(out)});
        return content(folder / out / "preview/drop.0002.png");
    };
    EXPECT_NE(preview(with, "a"), preview(without, "b"));
    const Outcome missing = tesserae({"render", scene, "--trajectory", without, "--frames", "6",
                                      open[0], open[1], "-o", folder.file("c")});
    EXPECT_EQ(missing.status, 2);
    EXPECT_NE(missing.err.find("step 21 is not stored"), std::string::npos) << missing.err;
}

TEST(Shutter, AFrameIsTheSameAloneAndInAFilm) {
    const Folder folder("shutter");
    const auto scene = folder.write("drop.toml", small_scene(0.35));
    const std::vector<std::string> open = {"--set", "camera.shutter=0.7"};
    done({"run", scene, "-o", folder.file("film"), open[0], open[1]});
    for (const char* frame : {"3", "6"}) {
        done({"render", scene, "--trajectory", folder.file("film/trajectory.h5"), "--frames", frame,
              "--threads", "3", open[0], open[1], "-o", folder.file(frame)});
        const std::string file = fmt::format("frames/drop.000{}.exr", frame);
        EXPECT_EQ(content(folder / "film" / file), content(folder / frame / file));
    }
}

}  // namespace
}  // namespace tesserae::scenes::testing
