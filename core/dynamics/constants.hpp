// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

// The chosen numbers of how contacts are solved. They are not derived. Each comment says what the
// number means, its unit, its usual value and what breaks when it changes. A change moves golden
// hashes: see motion_version.hpp.
namespace tesserae {

/// The overlap that the solver leaves alone (the slop), as a part of the least half-size. Usual
/// 0.005: a resting contact keeps touching. More: bodies visibly sink into each other. 0: resting
/// contacts come and go.
constexpr double kSlop = 0.005;

/// The height difference up to which faces are flush, as a part of the least half-size of the body
/// that lies on them. Usual 1e-4. More: small steps are smoothed away. Less: tiles that each rest
/// on the ground do not form one floor.
constexpr double kFlush = 1e-4;

/// The distance from a rim of the other body's face within which a contact may be an internal edge,
/// if all its points lie there, as a part of the same half-size. Usual 0.1. Less than a heavy load
/// sinks in: its body is stopped at the edge. More: the search costs more.
constexpr double kSkin = 0.1;

/// The overlap that is left to the solver, as a part of twice the least half-size of two bodies.
/// Bodies that would overlap more within half a sub-step are stopped where they touch. Usual 0.25.
/// More: the solver may push them out on the wrong side. Less: more bodies lose a part of a
/// sub-step.
constexpr double kDeepest = 0.25;

/// The distance at which stopped bodies touch, as a part of twice the least half-size of two
/// bodies. Usual 0.005. More: they stop visibly before what they hit. Less: it costs more to find.
constexpr double kTouch = 0.005;

/// The relative motion of two bodies up to which their manifold of flat faces is kept and moves
/// with both, as a part of the least half-size. Usual 0.001. More: a body that slides slowly stands
/// on where it was. Less: bodies that hardly move cost as much as moving ones.
constexpr double kKeptMotion = 0.001;

/// The gap that counts as touching, in the slop of the pair: a load does not close it. Usual 0.02.
/// 0: points that bear a load open and close as a wall trembles and keep it trembling, so that each
/// step takes several times as many sweeps. More: bodies stop visibly above the ground.
constexpr double kRestingGap = 0.02;

/// The margin within which points belong to a kept manifold, in the slop of the pair. Usual 2.
/// More: points that do not touch replace points that do. Less: only slower bodies keep theirs.
constexpr double kKeptMargin = 2;

/// The part of an overlap that a sub-step removes: f in the bias -(f/h) min(0, s + a). A position
/// correction uses it too, see is_corrected(). Usual 0.05; without a correction 0.2. Towards 1:
/// stacks jump, and bodies that start inside each other are thrown apart. Towards 0: high walls
/// topple. Without a correction walls tremble.
constexpr double kBiasPart = 0.05;

/// The overlap beyond the slop up to which a load removes it where a position correction follows,
/// in the slop of the pair. Usual 0.25. A body that a load moves apart keeps that velocity. More: a
/// row that a heavy body has pressed against a wall throws it back. Less: a box on a much lighter
/// one trembles.
constexpr double kCorrectedBias = 0.25;

/// The load of a pair at which it removes no overlap besides the correction, in weights of its
/// island. Usual 2: only bodies that cannot part are pressed together so much. Without a bound,
/// bodies that are too thick for the walls around them burst apart. Below 1: a body that carries
/// all of its island removes no overlap.
constexpr double kPartedWeight = 2;

/// The sweeps of a solve of few contacts, of an impact, a load or a position correction, times the
/// number of contacts; at most `iterations`. Usual 60000. Fewer: towers that start with gaps fall,
/// heavy bodies sink into light ones or throw them away. More: a step only costs more.
constexpr std::size_t kSolveWork = 60000;

/// The most sweeps of a solve of many contacts, at the default of `iterations`: of a load, or of an
/// impact from which bodies bounce. Usual 10. Fewer: walls lean. More: heaps and walls that are hit
/// cost more, as no number of sweeps finishes slides.
constexpr int kManySweeps = 10;

/// The same while sweeps go along conjugate directions, of a load that nothing has hit in the
/// sub-step, or of an impact from which bodies bounce. Usual 30. Fewer: high walls that start with
/// gaps sway and fall; a heavy plate that falls on a bed of balls is not stopped and returns too
/// slowly. More: large scenes only cost more while they come to rest.
constexpr int kFurtherSweeps = 30;

/// The same of a position correction, or of an impact from which nothing bounces. Usual 2; the load
/// that follows takes what is left. More: a step costs more while anything overlaps.
constexpr int kFewSweeps = 2;

/// The residual at which a position correction ends, as a multiple of `tolerance`. Usual 10: it
/// moves bodies for one sub-step, and the next one sees what it has left. Less: heaps cost more
/// while they settle. More: they cost a little less.
constexpr double kCorrectionTolerance = 10;

/// The greatest speed at which overlapping bodies are moved apart, in least half-sizes per second;
/// the speed that gravity adds in a sub-step is added to it. Usual 4. More: bodies that start deep
/// inside each other explode. Less: a heavy load sinks in.
constexpr double kFastestCorrection = 4;

/// The approach speed above which bodies hit each other, as a multiple of the speed that gravity
/// adds in a sub-step. Usual 4: slower bounces would last fewer than 8 sub-steps. Less: resting
/// bodies rattle. More: bouncing ends too soon. Without gravity every approach bounces; at
/// restitution 0 it is an impact from kStill on.
constexpr double kRestitutionKicks = 4;

/// The residual at which an impact of a small island is solved, as a part of its fastest approach.
/// Usual 1e-8. More: a box that is hit flat leaves turning.
constexpr double kImpactResidual = 1e-8;

/// The number of contacts from which an island solves an impact only among the contacts near it.
/// Usual 1024.
constexpr std::uint32_t kPatchedFrom = 1024;
/// The width of such a patch: how often the bodies that touch it are added to it, from the bodies
/// that are hit on. Usual 2. 3: it has about three times as many contacts. 1: more impacts reach
/// out of it, and the whole island is solved again.
constexpr int kPatchWidth = 2;
/// The cost of a contact in a patch, in contacts of the whole island: if all patches cost more than
/// the island has, the whole island is solved. Usual 64. Less: walls that are hit cost more time,
/// and large piles more memory.
constexpr std::size_t kPatchCost = 64;

/// The residual at which an impact of a large island is solved, as a part of its fastest approach.
/// Usual 1e-3. Less: large heaps cost more while they settle, as something hits something in every
/// step.
constexpr double kLargeImpactResidual = 1e-3;

/// The fewest sweeps over a load. Usual 8. Bodies start to lean so slowly that a sweep changes
/// little and the residual does not show it. Fewer: they lean until the residual exceeds the
/// tolerance, and then sway for hundreds of steps or for ever. More: a step only costs more.
constexpr int kLeastSweeps = 8;

/// The residual that float's rounding leaves of a load, as a part of the speed that the largest of
/// its impulses give a body, see speed_of_loads(). Usual 3e-7, five roundings. Less: loads of high
/// pyramids are swept in vain. More: high towers sway.
constexpr double kRoundingOfLoads = 3e-7;

/// The growth of the residual (or of the tolerance, if that is larger) at which sweeps lead away
/// and end, as a factor. Usual 100. More: bodies that friction jams between walls may leave at 100
/// m/s, as each pair of sweeps makes their impulses half as large again. Less: conjugate directions
/// that would converge end early.
constexpr double kLedAway = 100;

/// The part of the tolerance below which a load may end before kLeastSweeps. Usual 0.03: what is at
/// rest takes two or three sweeps. More: slow swaying ends there too. Less: bodies at rest cost as
/// much as swaying ones.
constexpr double kHardlyAnything = 0.03;

/// The kinetic energy that a warm start may give an island, as a multiple of what gravity gives its
/// bodies in a sub-step. Of a warm start with more, the part stays that takes the most energy.
/// Usual 1000. More: impulses that ended an impact are replayed and throw bodies back. Less: bodies
/// that land lose loads that they need, and towers that start with gaps fall.
constexpr double kWarmStartWeight = 1000;

/// The slope of the energy after a step along a conjugate direction, as a multiple of the slope
/// before it, up to which the next direction carries the last one on. Usual 4. More: steps explode
/// where contacts have opened or slipped, as the directions are no longer conjugate. Less: useful
/// directions are given up.
constexpr double kMostCarried = 4;

/// The longest step along a conjugate direction, in the sweeps' own step. Usual 64. More: where
/// contacts open, such a step leads far away. Less: slow errors take more sweeps.
constexpr double kLongestStep = 64;

/// The friction coefficient of a pair up to which directions are conjugate. Usual 2. More: friction
/// may do more to an approach than its normal impulse, sweeps do not converge, and longer steps
/// drive bodies away. Less: towers of rough bodies that are hit throw heavy bodies back.
constexpr double kMostConjugateFriction = 2;

/// The speed up to which bodies stand still, see hold_still(), as a part of the speed that gravity
/// adds in a sub-step. Usual 2.5e-4. More: towers of small cubes sway. Less: rounding has the load
/// of still bodies solved anew all the time.
constexpr double kStandsStill = 2.5e-4;

/// The stiffness of a static load, as a multiple of the mass that it moves in a sub-step. Usual
/// 1e8; from 1e7 to 1e10 piles rest alike. Less: high towers still bend. More: rounding shakes them
/// (from 1e12 on).
constexpr double kStaticStiffness = 1e8;

/// The most solutions of a static load, each without the points that pulled in the last one. Usual
/// 12; 20 are no better. Fewer: towers that have landed lean.
constexpr int kStaticRounds = 12;

/// The most products of blocks that a static load may take, for each body. Usual 4; a tower takes
/// 2. More: walls and heaps, which have loops, are solved too, for up to four times the time of a
/// step and seldom with the right contacts.
constexpr std::size_t kStaticWork = 4;

/// The part of the largest entry of a coloured island's responses below which a coupling is set to
/// 0. Usual 2^-40: rounding leaves such entries of boxes that are parallel to the axes. Less: their
/// products leave float's normal range, where operations take a hundred times as long. More:
/// couplings are lost that float can represent.
constexpr double kSpeck = 0x1p-40;

/// The number of contacts from which an island that something holds is coloured, which means:
/// solved in float, eight rows at a time and along conjugate directions. Usual 20. Fewer: lanes are
/// empty, and towers of two boxes take twice the time. More: small stacks tremble and take several
/// times the time, and heaps cost more.
constexpr std::uint32_t kColouredFrom = 20;

/// The ratio of the masses in an island from which it is coloured though it has few contacts, if
/// something holds it and it has conjugate directions. Usual 2.5. More: heavy bodies squeeze out
/// light ones below them, as sweeps one by one hardly converge there. Less: lanes are empty.
constexpr double kUnequalMasses = 2.5;

/// The number of contacts from which an island that touches nothing fixed is coloured. Usual 1024.
/// Such an island keeps its momentum to 1e-15 of it per step in double, and to 1e-7 in float.
/// Fewer: more islands lose momentum to float. More: large free heaps cost more.
constexpr std::uint32_t kFreeColouredFrom = 1024;

/// The speed of a body's fastest point up to which it is still, in least half-sizes per second.
/// Usual 0.05, ten times the slop. More: slow motion freezes. Less: the last trembling of a pile
/// keeps it awake.
constexpr double kStill = 10 * kSlop;
/// The part of kStill that a still body may gain in speed per second. Usual 0.03. More: bodies that
/// begin to tip or to roll freeze. Less: rounding keeps bodies awake.
constexpr double kStarts = 0.03;

/// The least inertia of a body, as a part of mass times bounding radius squared. Usual 1e-7: a body
/// thinner than some 3e-4 of its length turns about its length as if it were that thick. Less: the
/// rounding of its contact points throws it about. More: visible rods turn too slowly.
constexpr double kLeastInertia = 1e-7;

/// The time for which all bodies of an island have to be still before it falls asleep [s]. Usual
/// 0.5. Less: a body that is thrown upward may fall asleep at its highest point.
constexpr double kTimeToSleep = 0.5;

}  // namespace tesserae
