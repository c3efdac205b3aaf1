#pragma once

#include <cstddef>
#include <cstdint>

// What was chosen, not derived, of how contacts are solved: each with its unit, its usual value and
// what breaks when it changes. A change moves golden hashes: see motion_version.hpp.
namespace tesserae {

/// Overlap that the solver leaves alone, as a part of the least half-size, usual 0.005: a resting
/// contact then keeps touching. More shows as bodies that sink into each other; 0 lets resting
/// contacts come and go.
constexpr double kSlop = 0.005;

/// Faces whose heights differ by less than this part of the least half-size of what lies on them
/// are flush, usual 1e-4. More, and small steps are smoothed away; less, and tiles that stand on a
/// floor of their own are not one floor.
constexpr double kFlush = 1e-4;

/// Contacts all of whose points lie this near to a rim of the other body's face, as a part of the
/// same, are looked at for an internal edge, usual 0.1. Less than what a heavy load sinks in, and
/// its body is stopped there; more, and the look costs more.
constexpr double kSkin = 0.1;

/// Overlap that is left to the solver, as a part of twice the least half-size of two bodies, usual
/// 0.25: bodies that would come deeper in half a sub-step are stopped where they touch. More, and
/// the solver may push them out on the wrong side; less, and more bodies lose a part of a sub-step.
constexpr double kDeepest = 0.25;

/// Bodies that are stopped touch when they are this part of the same apart, usual 0.005. Less costs
/// more to find; more, and they stop visibly before what they hit.
constexpr double kTouch = 0.005;

/// How far bodies may move against each other until the manifold of their flat faces is found anew,
/// as a part of the least half-size, usual 0.001: until then it moves with both. More, and what
/// slides slowly stands on where it was; less, and what hardly moves costs as much as what does.
constexpr double kKeptMotion = 0.001;

/// Gap that rests, in the slop of the pair, usual 0.02: what is less than
/// this apart is kept there and need not close. 0, and points that bear a load open and close
/// whenever a wall trembles, and keep it trembling (20 to 40 sweeps a step instead of 8); more, and
/// bodies stop visibly above what they come to rest on.
constexpr double kRestingGap = 0.02;

/// Margin of manifolds that are kept, in the slop of the pair, usual 2. More, and points that do
/// not touch take the places of those that do; less, and only slower bodies keep theirs.
constexpr double kKeptMargin = 2;

/// Part of an overlap that a sub-step removes (f in the bias -(f/h) min(0, s +
/// a)), and by which a position correction moves bodies, see is_corrected(); usual 0.2 without one.
/// Towards 1 stacks jump and bodies that start inside each other are thrown apart, towards 0 a wall
/// of 20 rows topples at 10 sweeps. Without a correction it trembles, by 8 to 17 mm/s at 20 sweeps
/// instead of 2.
constexpr double kBiasPart = 0.05;

/// Overlap up to which it does where a position correction follows, beyond what is left alone, in
/// the slop of the pair, usual 0.25: what moves apart by it goes on to. More, and a row that a
/// heavy body has pressed together before a wall throws it back (one of 20 masses by 6 % of its
/// speed at 1, by 36 % without a bound); less, and a box on one of a hundredth of its mass trembles
/// (at 0.1 by 20 mm/s).
constexpr double kCorrectedBias = 0.25;

/// Load of a pair at which it does no more, in the weight of its island, usual 2: only what cannot
/// part is pressed together by so much. At 1.2 to 4 logs that are too thick for the walls between
/// which they start stay there, without a bound they burst apart at 7 m/s; below 1 what carries all
/// of its island would do nothing.
constexpr double kPartedWeight = 2;

/// Sweeps of a position correction, at most: with 2, 4 and 8 a wall of 20 rows rests alike. More
/// cost more while anything overlaps.
constexpr int kCorrectionSweeps = 2;

/// The same of islands of few contacts: the first over these, usual 20000, and no more than the
/// second, usual 32. Fewer, and what lies under a heavy body is pushed out of one overlap into the
/// other, deeper and deeper (with 8 a plank under 10 masses sinks into the rim that it lies on by a
/// quarter of its size, with 16 not), and what is in a narrow wedge goes deeper into it; more only
/// cost more.
constexpr std::size_t kCorrectionWork = 20000, kMostCorrectionSweeps = 32;

/// A position correction turns no body that would give back more than so many times the energy that
/// it was given, usual 4, if that is more than this part of what it turns with, usual 1e-4. More,
/// and thin bodies are thrown (without bounds one of 209 heaps wins 8 % of its energy); less of the
/// second, and what spins fast sinks in.
constexpr double kGivenBack = 4, kGivenBackOfTurning = 1e-4;

/// Speed at which overlapping bodies are moved apart, at most, in least half-sizes a second (and
/// what gravity adds in a sub-step): so that those that start deep inside each other do not
/// explode. Less, and a heavy load sinks in.
constexpr double kFastestCorrection = 4;

/// Approach speed above which bodies hit each other, as a multiple of what gravity adds in a
/// sub-step: slower bounces would last fewer than 8 sub-steps. Lower, resting bodies rattle;
/// higher, bouncing ends too soon. Without gravity every approach bounces, and at restitution 0 one
/// is an impact from kStill on.
constexpr double kRestitutionKicks = 4;

/// An impact of a small island is solved until no normal velocity changes by more than this part of
/// its fastest approach in a sweep. More, and a box that is hit flat leaves turning.
constexpr double kImpactResidual = 1e-4;

/// Sweeps of it at most: this over the island's contacts, but not fewer than `iterations`. Fewer,
/// and a body that hits much lighter ones is thrown back (a ball of 100 masses that hits one before
/// a wall needs 1000 sweeps); more, and boxes that settle cost several times as much.
constexpr std::size_t kImpactWork = 10000;

/// Islands of so many contacts solve an impact among the contacts near it: of bodies that touch
/// what is hit, those that touch these, and so on, this often. One more, and there are three times
/// as many; one less, and in a pile of spheres a fourth of them, not 2 %, reach out of there, and
/// all is solved again.
constexpr std::uint32_t kPatchedFrom = 1024;
constexpr int kPatchWidth = 2;
/// What such a contact costs, in contacts of a whole island: where all of them cost more than it
/// has, it is solved as a whole. Less, and a wall that is hit costs 3 % more, and 10^5 spheres of a
/// pile take a tenth more memory.
constexpr std::size_t kPatchCost = 64;

/// The part for a large island, whose sweeps are `iterations` at most. Less, and large heaps cost
/// more while they settle, as something hits something in every step.
constexpr double kLargeImpactResidual = 1e-3;

/// Sweeps of the compression of a large island from which bodies bounce, at most, while they go
/// along conjugate directions: with 10 a plate of 300 masses that falls on 8 of a bed of 648 is
/// not stopped, with these it returns at e times its speed.
constexpr int kBounceSweeps = 40;

/// Sweeps over a load whose island has few contacts, at most: the first over these contacts, usual
/// 60000, and no more than the second, usual 80; `iterations` where that is more. Fewer, and towers
/// that start with gaps fall (with 50 one of twelve of 8 to 40 cubes of 1 cm to 1 m does), a wall
/// of 20 rows whose ends are ragged leans by 40 mm; more, and heaps cost more while they settle (at
/// 200 one of 400 boxes by 30 %).
constexpr std::size_t kLoadWork = 60000, kMostLoadSweeps = 80;

/// How many times `iterations` sweeps a load takes at most that nothing has hit in the sub-step,
/// while they go along conjugate directions, usual 3. Less, and walls of 20 rows and more of 10 cm
/// that start with gaps of 0.1 mm sway and fall in some seconds (at 2 one sways by 0.5 mm/s, at 3
/// by less than 0.1), and pyramids of 30 rows that start with overlap tremble; more only cost more
/// while something large comes to rest.
constexpr int kFurther = 3;

/// Sweeps over a load, at least, usual 8: what rests starts to lean, so slowly that a sweep changes
/// little of it and the residual does not see it. Fewer, and it does until the residual is above
/// the tolerance, and then takes hundreds of steps of many sweeps to come to rest again (at 2 and 4
/// a wall of 20 rows takes 20 sweeps a step on average), or sways for ever (three 120-cells on one
/// another by 3 mm/s at 10, 14 and 40 iterations); more only cost more.
constexpr int kLeastSweeps = 8;

/// How many times as much as it was (or the tolerance) the residual is once sweeps lead away, usual
/// 100: bodies that friction jams between walls may else leave at 100 m/s and more in one step, as
/// each pair of sweeps makes their impulses half as large again. Less, and directions that pass
/// over a hill end there.
constexpr double kLedAway = 100;

/// Part of the tolerance below which a load that goes along no conjugate directions ends before
/// that, usual 0.1: one body on the ground is solved by a sweep or two. More, and slow swaying
/// ends so too; less, and all that rests costs as much as what sways.
constexpr double kHardlyAnything = 0.1;

/// How many times the energy of what gravity does to an island's bodies in a sub-step the impulses
/// may give them that their load starts from, usual 1000, before the part of these is looked for
/// that takes the most energy. Less, and what lands loses loads that it needs (at 2 a tower of 40
/// boxes that start with gaps falls); more, and what ended an impact is replayed (a row of boxes
/// that one of 20 masses has pressed together before a wall throws it back by 30 % of its speed).
constexpr double kWarmStartWeight = 1000;

/// How many times what gravity gives an island in a sub-step what holds it gives it,
/// by the warm start, when something that has hit it is being stopped, usual 4: where these
/// impulses then leave more energy than there would be without them, what goes back already is
/// thrown, and the same part of them is looked for. Less, and logs that are jammed between walls
/// lose the loads that keep them there (at 2 eight of 64 leave by more than 0.2 m/s that else
/// stay); more, and what hits light bodies comes back (at 8 one of 1000 masses that falls on a
/// tower of five boxes by 64 % of its speed instead of 2).
constexpr double kWarmStartStop = 4;

/// How many times as steep a step along a direction may leave the energy, usual 4: the part of the
/// last direction that the next one goes on with. More, and what it is conjugate to is no longer
/// there, as contacts have opened or slipped: steps explode; less, and directions are given up that
/// lead there.
constexpr double kMostCarried = 4;

/// How long a step along a direction is at most, in the sweeps' own step, usual 64. More, and where
/// contacts open such a step leads far away; less, and slow errors take longer (at 8 a wall that
/// has come to rest takes 40 % more sweeps).
constexpr double kLongestStep = 64;

/// Friction coefficient of a pair up to which directions are conjugate, usual 2. More, and friction
/// may do so much more to an approach than the normal impulse that it goes with that sweeps do not
/// come nearer to any solution, and steps beyond them drive them away (by 100 m/s for a box of
/// friction 100 on a plane); less, and what has more of it is solved as badly as without them (at
/// 1, with friction above, 20 of 70 bodies of 20 to 3000 masses that fall on towers of up to nine
/// come back by more than 5 % of their speed instead of 8).
constexpr double kMostConjugateFriction = 2;

/// How fast bodies are that stand still (see hold_still()), as a part of what gravity gives them in
/// a sub-step, usual 2.5e-4. More, and towers of small cubes sway (at 0.01 six of 60 that start
/// with gaps by more than 0.2 % of a cube a second); less, and the rounding of what stands still
/// has its load solved anew all the time.
constexpr double kStandsStill = 2.5e-4;

/// What holds them, as a multiple of the mass that it moves in a sub-step, usual 1e8: piles of
/// small boards and cubes rest alike from 1e7 to 1e10. Less, and high towers still bend; more, and
/// rounding shakes them (at 1e12).
constexpr double kStaticStiffness = 1e8;

/// How often it is solved, without the points that then pull, at most, usual 12. Fewer, and what
/// has landed leans (at 2 six of 60 towers by more than 5 % of a cube); 20 are no better.
constexpr int kStaticRounds = 12;

/// Products of blocks that it takes, at most, for each body, usual 4; a tower takes 2. More, and
/// walls, heaps and all that has loops are solved too, where what lets go is seldom right (9 of
/// 1800 times in a wall of three boxes a row), for up to four times the time of a step.
constexpr std::size_t kStaticWork = 4;

/// Part of the entries that a body or pair responds by in coloured islands, below which couplings
/// are none, usual 2^-40: they are what rounding leaves of boxes that lie straight. Less, and
/// products with them get below float's normal range, where they take a hundred times as long
/// (towers of ten boxes at rest twice the time of a step); more, and couplings are lost that float
/// sees.
constexpr double kSpeck = 0x1p-40;

/// Contacts from which on an island that is held (some body touches one that contacts do not move)
/// is coloured and solved in float, eight at a time and along conjugate directions, usual 20; fewer
/// are solved in double, one by one. More, and small stacks tremble (at 64 towers of seven boxes by
/// 6 to 40 mm/s, for 3 times the time; at 1024 stacks of ten boards by 10 mm/s, for 7 times the
/// time) and heaps cost more (at 32 by 20 %); fewer, and lanes are empty (at 16 towers of two boxes
/// take twice the time).
constexpr std::uint32_t kColouredFrom = 20;

/// Factor by which masses of an island's bodies differ that is coloured though it has few contacts,
/// if it is held and goes along conjugate directions, usual 2.5: one by one sweeps hardly get
/// anywhere where heavy bodies rest on light ones (a box of 1000 masses, set down on one from 1 mm,
/// then squeezes it out; 14 planks slow a ball of three masses that rolls over them by 5 %). More,
/// and more of these are solved worse; less, and lanes are empty.
constexpr double kUnequalMasses = 2.5;

/// The same where nothing is held: such an island keeps its momentum, in double to 1e-15 of it a
/// step, in float to 1e-7.
constexpr std::uint32_t kFreeColouredFrom = 1024;

/// Slenderness, see FloatRange, from which on coloured islands do not round what impulses do to
/// one part in 500, usual 64, that of a rod of 1 by 0.09. More, and rods that lie across each other
/// fly apart (of 1 by 0.005, with 30 times the energy that they had); less, and boards take a tenth
/// more memory.
constexpr double kSlender = 64;

/// A body is still while no point of it moves faster than this part of its least half-size a second
/// (ten times the overlap that the solver leaves alone). More, and slow motion freezes; less, and
/// the last trembling of a pile keeps it awake.
constexpr double kStill = 10 * kSlop;
/// Nor is it in a step in which it gains more than this part of that speed a second. More, and what
/// begins to tip or to roll freezes; less, and rounding keeps bodies awake.
constexpr double kStarts = 0.03;

/// A body's least inertia, as a part of mass times bounding radius squared, usual 1e-7: one thinner
/// than some 3e-4 of its length turns about its length as if it were that thick. Less, and the
/// rounding of where it is touched throws it about; more, and visible rods turn too slowly.
constexpr double kLeastInertia = 1e-7;

/// How long [s] all bodies of an island have to be still before it falls asleep: longer than a body
/// thrown upward is at its highest point.
constexpr double kTimeToSleep = 0.5;

}  // namespace tesserae
