#include "core/dynamics/solver/coloured_normals.hpp"

namespace tesserae {
namespace {

using namespace lanes;

/// Whether any point of a batch slides: where some did in the last sweep most will again, and
/// asking each of them costs more, by mispredicted branches, than to work out how they do.
template <class F>
struct Sliding {
    bool expected;
    F excess{};  ///< of a point's squared impulse over what is allowed, the largest

    bool any() const { return !simd::nowhere_above(excess, F{}); }
};

/// friction_impulse() of the one-by-one solver, in the frame; solve_part() of its rolling rows.
template <class F, class Mass>
[[gnu::always_inline]] inline LaneVec4<F> friction_impulse(
    const Lane<F>& lane, const std::array<Mass, 6>& masses, const Mass& slide_mass,
    const LaneVec4<F>& old, const LaneVec4<F>& slip, F most, Sliding<F>& slides) {
    const LaneVec4<F> sticking = old - times(load_all(lane, masses), slip);
    // Where nothing is allowed there is nothing to find.
    const F squared = dot(sticking, sticking), allowed = most * most;
    const auto holds = most > F{};
    const auto only = [&](auto where, const LaneVec4<F>& v, const LaneVec4<F>& w) {
        return LaneVec4<F>{where ? v[0] : w[0], where ? v[1] : w[1], where ? v[2] : w[2], F{}};
    };
    const F to_hold = holds ? squared : F{};
    if (!slides.expected && simd::nowhere_above(to_hold, allowed)) return only(holds, sticking, {});
    slides.excess = larger(slides.excess, to_hold - allowed);
    const LaneVec4<F> sliding = clamped<F>(sum(old, -lane.load(slide_mass), slip), most);
    return only(holds, only(squared <= allowed, sticking, sliding), {});
}

/// What is worked on while a batch's points are solved.
template <class F>
struct PairSweep {
    ColouredIslands& coloured;
    Batch& batch;
    Sweep sweep;

    /// Row of a point, in the sweep's order.
    [[gnu::always_inline]] std::uint32_t row(std::uint32_t i) const {
        return batch.row + (sweep.backward ? batch.rows - 1 - i : i);
    }
};

/// A pair's motion while its points are solved, and what has been changed, seen from the centre.
/// Impulses along the normal change the motion along it at once, and that across it by see_along();
/// the same the other way round.
template <class F>
struct PairMotion {
    FrameScrew<F> motion, impulse{};

    /// @param change   of the impulses, since it was last seen
    [[gnu::always_inline]] void see_along(const Lane<F>& lane, ColouredIslands& coloured,
                                          std::uint32_t index, const std::array<F, 4>& change) {
        with_response(coloured, index, [&](const auto& response) {
            for (std::size_t i = 0; i < 4; ++i)
                add_scaled(lane, response.along[i], change[i], motion.across);
        });
    }
    [[gnu::always_inline]] void see_across(const Lane<F>& lane, ColouredIslands& coloured,
                                           std::uint32_t index) {
        with_response(coloured, index, [&](const auto& response) {
            for (std::size_t j = 0; j < 6; ++j)
                for (std::size_t i = 0; i < 4; ++i)
                    motion.along[i] =
                        fused(lane.load(response.along[i][j]), impulse.across[j], motion.along[i]);
        });
    }
};

/// All points' normal impulses, in the order of the sweep and then the other way round: its own
/// adjoint. What comes last has its way, and so a pair that is gone through one way only leans.
/// Not inlined: the points' velocities then have the registers to themselves.
/// @return the largest velocity that was left to solve, if it is measured
template <std::size_t kPoints, class F>
[[gnu::noinline]] F solve_normals_of(const PairSweep<F>& pair, const Lane<F>& lane,
                                     PairMotion<F>& of) {
    const auto& [pass, backward, measured, adjoint] = pair.sweep;
    PairNormals<kPoints, F> normals(lane, pair.coloured, pair.batch, pass, of.motion.along);
    F left;
    if (backward) {
        left = normals.template solve<true, true>(measured);
        normals.template solve<false, false>(false);
    } else {
        left = normals.template solve<false, true>(measured);
        normals.template solve<true, false>(false);
    }
    normals.add_impulse(of.impulse.along);
    return left;
}
template <class F>
[[gnu::always_inline]] inline void solve_normals(const Lane<F>& lane, const PairSweep<F>& pair,
                                                 PairMotion<F>& of, F& left) {
    const auto solve = [&] {
        switch (padded_points(pair.batch.rows)) {
            case 1:
                return solve_normals_of<1>(pair, lane, of);
            case 2:
                return solve_normals_of<2>(pair, lane, of);
            case 4:
                return solve_normals_of<4>(pair, lane, of);
            default:
                return solve_normals_of<8>(pair, lane, of);
        }
    };
    left = larger(left, solve());
}

/// A point's friction.
template <class F>
struct FrictionPoint {
    std::array<Eight, 3>& impulse;
    const GeneralFriction& row;
    Place<F> at;
    F most;

