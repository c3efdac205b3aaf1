// SPDX-License-Identifier: Apache-2.0
// Differences that were put into files on purpose, and whether they are found where they are.
#include "scenes/compare/difference.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "core/error.hpp"
#include "scenes/trajectory/trajectory_layout.hpp"
#include "tests/error_of.hpp"
#include "tests/scenes/compare/written_files.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;
using tesserae::testing::error_of;

class DifferenceTest : public ::testing::Test {
  protected:
    void expect_the_flipped_is_named(int rounds);

    const Folder folder_{"difference"};
    const fs::path a_ = folder_ / "a.h5", b_ = folder_ / "b.h5";
    const fs::path image_a_ = folder_ / "a.exr", image_b_ = folder_ / "b.exr";
};
using DifferenceTestSlow = DifferenceTest;

void expect_in(const std::string& text, const std::string& words) {
    EXPECT_NE(text.find(words), std::string::npos) << text << "\nexpected: " << words;
}

void DifferenceTest::expect_the_flipped_is_named(int rounds) {
    const std::vector<std::vector<std::string>> components = {
        {"x", "y", "z", "w"},
        {"s", "xy", "xz", "xw", "yz", "yw", "zw", "xyzw"},
        {"x", "y", "z", "w"},
        {"xy", "xz", "xw", "yz", "yw", "zw"}};
    write_trajectory(a_);
    const std::string name_of_a = read_content(a_).hash();
    std::mt19937_64 random(5);
    for (int round = 0; round < rounds; ++round) {
        fs::copy_file(a_, b_, fs::copy_options::overwrite_existing);
        const std::size_t element = random() % 4, row = random() % 5, body = random() % kTestBodies;
        const std::size_t component = random() % kStateElements[element].width;
        const std::string name = kStateElements[element].name;
        flip_element(b_, ("/particles/bodies/" + name + "/value").c_str(), {row, body, component},
                     1);
        const Difference difference = compare(a_, b_);
        ASSERT_FALSE(difference.is_equal());
        EXPECT_EQ(difference.hash_a, name_of_a);
        ASSERT_EQ(difference.entries.size(), 1u);
        EXPECT_EQ(difference.entries[0].name, "/particles/bodies/" + name + "/value");
        ASSERT_TRUE(difference.trajectory->first) << text_of(difference);
        const FirstDifference& first = *difference.trajectory->first;
        EXPECT_EQ(first.step, 3 * row);
        EXPECT_EQ(first.body, body);
        EXPECT_EQ(first.component, name + "." + components[element][component]);
        // The decimals read back as neighbours: equal but for the lowest bit.
        const double value_a = std::strtod(first.a.c_str(), nullptr);
        const double value_b = std::strtod(first.b.c_str(), nullptr);
        EXPECT_EQ(std::bit_cast<std::uint64_t>(value_a) ^ std::bit_cast<std::uint64_t>(value_b),
                  1u);
        EXPECT_EQ(difference.trajectory->growth.front().bodies, 1u);
        EXPECT_EQ(difference.trajectory->growth.front().largest[element],
                  std::abs(value_a - value_b));
    }
}

TEST_F(DifferenceTest, NamesTheOneElementThatWasFlipped) { expect_the_flipped_is_named(20); }
TEST_F(DifferenceTestSlow, NamesTheOneElementThatWasFlipped) { expect_the_flipped_is_named(60); }

