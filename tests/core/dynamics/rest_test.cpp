// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <tuple>
#include <vector>

#include "core/dynamics/solver/sweep.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/observed_world.hpp"

// When sweeps end, and that at the defaults what is stacked comes to rest.
namespace tesserae {
namespace {

using namespace testing;

/// The sweeps that a pass makes over one island.
/// @param residual   of a sweep, by its number
template <class Residual>
std::vector<Sweep> sweeps_of(Pass pass, const Effort& effort, const Residual& residual) {
    std::vector<Sweep> list;
    PerMember<Effort> efforts;
    efforts[0] = effort;
    iterate(pass, efforts, Members::only(0), [&](const Sweep& sweep, Members) {
        PerMember<double> residuals;
        residuals[0] = residual(static_cast<int>(list.size()));
        list.push_back(sweep);
        return residuals;
    });
    return list;
}
/// Those whose residuals are 1, 1/2, 1/4, ...
std::vector<Sweep> sweeps_of(Pass pass, const Effort& effort) {
    return sweeps_of(pass, effort, [](int number) { return std::ldexp(1.0, -number); });
}

/// Islands that are swept side by side, with efforts and residuals of their own.
TEST(Sweeps, OfSeveralIslandsAreThoseOfEachAlone) {
    std::mt19937_64 random(9);
    for (int round = 0; round < 200; ++round) {
        PerMember<Effort> efforts;
        PerMember<double> factor;
        Members some;
        for (int i = 0; i < Members::kMost; ++i) {
            if (random() % 3 == 0) continue;
            some = some | Members::only(i);
            efforts[i] = {static_cast<int>(random() % 20), random() % 5 == 0 ? -1 : 1e-3,
                          1 + static_cast<int>(random() % 4)};
            factor[i] = uniform(random, 0.3, 1.6);
        }
        const auto pass = static_cast<Pass>(random() % 3);
        PerMember<std::vector<Sweep>> lists;
        const PerMember<PassEnd> left = iterate(pass, efforts, some, [&](Sweep sweep, Members now) {
            PerMember<double> residuals;
            EXPECT_TRUE(now.any());
            for (const int i : now) {
                residuals[i] = std::pow(factor[i], lists[i].size());
                lists[i].push_back(sweep);
            }
            return residuals;
        });
        for (int i = 0; i < Members::kMost; ++i) {
            double last = 0;
            const auto alone = some.has(i)
                                   ? sweeps_of(pass, efforts[i],
                                               [&](int n) { return last = std::pow(factor[i], n); })
                                   : std::vector<Sweep>{};
            ASSERT_EQ(lists[i].size(), alone.size());
            EXPECT_EQ(left[i].residual, last);
            EXPECT_EQ(left[i].sweeps, static_cast<int>(alone.size()));
            for (std::size_t k = 0; k < alone.size(); ++k)
                EXPECT_EQ(lists[i][k].backward, alone[k].backward);
        }
    }
}

TEST(Sweeps, EndOnceTheResidualIsSmallAndInTheSameDirectionAsAll) {
    for (const Pass pass : {Pass::kSolve, Pass::kRestitution})
        for (const int most : {1, 2, 7, 8, 40})
            for (const double enough : {-1.0, 0.0, 1e-3, 0.1, 2.0}) {
                const std::vector<Sweep> list = sweeps_of(pass, {most, enough, 2});
                const auto count = static_cast<int>(list.size());
                ASSERT_GE(count, 1);
                EXPECT_EQ(list.back().backward, pass == Pass::kRestitution)
                    << most << " " << enough;
                EXPECT_TRUE(list.back().measured);
                for (int i = 1; i < count; ++i) EXPECT_NE(list[i].backward, list[i - 1].backward);
                const auto needed =
                    enough > 0 ? 1 + std::max(0, static_cast<int>(std::ceil(-std::log2(enough))))
                               : most;
                EXPECT_GE(count, std::min(most, needed));
                EXPECT_LE(count, std::min(most, needed + 1));
            }
}

TEST(Sweeps, AreSoManyAtLeastUnlessHardlyAnythingIsLeft) {
    const auto count = [](double enough) {
        return sweeps_of(Pass::kSolve, {.sweeps = 100, .enough = enough, .least = 8}).size();
    };
    EXPECT_EQ(count(0.06), 8u);                             // 1/16 is left after five
    EXPECT_EQ(count(0x1p-9), 10u);                          // after ten
    EXPECT_EQ(count(1.01 * 0x1p-6 / kHardlyAnything), 7u);  // 1/64, hardly anything of it
    EXPECT_EQ(count(1 / kHardlyAnything), 1u);
    EXPECT_EQ(count(0.25 / kHardlyAnything), 3u);
}

TEST(Sweeps, EndWhereTheyLeadAway) {
    const auto count = [](double enough, double growth) {
        return sweeps_of(Pass::kSolve, {.sweeps = 101, .enough = enough, .every = 2},
                         [&](int number) { return 1e-3 * std::pow(growth, number); })
            .size();
    };
    EXPECT_EQ(count(1e-6, 2), 9u);       // 2^8 times as large
    EXPECT_EQ(count(1e-6, 1.01), 101u);  // 2.7 times
    EXPECT_EQ(count(-1, 2), 101u) << "all are asked for";
}

Bodies on_floor() {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    return bodies;
}

void add_box(Bodies& bodies, const Vec4& size, const Vec4& place) {
    BodyType type = box_type(size, 1000 * size.prod());
    type.friction = 0.5;
    add(bodies, type, place);
}

Bodies ten_boards() {
    Bodies bodies = on_floor();
    for (int i = 0; i < 10; ++i) add_box(bodies, {2, 0.1, 0.5, 0.5}, {0, 0.05 + 0.1 * i, 0, 0});
    return bodies;
}

Bodies pyramid(int rows) {
    Bodies bodies = on_floor();
    for (int row = 0; row < rows; ++row)
        for (int i = 0; i < rows - row; ++i)
            add_box(bodies, {0.95, 1, 1, 1}, {i + 0.5 * row, 0.5 + row, 0, 0});
    return bodies;
}

TEST(Tolerance, BoundsTheResidualWhereThereAreSweepsEnough) {
    for (const std::uint32_t coloured_from : {1u, kNoneColoured})
        for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
            PhysicsSettings settings;
            settings.tolerance = tolerance;
            settings.iterations = 10000;
            Stepper world(make_simulation(pyramid(3), settings), coloured_from);
            for (int i = 0; i < 20; ++i) {
                const double residual = world.step(kStep).residual;
                EXPECT_LE(residual, tolerance) << "step " << i;
            }
        }
}

TEST(Tolerance, OfZeroMakesAllSweeps) {
    // So that more of them, after which a tolerance would long have been reached, give other bits.
    const auto end_of = [](double tolerance, int iterations) {
        PhysicsSettings settings;
        settings.tolerance = tolerance;
        settings.iterations = iterations;
        Stepper world(pyramid(3), settings);
        run(world, 20);
        return world.bodies();
    };
    EXPECT_TRUE(same_bits(end_of(1e-2, 200), end_of(1e-2, 202)));
    EXPECT_FALSE(same_bits(end_of(0, 200), end_of(0, 202)));
}

double mean_speed(const Stepper& world) {
    double sum = 0;
    for (const Vec4& v : world.bodies().velocity) sum += v.norm();
    return sum / static_cast<double>(world.bodies().size());
}

/// Ten sweeps left them at 60 mm/s for ever.
/// From starts that differ by nanometres: which of them come to rest is chance where sweeps are too
/// few.
TEST(Rest, OfTenBoards) {
    for (int start = 0; start < 3; ++start) {
        Bodies bodies = ten_boards();
        for (std::size_t i = 0; i < bodies.size(); ++i)
            if (bodies.is_movable(static_cast<BodyId>(i)))
                bodies.position[i].x() += 1e-9 * start * static_cast<double>(i);
        Stepper world(bodies, PhysicsSettings{});
        run(world, 1200);
        EXPECT_LT(mean_speed(world), 1e-4) << start;
        EXPECT_LT(world.step(kStep).penetration, 0.5e-3);
    }
}

/// As soon as a sweep changed little of them they were left: those of five to seven swayed by 0.07
/// to 1 mm/s, solved one by one.
TEST(Rest, OfSmallTowers) {
    for (int height = 2; height <= 8; ++height)
        for (const double gap : {0.0, 1e-3}) {
            Bodies bodies = on_floor();
            for (int i = 0; i < height; ++i)
                add_box(bodies, {1, 1, 1, 1},
                        {0.05 * std::sin(7 * i), 0.5 + (1 + gap) * i, 0.05 * std::cos(5 * i),
                         0.05 * std::sin(4 * i)});
            Stepper world(bodies, PhysicsSettings{});
            run(world, 1200);
            EXPECT_LT(fastest_of(world), 2e-5) << height << " " << gap;
        }
}

/// Where rounding put them apart they were let go for a step, as bodies are that are about to
/// bounce: then they tilted, and slid apart by decimetres.
TEST(Rest, OfSlipperyBoxesDoesNotDependOnRestitution) {
    for (const ColouredFrom& coloured_from : kAllWays)
        for (const double restitution : {0.3, 0.8, 1.0}) {
            BodyType box = box_type({0.6, 0.4, 0.7, 0.5}, 2);
            box.friction = 0, box.restitution = restitution;
            Bodies bodies = on_floor();
            for (int i = 0; i < 6; ++i) add(bodies, box, {0, 0.2 + 0.4 * i, 0, 0});
            Stepper world(make_simulation(bodies, PhysicsSettings{}), coloured_from);
            run(world, 5 * 240);
            for (BodyId id = 0; id < bodies.size(); ++id)
                EXPECT_LT((world.bodies().position[id] - bodies.position[id]).norm(), 1e-4)
                    << restitution << " " << id;
        }
}

/// Each sweep leaves so little of how they sway that a tolerance of 1e-4 m/s was kept by 6 mm/s.
TEST(RestSlow, OfTallTowersOfSmallCubes) {
    for (const int height : {30, 40})
        for (const double side : {0.1, 0.2}) {
            Bodies bodies = on_floor();
            for (int i = 0; i < height; ++i)
                add_box(bodies, Vec4::Constant(side), {0, (i + 0.5) * side, 0, 0});
            Stepper world(bodies, PhysicsSettings{});
            run(world, 2400);
            EXPECT_LT(fastest_of(world), 5e-4) << height << " of " << side;
        }
}

/// The lower lands while the upper still falls: they sank into each other by up to a quarter of
/// their size, were pushed apart for seconds, and fell.
/// @param towers   height, side and gap of each
void expect_towers_rest(const std::vector<std::tuple<int, double, double>>& towers) {
    for (const auto& [height, side, gap] : towers) {
        Bodies bodies = on_floor();
        for (int i = 0; i < height; ++i)
            add_box(bodies, Vec4::Constant(side), {0, (i + 0.5) * side + (i + 1) * gap, 0, 0});
        Stepper world(bodies, PhysicsSettings{});
        double deepest = 0;
        for (int i = 0; i < 960; ++i) deepest = std::max(deepest, world.step(kStep).penetration);
        EXPECT_LT(deepest, 0.02 * side) << height << " of " << side;
        Vec4 moved = world.bodies().position[BodyId(height)] - bodies.position[BodyId(height)];
        moved.y() = 0;
        EXPECT_LT(moved.norm(), 0.2 * side) << height << " of " << side;
    }
}

TEST(Rest, OfTowersThatStartWithGaps) {
    expect_towers_rest({{15, 0.01, 1e-4}, {25, 0.02, 1e-4}, {40, 0.1, 1e-3}});
}
TEST(RestSlow, OfTowersThatStartWithGaps) {
    expect_towers_rest({{40, 0.05, 3e-4}, {54, 0.1, 1e-3}});
}

/// Of 20 rows of cubes, every other one of them shorter.
Bodies wall_with_gaps(int columns, double side, double gap) {
    Bodies bodies = on_floor();
    for (int row = 0; row < 20; ++row)
        for (int i = 0; i < columns - row % 2; ++i)
            add_box(
                bodies, Vec4::Constant(side),
                {(i + 0.5 * (row % 2)) * (side + gap), (row + 0.5) * side + (row + 1) * gap, 0, 0});
    return bodies;
}

/// It swayed on by 6 mm/s, and one of 22 rows and 20 columns fell: sweeps ended after ten while
/// they went along directions.
TEST(Rest, OfAWallThatStartsWithGaps) {
    const double side = 0.1;
    Stepper world(wall_with_gaps(8, side, 3e-4), PhysicsSettings{});
    double deepest = 0;
    for (int i = 0; i < 960; ++i) deepest = std::max(deepest, world.step(kStep).penetration);
    EXPECT_LT(deepest, 0.01 * side);
    EXPECT_LT(fastest_of(world), 2e-3);
}

/// Its contacts are too many for more than 13 sweeps but for those further ones: without these it
/// sways by 37 mm/s, and ever more.
TEST(RestSlow, OfALongerWallThatStartsWithGaps) {
    Stepper world(wall_with_gaps(16, 0.1, 1e-4), PhysicsSettings{});
    run(world, 480);
    EXPECT_LT(fastest_of(world), 1e-3);
}

/// Solved one by one what is heavy slid off, at 2 m/s: 50 sweeps did not find out what weighs on
/// the light one's corners.
TEST(Rest, OfAHeavyBoxOnALightOne) {
    for (const double mass : {10.0, 100.0, 1000.0})
        for (const double gap : {0.0, 1e-3, 1e-2})
            for (const double side : {1.0, 2.0}) {
                Bodies bodies = on_floor();
                for (const double size : {1.0, side}) {
                    BodyType box = box_type(Vec4::Constant(size), bodies.size() > 1 ? mass : 1);
                    box.friction = 0.5;
                    const bool is_upper = bodies.size() > 1;
                    add(bodies, box,
                        {is_upper ? 0.05 : 0, is_upper ? 1 + gap + 0.5 * size : 0.5, 0, 0});
                }
                Stepper world(bodies, PhysicsSettings{});
                run(world, 1200);
                const Vec4 moved = world.bodies().position[2] - bodies.position[2];
                // How far 1000 masses that land on one slip is rounding's: 0.02 to 20 mm of 48
                // that start up to 5 mm beside this.
                const double most = mass * gap > 5 ? 0.1 : 2e-3;
                EXPECT_LT((moved + gap * Vec4::UnitY()).norm(), most) << mass << " " << gap;
                EXPECT_LT(world.bodies().velocity[2].norm(), 2e-3) << mass << " " << gap;
            }
}

/// Solved one by one they trembled at 12 mm/s.
TEST(Rest, OfTwentyStacksOfBoards) {
    Bodies bodies = on_floor();
    for (int i = 0; i < 200; ++i)
        add_box(bodies, {2, 0.1, 0.5, 0.5}, {0, 0.05 + 0.1 * (i % 10), 1.0 * (i / 10), 0});
    Stepper world(bodies, PhysicsSettings{});
    run(world, 480);
    EXPECT_LT(mean_speed(world), 1e-3);
    EXPECT_LT(world.step(kStep).penetration, 0.1e-3);
}

TEST(Rest, OfTenBoardsLetsThemSleep) {
    PhysicsSettings settings;
    settings.sleeping = true;
    Stepper world(ten_boards(), settings);
    run(world, 480);
    EXPECT_EQ(world.step(kStep).asleep, 10u);
}

/// Mean speed of the top row of a wall after a second, at its highest in the next half.
double sway_of_wall(const PhysicsSettings& settings) {
    constexpr int kRows = 20, kColumns = 10, kSteps = 240;
    Bodies bodies = on_floor();
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column)
            add_box(bodies, {1, 0.5, 0.5, 0.5},
                    {1.05 * column + (row % 2 == 0 ? 0 : 0.25), 0.5 * (row + 0.5), 0, 0});
    Stepper world(bodies, settings);
    run(world, kSteps);
    double fastest = 0;
    for (int i = 0; i < kSteps / 2; ++i) {
        world.step(kStep);
        double sum = 0;
        for (std::size_t k = bodies.size() - kColumns; k < bodies.size(); ++k)
            sum += world.bodies().velocity[k].norm();
        fastest = std::max(fastest, sum / kColumns);
    }
    return fastest;
}