    [[gnu::always_inline]] FrictionPoint(const Lane<F>& lane, const PairSweep<F>& pair, F mu,
                                         std::uint32_t k)
        : impulse(pair.coloured.impulses.tangent[k]),
          row(pair.coloured.general_friction[k]),
          at(place_of(lane, pair.coloured.rows[k])),
          // Along a direction a normal impulse may have got below 0.
          most(mu * larger(lane.load(pair.coloured.impulses.normal[k]), F{})) {}

    /// @param share   of the slip that it ends
    /// @return the change of its impulse
    [[gnu::always_inline]] LaneVec4<F> solve(const Lane<F>& lane, const std::array<F, 6>& motion,
                                             F share, Sliding<F>& slides) const {
        const LaneVec4<F> old = load(lane, impulse);
        const LaneVec4<F> slip = share * across_at(at, motion);
        const LaneVec4<F> all =
            friction_impulse(lane, row.mass, row.slide_mass, old, slip, most, slides);
        store(lane, all, impulse);
        return all - old;
    }
    /// The square of the velocity that was left to solve.
    [[gnu::always_inline]] F squared_left(const Lane<F>& lane, const LaneVec4<F>& change,
                                          F share) const {
        return squared_velocity_left(share * lane.load(row.slide_mass), change);
    }
};

/// The same of friction, across the normal: two points at a time, the first and the last and so on
/// inward, each of which ends half of its slip if both bear a load. So they do no more than one
/// after the other, as what they do to each other is at most the mean of what they do to
/// themselves; they need not wait for each other, and the pair's motion is worked out half as
/// often.
template <class F>
[[gnu::always_inline]] inline void solve_friction(const Lane<F>& lane, const PairSweep<F>& pair,
                                                  std::uint32_t index, PairMotion<F>& of, F& left) {
    const F mu = lane.load(pair.coloured.pair_friction[index].friction), one = F{} + 1.0f;
    const std::array<F, 21> response = across_response(lane, pair.coloured, index);
    const std::uint32_t rows = pair.batch.rows, twos = rows / 2, steps = rows - twos;
    F squared_left{};
    Sliding<F> slides{pair.batch.slides};
    for (std::uint32_t i = 0; i < steps; ++i) {
        const std::uint32_t k = pair.sweep.backward ? steps - 1 - i : i;
        const FrictionPoint<F> first(lane, pair, mu, pair.batch.row + k);
        std::array<F, 6> seen;
        if (k < twos) {
            const FrictionPoint<F> last(lane, pair, mu, pair.batch.row + rows - 1 - k);
            const F least = first.most < last.most ? first.most : last.most;
            const F share = least > F{} ? F{} + 0.5f : one;
            const LaneVec4<F> change = first.solve(lane, of.motion.across, share, slides);
            const LaneVec4<F> other = last.solve(lane, of.motion.across, share, slides);
            seen = seen_from_centre(first.at, change);
            add(seen_from_centre(last.at, other), seen);
            if (pair.sweep.measured)
                squared_left = larger(squared_left, larger(first.squared_left(lane, change, share),
                                                           last.squared_left(lane, other, share)));
        } else {
            const LaneVec4<F> change = first.solve(lane, of.motion.across, one, slides);
            seen = seen_from_centre(first.at, change);
            if (pair.sweep.measured)
                squared_left = larger(squared_left, first.squared_left(lane, change, one));
        }
        add(seen, of.impulse.across);
        add_product(response, seen, of.motion.across);
    }
    if (pair.sweep.measured) left = larger(left, square_root(squared_left));
    pair.batch.slides = slides.any();
}

/// Rolling or twisting of all points.
/// @param motion, impulse, response   along or across the normal, where three from `first` on turn
/// @param part                        where a row's impulses begin
template <class F, std::size_t kSize, std::size_t kEntries>
[[gnu::always_inline]] inline void solve_turning(const Lane<F>& lane, const PairSweep<F>& pair,
                                                 std::size_t first, F arm,
                                                 const std::array<Eight, 6>& mass,
                                                 const Eight& step_mass,
                                                 const std::array<F, kEntries>& response,
                                                 std::size_t part, std::array<F, kSize>& motion,
                                                 std::array<F, kSize>& impulse) {
    Sliding<F> slides{false};
    for (std::uint32_t i = 0; i < pair.batch.rows; ++i) {
        const std::uint32_t k = pair.row(i);
        GeneralRolling& row = pair.coloured.general_rolling[k];
        LaneVec4<F> old{};
        for (std::size_t j = 0; j < 3; ++j) old[j] = lane.load(row.impulse[part + j]);
        const LaneVec4<F> slip = {motion[first], motion[first + 1], motion[first + 2], F{}};
        const LaneVec4<F> all =
            friction_impulse(lane, mass, step_mass, old, slip,
                             arm * lane.load(pair.coloured.impulses.normal[k]), slides);
        std::array<F, kSize> change{};
        for (std::size_t j = 0; j < 3; ++j) {
            lane.store(all[j], row.impulse[part + j]);
            change[first + j] = all[j] - old[j];
        }
        add(change, impulse);
        add_product(response, change, motion);
    }
}
template <class F>
[[gnu::always_inline]] inline void solve_rolling(const Lane<F>& lane, const PairSweep<F>& pair,
                                                 const PairRolling& rolling, PairMotion<F>& of) {
    solve_turning(lane, pair, 1, lane.load(rolling.arm), rolling.rolling_mass, rolling.rolling_step,
                  load_all(lane, rolling.response), 0, of.motion.along, of.impulse.along);
}
template <class F>
[[gnu::always_inline]] inline void solve_twisting(const Lane<F>& lane, const PairSweep<F>& pair,
                                                  const PairRolling& rolling, std::uint32_t index,
                                                  PairMotion<F>& of) {
    solve_turning(lane, pair, 3, lane.load(rolling.arm), rolling.twisting_mass,
                  rolling.twisting_step, across_response(lane, pair.coloured, index), 3,
                  of.motion.across, of.impulse.across);
}

/// Normal impulses, friction, rolling, twisting, each after what those before it have done.
template <bool kFriction, bool kRolling, class F>
[[gnu::always_inline]] inline void solve_parts(const Lane<F>& lane, const PairSweep<F>& pair,
                                               std::uint32_t index, PairMotion<F>& of, F& left) {
    solve_normals(lane, pair, of, left);
    if constexpr (kFriction) {
        of.see_along(lane, pair.coloured, index, of.impulse.along);
        solve_friction(lane, pair, index, of, left);
        if constexpr (kRolling) {
            const PairRolling& rolling = pair.coloured.pair_rolling[index];
            add_product(load_all(lane, rolling.response), of.impulse.along, of.motion.along);
            of.see_across(lane, pair.coloured, index);
            const std::array<F, 4> seen = of.impulse.along;
            solve_rolling(lane, pair, rolling, of);
            of.see_along(lane, pair.coloured, index, difference(of.impulse.along, seen));
            solve_twisting(lane, pair, rolling, index, of);
        }
    }
}
/// The same from the last to the first, without rolling, with which there are no adjoints.
template <bool kFriction, class F>
[[gnu::always_inline]] inline void solve_parts_adjoint(const Lane<F>& lane,
                                                       const PairSweep<F>& pair,
                                                       std::uint32_t index, PairMotion<F>& of,
                                                       F& left) {
    if constexpr (kFriction) {
        solve_friction(lane, pair, index, of, left);
        of.see_across(lane, pair.coloured, index);
    }
    solve_normals(lane, pair, of, left);
}

template <bool kFriction, bool kRolling, bool kUneven, class F>
[[gnu::always_inline]] inline F solve_points(const ColouredStage& stage, const Lane<F>& lane,
                                             std::uint32_t index, Sweep sweep) {
    ColouredIslands& coloured = stage.step.coloured;
    Batch& batch = coloured.general[index];
    const PairFrame& pair_frame = coloured.frames[index];
    LanePair<F, kUneven> bodies(lane, coloured, index);
    const Frame<F> frame(load(lane, pair_frame.h));
    const PairSweep<F> pair = {coloured, batch, sweep};
    PairMotion<F> of = {frame.from_world(bodies.motion())};
    add(load_all(lane, pair_frame.motion), of.motion.along);
    if constexpr (kFriction)
        add(load_all(lane, coloured.pair_friction[index].motion), of.motion.across);
    F left{};
    if (sweep.adjoint)
        solve_parts_adjoint<kFriction>(lane, pair, index, of, left);
    else
        solve_parts<kFriction, kRolling>(lane, pair, index, of, left);
    bodies.apply(frame.to_world(of.impulse));
    return left;
}

template <bool kFriction, bool kRolling, bool kUneven>
double sweep_all(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes) {
    float most = 0;
    for_lanes(batches, lanes, sweep.backward, [&](const auto& lane, std::uint32_t batch) {
        const auto left = solve_points<kFriction, kRolling, kUneven>(stage, lane, batch, sweep);
        if (sweep.measured) most = std::max(most, largest_lane(left));
    });
    return most;
}

}  // namespace

double sweep_general(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes) {
    const ColouredIslands& coloured = stage.step.coloured;
    const bool pushes = sweep.pass == Pass::kPush;
    if (coloured.rolling && !pushes)
        return coloured.turns_unevenly ? sweep_all<true, true, true>(stage, batches, sweep, lanes)
                                       : sweep_all<true, true, false>(stage, batches, sweep, lanes);
    if (coloured.friction && !pushes)
        return coloured.turns_unevenly
                   ? sweep_all<true, false, true>(stage, batches, sweep, lanes)
                   : sweep_all<true, false, false>(stage, batches, sweep, lanes);
    return coloured.turns_unevenly ? sweep_all<false, false, true>(stage, batches, sweep, lanes)
                                   : sweep_all<false, false, false>(stage, batches, sweep, lanes);
}

void take_recalled_general(const ColouredStage& stage, BatchRange batches) {
    ColouredIslands& coloured = stage.step.coloured;
    const Lane<Float8> lane;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        PairFrame& pair_frame = coloured.frames[i];
        const Frame<Float8> frame(load(lane, pair_frame.h));
        const FrameScrew<Float8> recalled =
            frame.from_world(LanePair<Float8, false>(lane, coloured, i).motion());
        add_to(lane, recalled.along, pair_frame.motion);
        if (coloured.friction) add_to(lane, recalled.across, coloured.pair_friction[i].motion);
    }
}