TEST_F(DifferenceTest, NamesObservablesTimesAndOtherDatasets) {
    write_trajectory(a_);
    const auto flipped = [&](const char* dataset, std::vector<hsize_t> at) {
        fs::copy_file(a_, b_, fs::copy_options::overwrite_existing);
        flip_element(b_, dataset, at, 1);
        return text_of(compare(a_, b_));
    };
    expect_in(flipped("/observables/contacts/value", {2}), "step 6, time 0.025 s, contacts: ");
    expect_in(flipped("/observables/momentum/value", {4, 3}), "step 12, time 0.05 s, momentum.w: ");
    expect_in(flipped("/observables/angular_momentum/value", {0, 5}), "angular_momentum.zw: ");
    expect_in(flipped("/particles/bodies/position/time", {1}), "step 3, time 0.0125 s, time: ");
    expect_in(flipped("/particles/bodies/id", {1}), "other values     /particles/bodies/id");
    // Step 9 becomes 8.
    const std::string steps = flipped("/particles/bodies/position/step", {3});
    expect_in(steps, "steps only in A  step 9");
    expect_in(steps, "steps only in B  step 8");
    // No number: said, no error.
    fs::copy_file(a_, b_, fs::copy_options::overwrite_existing);
    const double velocity = make_row(1, kTestBodies).bodies.velocity[0][0];
    flip_element(b_, "/particles/bodies/velocity/value", {1, 0, 0},
                 std::bit_cast<std::uint64_t>(velocity) ^ 0x7ff8000000000000);
    const std::string text = text_of(compare(a_, b_));
    expect_in(text, "other values     /particles/bodies/velocity/value");
    expect_in(text, "not compared");
    expect_in(text, "not finite");
}

TEST_F(DifferenceTest, GrowsAsItWasMadeTo) {
    TrajectoryHeader header = make_header(kTestBodies);
    header.effective =
        "[scene]\nname = \"x\"\n\n[[body]]\nname = \"ball\"\n\n[[lattice]]\n"
        "name = \"rain\"\ncount = [1, 2, 1, 1]\n";
    const auto none = [](std::uint64_t, Row&) {};
    write_trajectory(a_, header, 30, none);
    // From row 3 on body 2 is 2^row away, from row 9 on body 1 turns faster by row.
    write_trajectory(b_, header, 30, [](std::uint64_t i, Row& row) {
        const auto at = static_cast<double>(i);
        row.bodies.velocity[2][1] = i < 3 ? row.bodies.velocity[2][1] : std::exp2(at);
        if (i >= 9) row.bodies.angular_velocity[1].yz = -at;  // 0 in a
    });
    const Difference difference = compare(a_, b_);
    const TrajectoryDifference& trajectory = *difference.trajectory;
    ASSERT_TRUE(trajectory.first);
    EXPECT_EQ(trajectory.first->step, 9u);
    EXPECT_EQ(trajectory.first->body_name, "rain");
    EXPECT_EQ(trajectory.first->component, "velocity.y");
    EXPECT_EQ(trajectory.first->b, "8");
    std::vector<std::uint64_t> rows;
    for (const StepDifference& row : trajectory.growth) {
        const std::uint64_t i = row.step / 3;
        rows.push_back(i);
        EXPECT_EQ(row.bodies, i < 9 ? 1u : 2u);
        EXPECT_EQ(row.largest[0], 0);
        EXPECT_EQ(row.largest[2], std::abs(make_row(i, 3).bodies.velocity[2][1] -
                                           std::exp2(static_cast<double>(i))));
        EXPECT_EQ(row.largest[3], i < 9 ? 0 : static_cast<double>(i));
    }
    EXPECT_EQ(rows, (std::vector<std::uint64_t>{3, 4, 5, 7, 11, 19, 29}));
}

TEST_F(DifferenceTest, SaysWhichStepsAndHowManyBodiesOnlyOneHas) {
    write_trajectory(a_, 9);
    write_trajectory(b_, 6);
    const std::string longer = text_of(compare(a_, b_));
    expect_in(longer, "steps only in A  3 steps, the first 18, the last 24");
    expect_in(longer, "float64 [9][3][4] in A, float64 [6][3][4] in B");
    EXPECT_EQ(longer.find("first difference"), std::string::npos) << longer;
    fs::remove(b_);
    TrajectoryHeader other = make_header(kTestBodies + 1);
    other.effective = "[render]\nsamples = 4\n";
    write_trajectory(b_, other, 9, [](std::uint64_t, Row&) {});
    const std::string more = text_of(compare(a_, b_));
    expect_in(more, "bodies           3 in A, 4 in B");
    expect_in(more, "(there: A, here: B)");
    EXPECT_EQ(more.find("first difference"), std::string::npos) << more;
}

