// SPDX-License-Identifier: Apache-2.0
#include "scenes/timeline.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"

namespace tesserae::scenes {
namespace {

Scene scene_of(double duration, double steps_per_second, double frames_per_second) {
    Scene scene;
    scene.physics = PhysicsSettings{};
    scene.physics->duration = duration;
    scene.physics->steps_per_second = steps_per_second;
    scene.render.frames_per_second = frames_per_second;
    return scene;
}

TEST(Timeline, StillHasFrameZeroOnly) {
    const Scene still;
    EXPECT_EQ(step_count(still), 0u);
    EXPECT_EQ(frame_count(still), 1);
    EXPECT_EQ(frame_count(scene_of(0, 240, 30)), 1);
}

TEST(Timeline, FramesAreThoseBeforeTheEnd) {
    EXPECT_EQ(frame_count(scene_of(3, 240, 30)), 90);
    EXPECT_EQ(frame_count(scene_of(2, 240, 24)), 48);
    EXPECT_EQ(frame_count(scene_of(0.1, 240, 30)), 3);  // 0, 1/30, 2/30; 3/30 is not before 0.1
    EXPECT_EQ(frame_count(scene_of(1e-9, 240, 30)), 1);
    // The rule itself, at rates whose product with the duration rounds either way.
    for (int rate = 1; rate < 200; ++rate)
        for (double duration : {0.1, 0.3, 0.7, 1.1, 2.2, 3.3}) {
            const int count = frame_count(scene_of(duration, 240, rate));
            EXPECT_LT((count - 1) / double(rate), duration);
            EXPECT_GE(count / double(rate), duration);
        }
}

TEST(Timeline, FrameOnAStepNeedsThatStepAlone) {
    for (int frame = 0; frame < 48; ++frame) {
        const FrameInstant at = frame_instant(scene_of(2, 240, 24), frame);
        EXPECT_EQ(at.step, 10u * frame);
        EXPECT_EQ(at.fraction, 0);
    }
}

TEST(Timeline, FrameBetweenStepsNeedsBoth) {
    const Scene scene = scene_of(1, 100, 30);
    const FrameInstant at = frame_instant(scene, 1);  // 3.33 steps
    EXPECT_EQ(at.step, 3u);
    EXPECT_NEAR(at.fraction, 1.0 / 3.0, 1e-12);
    EXPECT_EQ(steps_for_frames(scene, {0, 1, 3}), (std::vector<std::uint64_t>{0, 3, 4, 10}));
}

TEST(Timeline, TheLastStepNeededIsThatInWhichTheLastShutterCloses) {
    Scene scene = scene_of(1, 240, 30);  // 8 steps a frame, frames 0 to 29
    EXPECT_EQ(last_step_needed(scene, {0}), 0u);
    EXPECT_EQ(last_step_needed(scene, {1, 5}), 40u);
    scene.camera.shutter = 0.5;
    EXPECT_EQ(last_step_needed(scene, {0}), 4u);
    scene.camera.shutter = 0.51;  // 4.08 steps: between 4 and 5
    EXPECT_EQ(last_step_needed(scene, {0}), 5u);
    scene.camera.shutter = 1;
    EXPECT_EQ(last_step_needed(scene, {29}), 240u);
}

TEST(Timeline, VectorsOfMotionAskForTheStepsOfTheFramesBeside) {
    Scene scene = scene_of(1, 240, 30);  // 8 steps a frame, frames 0 to 29
    scene.render.channels.motion = true;
    EXPECT_EQ(steps_needed(scene, {5}), (std::vector<std::uint64_t>{32, 40, 48}));
    EXPECT_EQ(steps_needed(scene, {0}), (std::vector<std::uint64_t>{0, 8}));
    EXPECT_EQ(steps_needed(scene, {29}), (std::vector<std::uint64_t>{224, 232}));
    scene.render.frames_per_second = 100;  // 2.4 steps a frame
    EXPECT_EQ(steps_needed(scene, {1}), (std::vector<std::uint64_t>{0, 2, 3, 4, 5}));
}

TEST(Timeline, AnOpenShutterAsksForTheStepsInside) {
    Scene scene = scene_of(1, 240, 30);  // 8 steps a frame
    EXPECT_TRUE(shutter_steps(scene, 1).empty());
    scene.camera.shutter = 0.5;
    EXPECT_EQ(shutter_steps(scene, 1), (std::vector<std::uint64_t>{9, 10, 11}));
    EXPECT_EQ(steps_needed(scene, {1}), (std::vector<std::uint64_t>{8, 12}));
    EXPECT_EQ(steps_for_frames(scene, {1}), (std::vector<std::uint64_t>{8, 9, 10, 11, 12}));
    scene.camera.shutter = 0.3;  // 8 to 10.4
    EXPECT_EQ(shutter_steps(scene, 1), (std::vector<std::uint64_t>{9, 10}));
    EXPECT_EQ(steps_needed(scene, {1}), (std::vector<std::uint64_t>{8, 10, 11}));
    scene.camera.shutter = 0.1;  // within a step
    EXPECT_TRUE(shutter_steps(scene, 1).empty());
    // No more than 16 a frame, evenly spread.
    scene = scene_of(1, 24000, 24);
    scene.camera.shutter = 1;
    const std::vector<std::uint64_t> many = shutter_steps(scene, 2);
    EXPECT_EQ(many.size(), 15u);
    EXPECT_EQ(many.front(), 2063u);
    EXPECT_EQ(many.back(), 2000u + 15 * 63);
}

TEST(Timeline, ParsesRangesInOrderWithoutRepeats) {
    EXPECT_EQ(parse_frames("", 3), (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(parse_frames("5,0-4x2,2-3", 10), (std::vector<int>{0, 2, 3, 4, 5}));
    EXPECT_EQ(parse_frames("0-9x1000000000", 10), (std::vector<int>{0}));
}

TEST(Timeline, RefusesBadRanges) {
    for (const char* bad : {"a", "1-", "-1", "3-1", "0-9x0", "1,,2", "1,", "10", "0-10", "1 2",
                            "99999999999", "1-2x", "1-2x-1", ","})
        EXPECT_THROW(parse_frames(bad, 10), InputError) << bad;
}

/// 2 KB of text would else take gigabytes.
TEST(Timeline, RefusesRangesThatOverlapWithoutEnd) {
    std::string text = "0-9999999";
    EXPECT_EQ(parse_frames(text + ",0-9999998", 10'000'000).size(), 10'000'000u);
    for (int i = 0; i < 200; ++i) text += ",0-9999999";
    EXPECT_THROW(parse_frames(text, 10'000'000), InputError);
}

TEST(Timeline, RefusesMoreFramesThanCanBeNumbered) {
    EXPECT_THROW(frame_count(scene_of(1e300, 240, 30)), InputError);
    EXPECT_THROW(step_count(scene_of(1e300, 240, 30)), InputError);
}

TEST(FramesText, IsReadAsTheSameFrames) {
    EXPECT_EQ(frames_text({}), "");
    EXPECT_EQ(frames_text({3, 7, 8, 9}), "3,7-9");
    EXPECT_EQ(frames_text({0, 2, 4, 6, 7, 8}), "0-6x2,7-8");
    EXPECT_EQ(frames_text({1, 3}), "1,3") << "two that are apart are no range";
    // All sets of ten frames.
    for (unsigned set = 1; set < 1024; ++set) {
        std::vector<int> frames;
        for (int i = 0; i < 10; ++i)
            if (set >> i & 1) frames.push_back(i);
        EXPECT_EQ(parse_frames(frames_text(frames), 10), frames) << frames_text(frames);
    }
}

}  // namespace
}  // namespace tesserae::scenes