/// Gone through one way only, every pair leans to the same side, and the wall sways: by 2.7 mm/s.
TEST(Rest, OfAWallThatDoesNotSway) {
    PhysicsSettings settings;
    settings.tolerance = 0;
    settings.iterations = 40;
    // Directions made of the rounding of gravity and of the warm start sway by 1 to 5 mm/s.
    EXPECT_LT(sway_of_wall(settings), 1e-4);
}

/// Conjugate directions see what all of a wall does together: without them it sways by 17 mm/s.
TEST(Rest, OfAWallByTwelveSweeps) {
    PhysicsSettings settings;
    settings.tolerance = 0;
    settings.iterations = 12;
    EXPECT_LT(sway_of_wall(settings), 5e-3);
}

/// In one large island, in float: four times the sweeps that left it at 4 mm/s.
TEST(Rest, OfAPyramid) {
    Stepper world(pyramid(12), PhysicsSettings{});
    run(world, 720);
    EXPECT_LT(mean_speed(world), 2e-4);
    EXPECT_LT(world.step(kStep).penetration, 0.5e-3);
}

/// Twelve logs, 5, 4 and 3, between walls with some slack: where they lie on each other a hair
/// aslant both ends of what they share must carry. With more slack they roll off each other first,
/// more slowly the better their loads are solved.
TEST(RestSlow, OfAPileOfLogsBetweenWalls) {
    constexpr double kRadius = 0.3;
    for (const double slack : {1e-3, 0.01, 0.03}) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        for (const double side : {1.0, -1.0}) {
            add(bodies, plane_type({0, 0, side, 0}, -(1 + slack) * 5 * kRadius, 0.5));
            add(bodies, plane_type({0, 0, 0, side}, -(1 + slack) * kRadius, 0.5));
        }
        BodyType type = capsule_type(kRadius, 1);
        type.friction = 0.5;
        for (int row = 0; row < 3; ++row)
            for (int i = 0; i < 5 - row; ++i)
                add(bodies, type,
                    {0, kRadius * (1 + row * std::sqrt(3.0)), kRadius * (2 * i + row - 4), 0},
                    Vec4::Zero(), {}, exp(Bivector{0.25 * pi}));
        Stepper world(bodies, PhysicsSettings{});
        for (int i = 0; i < 3600; ++i) ASSERT_LT(world.step(kStep).penetration, 5e-3) << slack;
        for (BodyId id = 5; id < bodies.size(); ++id)
            EXPECT_LT(world.bodies().velocity[id].norm(), 2e-3) << slack;
    }
}

}  // namespace
}  // namespace tesserae