TEST_F(DifferenceTest, ComparesRowsInAnyForm) {
    write_trajectory(a_);
    TrajectoryHeader header = make_header(kTestBodies);
    write_trajectory(b_, header, 5, [](std::uint64_t i, Row& row) {
        if (i == 4) row.bodies.position[1][3] += 1;
    });
    const std::string expected = text_of(compare(a_, b_));
    expect_in(expected, "step 12, time 0.05 s, body 1 position.w: ");
    for (const Form& form : {Form{}, Form{.big_endian = true}, Form{.chunked = true}}) {
        rewrite_in_form(b_, form);
        EXPECT_EQ(text_of(compare(a_, b_)), expected);
    }
}

TEST_F(DifferenceTest, NamesTheJointThatDiffers) {
    const auto none = [](std::uint64_t, Row&) {};
    write_trajectory(a_, make_header(kTestBodies, 3), 7, none);
    const auto changed = [&](std::size_t joints, auto&& change) {
        fs::remove(b_);
        write_trajectory(b_, make_header(kTestBodies, joints), 7, change);
        return text_of(compare(a_, b_));
    };
    EXPECT_EQ(changed(3, none), "equal");
    expect_in(changed(3, [](std::uint64_t i, Row& row) { row.facts.joints.error[1] += i == 2; }),
              "step 6, time 0.025 s, joint 1 \"joint-1\" error: ");
    // What is no number is compared, too.
    const std::string position = changed(3, [](std::uint64_t i, Row& row) {
        if (i == 3) row.facts.joints.position[0] = 0.5;
    });
    expect_in(position, "joint 0 \"d\xc3\xa9j\xc3\xa0\" position: nan in A, 0.5 in B");
    expect_in(position, "other values     /joints/position/value");
    expect_in(changed(3, [](std::uint64_t i, Row& row) { row.facts.joints.broken[2] = i == 5; }),
              "step 18, time 0.07500000000000001 s, joint 2 \"joint-2\" broken: 1 in A, 0 in B, 1");
    const std::string fewer = changed(2, none);
    expect_in(fewer, "joints           3 in A, 2 in B");
    EXPECT_EQ(fewer.find("first difference"), std::string::npos) << fewer;
}

TEST(BodyName, IsThatOfItsTable) {
    const std::string text =
        "[scene]\nname = \"s\"\n\n[[body]]\nname = \"a\"\nradius = 1\n\n[[body]]\nname = \"b\"\n"
        "\n[[lattice]]\nname = \"c\"\ncount = [2, 1, 3, 1]\n\n[camera]\nname = \"d\"\n";
    const char* expected[] = {"a", "b", "c", "c", "c", "c", "c", "c", "", ""};
    for (std::uint64_t body = 0; body < std::size(expected); ++body)
        EXPECT_EQ(body_name(text, body), expected[body]) << body;
    EXPECT_EQ(body_name("[[lattice]]\ncount = [4294967295, 4294967295, 4294967295, 9]\n", 5), "");
    EXPECT_EQ(body_name("[[lattice]]\nname = \"a\"\ncount = [99999999991, 1, 1, 1]\n", 5), "");
    // In no time, however many digits there are.
    EXPECT_EQ(body_name("[[lattice]]\ncount = " + std::string(1'000'000, '9') + "\n", 5), "");
    EXPECT_EQ(body_name("effective", 0), "");
    EXPECT_EQ(body_name("", 0), "");
}

TEST_F(DifferenceTest, NamesTheFirstPixelAndSumsUpChannels) {
    WrittenImage image;
    image.floats["Z"][WrittenImage::index(2, 0)] = 0;
    image.write(image_a_);
    // Raster order: (5, 3) of Z comes before (6, 3) of R and (2, 4) of id.
    image.floats["Z"][WrittenImage::index(5, 3)] += 0.5f;
    image.floats["Z"][WrittenImage::index(20, 12)] -= 2;
    image.floats["Z"][WrittenImage::index(7, 7)] = std::numeric_limits<float>::infinity();
    image.floats["R"][WrittenImage::index(6, 3)] = std::numeric_limits<float>::quiet_NaN();
    image.ids[WrittenImage::index(2, 4)] = 10;
    image.write(image_b_, 5);
    const ImageDifference difference = compare_images(image_a_, image_b_);
    ASSERT_TRUE(difference.first);
    EXPECT_EQ(difference.first->x, 5);
    EXPECT_EQ(difference.first->y, 3);
    EXPECT_EQ(difference.first->channel, "Z");
    EXPECT_EQ(difference.first->difference, 0.5);
    ASSERT_EQ(difference.channels.size(), 3u);
    const ChannelDifference &r = difference.channels[0], &z = difference.channels[1],
                            &id = difference.channels[2];
    EXPECT_EQ(r.name, "R");
    EXPECT_EQ(r.pixels, 1u);
    EXPECT_EQ(r.not_finite, 1u);
    EXPECT_EQ(r.rms, 0);
    EXPECT_EQ(z.pixels, 3u);
    EXPECT_EQ(z.not_finite, 1u);
    EXPECT_EQ(z.largest, 2);
    EXPECT_EQ(z.x, 20);
    EXPECT_EQ(z.y, 12);
    EXPECT_EQ(z.rms, std::sqrt((0.25 + 4) / (19 * 14)));
    EXPECT_EQ(id.largest, 3);
    EXPECT_EQ(id.y, 4);
    expect_in(text_of(compare(image_a_, image_b_)), "pixel 5,3 channel Z: ");
}