void leave_whirling_general(const ColouredStage& stage, BatchRange batches) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.general[i];
        for (std::size_t k = 0; k < kLanes && batch.points[k] > 0; ++k) {
            const Contact& c = stage.step.contacts[batch.contact[k]];
            if (!whirls(stage.simulation, stage.step, c.a) &&
                !whirls(stage.simulation, stage.step, c.b))
                continue;
            for (std::uint32_t p = 0; p < batch.points[k]; ++p) {
                coloured.rows[batch.row + p].along.mass.lane[k] = 0;
                if (!coloured.friction) continue;
                GeneralFriction& friction = coloured.general_friction[batch.row + p];
                friction.slide_mass.lane[k] = 0;
                for (RoughEight& mass : friction.mass) mass.lane[k] = 0;
            }
        }
    }
}

namespace {

/// A lane's angular impulse [N m s, world] of a row.
Bivector angular_impulse_in_lane(const GeneralRolling& row, const PairFrame& frame,
                                 std::size_t lane) {
    Vec4 h;
    for (std::size_t axis = 0; axis < 4; ++axis)
        h[static_cast<int>(axis)] = frame.h[axis].lane[lane];
    const auto entry = [&](std::size_t at) { return double{row.impulse[at].lane[lane]}; };
    const double g = h[3] < 0 ? 1 : -1;
    const Bivector turned = {entry(3), entry(4),     g * entry(0),
                             entry(5), g * entry(1), g * entry(2)};
    return turned - wedge(h, velocity_at(turned, h));
}

/// The impulses of a row in the world, lane by lane.
void keep_row(const ColouredStage& stage, std::uint32_t index, std::uint32_t point) {
    const ColouredIslands& coloured = stage.step.coloured;
    const Batch& batch = coloured.general[index];
    const std::uint32_t row = batch.row + point;
    const Eight& normals = coloured.impulses.normal[row];
    std::array<std::array<float, 4>, kLanes> slopes = {};
    if (coloured.friction) {
        const Lane<Float8> all;
        const Frame<Float8> frame(load(all, coloured.frames[index].h));
        LaneVec4<Float8> slope = frame.reflected(load(all, coloured.impulses.tangent[row]));
        const Float8 normal = all.load(normals);
        for (std::size_t i = 0; i < 4; ++i)
            slope[i] = normal > Float8{} ? slope[i] / normal : Float8{};
        std::array<float*, kLanes> to;
        for (std::size_t k = 0; k < kLanes; ++k) to[k] = slopes[k].data();
        store_four(slope.c, to);
    }
    for (std::size_t k = 0; k < kLanes; ++k) {
        if (point >= batch.points[k]) continue;
        const std::uint32_t contact = batch.contact[k] + point;
        stage.step.impulses[contact] = {stage.mass_unit * normals.lane[k], slopes[k]};
        if (coloured.rolling)
            stage.step.angular_impulses[contact] =
                stage.mass_unit *
                angular_impulse_in_lane(coloured.general_rolling[row], coloured.frames[index], k);
    }
}

void keep_hits(const ColouredStage& stage, std::uint32_t index, std::uint32_t point) {
    const Batch& batch = stage.step.coloured.general[index];
    const Eight& normal = stage.step.coloured.impulses.normal[batch.row + point];
    for (std::size_t k = 0; k < kLanes; ++k)
        if (point < batch.points[k]) stage.step.hit[batch.contact[k] + point] = normal.lane[k] > 0;
}

}  // namespace

void keep_general(const ColouredStage& stage, BatchRange batches) {
    for (std::uint32_t i = batches.begin; i < batches.end; ++i)
        for (std::uint32_t point = 0; point < stage.step.coloured.general[i].rows; ++point)
            if (stage.cause == Cause::kBlow)
                keep_hits(stage, i, point);
            else
                keep_row(stage, i, point);
}

}  // namespace tesserae