TEST_F(DifferenceTest, AnUlpOfAPixelIsFound) {
    WrittenImage image;
    image.write(image_a_);
    std::mt19937 random(11);
    for (int round = 0; round < 30; ++round) {
        WrittenImage other = image;
        const int x = 2 + static_cast<int>(random() % 19), y = -1 + static_cast<int>(random() % 14);
        const std::string channel = random() % 2 == 0 ? "R" : "Z";
        float& value = other.floats[channel][WrittenImage::index(x, y)];
        const float before = value;
        value = std::nextafter(value, 1e9f);
        other.write(image_b_, round % 7);
        const Difference found = compare(image_a_, image_b_);
        ASSERT_FALSE(found.is_equal());
        EXPECT_EQ(found.image->first->x, x);
        EXPECT_EQ(found.image->first->y, y);
        EXPECT_EQ(found.image->first->channel, channel);
        EXPECT_EQ(std::stof(found.image->first->a), before);
        EXPECT_EQ(std::stof(found.image->first->b), value);
    }
}

TEST_F(DifferenceTest, ComparesWhatTwoWindowsAndChannelListsShare) {
    WrittenImage image;
    image.write(image_a_);
    auto channel = image.floats.extract("R");
    channel.key() = "red";
    image.floats.insert(std::move(channel));
    ++image.window.min.x, ++image.window.max.x;
    image.write(image_b_);
    const std::string text = text_of(compare(image_a_, image_b_));
    expect_in(text, "2,-1 to 21,13 in A, 3,-1 to 22,13 in B");
    expect_in(text, "only in A        R");
    expect_in(text, "only in B        red");
    // The same values one pixel further right: Z differs by 2/16 in all shared pixels.
    const ImageDifference difference = compare_images(image_a_, image_b_);
    ASSERT_EQ(difference.channels.size(), 1u);
    EXPECT_EQ(difference.channels[0].pixels, 18u * 14u);
    EXPECT_EQ(difference.channels[0].largest, 0.125);
    EXPECT_EQ(difference.channels[0].rms, 0.125);
    image.window.min.x += 100, image.window.max.x += 100;
    image.write(image_b_);
    EXPECT_TRUE(compare_images(image_a_, image_b_).channels.empty());
}

TEST_F(DifferenceTest, FindsTheFirstFrameThatDiffers) {
    const fs::path a = folder_ / "a", b = folder_ / "b/frames";
    fs::create_directories(a);
    fs::create_directories(b);
    WrittenImage image;
    for (const char* name : {"1.exr", "2.exr", "3.exr"}) {
        image.write(a / name);
        image.write(b / name, 0);
    }
    EXPECT_TRUE(compare(a, folder_ / "b").is_equal());
    image.ids[WrittenImage::index(4, 4)] = 8;
    image.write(b / "2.exr");
    image.write(b / "3.exr");
    image.write(b / "4.exr");
    const Difference difference = compare(a, folder_ / "b");
    EXPECT_EQ(difference.frame, "2.exr");
    EXPECT_EQ(difference.image->first->x, 4);
    expect_in(text_of(difference), "only in B        4.exr");
}

}  // namespace
}  // namespace tesserae::scenes::testing
