#include "core/dynamics/solver/coloured_points.hpp"

namespace tesserae {
namespace {

using namespace lanes;

/// What an angular impulse does to each lane's body.
template <class F, bool kUneven>
struct Inverse {
    F scalar;
    [[gnu::always_inline]] LaneBivector<F> of(const LaneBivector<F>& moment) const {
        return scalar * moment;
    }
};
template <class F>
struct Inverse<F, true> {
    std::array<F, 24> e;  ///< as BodyInertia
    [[gnu::always_inline]] LaneBivector<F> of(const LaneBivector<F>& m) const {
        return {
            (e[0] * m[0] + e[1] * m[1]) + (e[2] * m[2] + e[3] * m[3]) + (e[4] * m[4] + e[5] * m[5]),
            (e[1] * m[0] + e[6] * m[1]) + (e[7] * m[2] + e[8] * m[3]) +
                (e[9] * m[4] + e[10] * m[5]),
            (e[2] * m[0] + e[7] * m[1]) + (e[11] * m[2] + e[12] * m[3]) +
                (e[13] * m[4] + e[14] * m[5]),
            (e[3] * m[0] + e[8] * m[1]) + (e[12] * m[2] + e[15] * m[3]) +
                (e[16] * m[4] + e[17] * m[5]),
            (e[4] * m[0] + e[9] * m[1]) + (e[13] * m[2] + e[16] * m[3]) +
                (e[18] * m[4] + e[19] * m[5]),
            (e[5] * m[0] + e[10] * m[1]) + (e[14] * m[2] + e[17] * m[3]) +
                (e[19] * m[4] + e[20] * m[5])};
    }
};

template <bool kUneven, class F>
[[gnu::always_inline]] inline Inverse<F, kUneven> inverse_of(
    const Lane<F>& lane, const ColouredIslands& coloured,
    const std::array<std::uint32_t, kLanes>& places, const Motion<F>& motion) {
    Inverse<F, kUneven> inverse;
    if constexpr (kUneven) {
        for (std::size_t part = 0; part < 6; ++part) {
            std::array<const float*, Lane<F>::count> from;
            for (std::size_t i = 0; i < from.size(); ++i)
                from[i] = coloured.inertias[places[lane.first + i]].entry[part].data();
            std::array<F, 4> four;
            load_four(from, four);
            for (std::size_t i = 0; i < 4; ++i) inverse.e[4 * part + i] = four[i];
        }
    } else {
        inverse.scalar = motion.inverse_inertia;
    }
    return inverse;
}

/// PairFrame's reflection.
template <class F>
struct Frame {
    LaneVec4<F> h;
    F g;

    [[gnu::always_inline]] explicit Frame(const LaneVec4<F>& vector) : h(vector) {
        const F one = F{} + 1.0f;
        g = h[3] < F{} ? one : -one;
    }
    [[gnu::always_inline]] LaneVec4<F> reflected(const LaneVec4<F>& v) const {
        return v - dot(h, v) * h;
    }
    /// The impulse of these tangent and normal parts, in world axes.
    [[gnu::always_inline]] LaneVec4<F> world(const LaneVec4<F>& tangent, F normal) const {
        return reflected({tangent[0], tangent[1], tangent[2], g * normal});
    }
};

/// The bodies of each lane's pair, for as long as its points are solved.
template <class F, bool kUneven>
class LanePair {
  public:
    [[gnu::always_inline]] LanePair(const Lane<F>& lane, ColouredIslands& coloured,
                                    const Batch& batch)
        : bodies_a_(lane, coloured.changes.data(), batch.a),
          bodies_b_(lane, coloured.changes.data(), batch.b),
          a_(bodies_a_.template load<true>()),
          b_(bodies_b_.template load<true>()),
          inverse_a_(inverse_of<kUneven>(lane, coloured, batch.a, a_)),
          inverse_b_(inverse_of<kUneven>(lane, coloured, batch.b, b_)) {}

    [[gnu::always_inline]] void store() {
        bodies_a_.template store<true>(a_);
        bodies_b_.template store<true>(b_);
    }
    [[gnu::always_inline]] LaneVec4<F> relative_velocity(const LaneVec4<F>& r_a,
                                                         const LaneVec4<F>& r_b) const {
        return (b_.velocity - a_.velocity) +
               (velocity_at(b_.angular_velocity, r_b) - velocity_at(a_.angular_velocity, r_a));
    }
    [[gnu::always_inline]] void apply(const LaneVec4<F>& r_a, const LaneVec4<F>& r_b,
                                      const LaneVec4<F>& impulse) {
        a_.velocity = a_.velocity - a_.inverse_mass * impulse;
        b_.velocity = b_.velocity + b_.inverse_mass * impulse;
        a_.angular_velocity = a_.angular_velocity - inverse_a_.of(wedge(r_a, impulse));
        b_.angular_velocity = b_.angular_velocity + inverse_b_.of(wedge(r_b, impulse));
    }
    /// Change of the relative velocity by an impulse.
    [[gnu::always_inline]] LaneVec4<F> response(const LaneVec4<F>& r_a, const LaneVec4<F>& r_b,
                                                const LaneVec4<F>& impulse) const {
        return (a_.inverse_mass + b_.inverse_mass) * impulse +
               (velocity_at(inverse_a_.of(wedge(r_a, impulse)), r_a) +
                velocity_at(inverse_b_.of(wedge(r_b, impulse)), r_b));
    }

  private:
    LaneBodies<F> bodies_a_, bodies_b_;
    Motion<F> a_, b_;
    Inverse<F, kUneven> inverse_a_, inverse_b_;
};

template <class F>
[[gnu::always_inline]] inline LaneVec4<F> times(const std::array<F, 6>& symmetric,
                                                const LaneVec4<F>& v) {
    const auto& s = symmetric;
    return {s[0] * v[0] + s[1] * v[1] + s[2] * v[2], s[1] * v[0] + s[3] * v[1] + s[4] * v[2],
            s[2] * v[0] + s[4] * v[1] + s[5] * v[2], F{}};
}

/// Below this part of the cube of the mean response a tangent block is not inverted in float: some
/// direction hardly yields, as that towards a centre whose place is fixed.
constexpr float kLeastDeterminant = 1e-4f;

/// The inverses of the tangent block K (xx xy xz yy yz zz) and of its norm.
template <class F>
[[gnu::always_inline]] inline void invert(const std::array<F, 6>& K, F rounding,
                                          std::array<F, 6>& inverse, F& slide) {
    const F one = F{} + 1.0f;
    const F xx = K[3] * K[5] - K[4] * K[4], xy = K[2] * K[4] - K[1] * K[5];
    const F xz = K[1] * K[4] - K[2] * K[3], yy = K[0] * K[5] - K[2] * K[2];
    const F yz = K[1] * K[2] - K[0] * K[4], zz = K[0] * K[3] - K[1] * K[1];
    const F determinant = K[0] * xx + K[1] * xy + K[2] * xz;
    const F mean = (K[0] + K[3] + K[5]) / (F{} + 3.0f);
    const F norm = square_root((K[0] * K[0] + K[3] * K[3] + K[5] * K[5]) +
                               (F{} + 2.0f) * (K[1] * K[1] + K[2] * K[2] + K[4] * K[4]));
    const auto yields = mean > rounding;
    const auto inverts = determinant > kLeastDeterminant * (mean * mean * mean);
    slide = yields ? one / norm : F{};
    const F scale = one / determinant;
    inverse = {inverts ? scale * xx : slide, inverts ? scale * xy : F{},
               inverts ? scale * xz : F{},   inverts ? scale * yy : slide,
               inverts ? scale * yz : F{},   inverts ? scale * zz : slide};
    for (F& entry : inverse) entry = yields ? entry : F{};
}

template <bool kFriction, bool kUneven, class F>
[[gnu::always_inline]] inline void start_points(
    const ColouredStage& stage, const Lane<F>& lane, const Batch& batch, PairFrame& pair_frame,
    const std::array<EightPoints, kManifoldPoints>& points, const Eight& rounding) {
    ColouredIslands& coloured = stage.step.coloured;
    LanePair<F, kUneven> pair(lane, coloured, batch);
    const F one = F{} + 1.0f, least = lane.load(rounding);
    // h along n - g w, which is never short.
    LaneVec4<F> h = load(lane, points[0].normal);
    h[3] = h[3] > F{} ? h[3] + one : h[3] - one;
    const F scale = square_root((F{} + 2.0f) / dot(h, h));
    const Frame<F> frame(scale * h);
    store(lane, frame.h, pair_frame.h);

    for (std::uint32_t k = 0; k < batch.rows; ++k) {
        GeneralRow& row = coloured.rows[batch.row + k];
        const LaneVec4<F> r_a = load(lane, points[k].r_a), r_b = load(lane, points[k].r_b);
        store(lane, r_a, row.r_a);
        store(lane, r_b, row.r_b);
        const LaneVec4<F> normal_response =
            frame.reflected(pair.response(r_a, r_b, frame.world({}, one)));
        const F normal_impulse =
            start_normal(lane, points[k], frame.g * normal_response[3], least, row.along);
        LaneVec4<F> tangent{};
        if constexpr (kFriction) {
            GeneralFriction& friction = coloured.general_friction[batch.row + k];
            std::array<LaneVec4<F>, 3> K;
            for (std::size_t i = 0; i < 3; ++i) {
                LaneVec4<F> direction{};
                direction[i] = one;
                K[i] = frame.reflected(pair.response(r_a, r_b, frame.reflected(direction)));
            }
            std::array<F, 6> inverse;
            F slide;
            invert<F>({K[0][0], K[0][1], K[0][2], K[1][1], K[1][2], K[2][2]}, least, inverse,
                      slide);
            for (std::size_t i = 0; i < 6; ++i) lane.store(inverse[i], friction.mass[i]);
            lane.store(slide, friction.slide_mass);
            store(lane, normal_response, friction.normal_response);
            store(lane, frame.reflected(load(lane, points[k].velocity)), friction.slip);
            // The normal may have turned since the impulse was.
            tangent = frame.reflected(load(lane, points[k].impulse));
            tangent[3] = F{};
            tangent = clamped<F>(tangent, lane.load(pair_frame.friction) * normal_impulse);
            store(lane, tangent, friction.impulse);
        }
        pair.apply(r_a, r_b, frame.world(tangent, normal_impulse));
    }
    pair.store();
}

/// friction_impulse() of the one-by-one solver, in the frame.
template <class F>
[[gnu::always_inline]] inline LaneVec4<F> friction_impulse(const Lane<F>& lane,
                                                           const GeneralFriction& row,
                                                           const LaneVec4<F>& old,
                                                           const LaneVec4<F>& slip, F most) {
    std::array<F, 6> mass;
    for (std::size_t i = 0; i < 6; ++i) mass[i] = lane.load(row.mass[i]);
    const LaneVec4<F> sticking = old - times(mass, slip);
    const LaneVec4<F> sliding = clamped<F>(old - lane.load(row.slide_mass) * slip, most);
    const auto sticks = dot(sticking, sticking) <= most * most;
    return {sticks ? sticking[0] : sliding[0], sticks ? sticking[1] : sliding[1],
            sticks ? sticking[2] : sliding[2], F{}};
}

template <bool kFriction, bool kUneven, class F>
[[gnu::always_inline]] inline F solve_points(const ColouredStage& stage, const Lane<F>& lane,
                                             std::uint32_t index, Sweep sweep) {
    ColouredIslands& coloured = stage.step.coloured;
    const Batch& batch = coloured.general[index];
    const bool soft = stage.simulation.settings.solver == Solver::kSoft;
    LanePair<F, kUneven> pair(lane, coloured, batch);
    const Frame<F> frame(load(lane, coloured.frames[index].h));
    const F mu = lane.load(coloured.frames[index].friction);
    F left{};
    for (std::uint32_t i = 0; i < batch.rows; ++i) {
        const std::uint32_t k = batch.row + (sweep.backward ? batch.rows - 1 - i : i);
        GeneralRow& row = coloured.rows[k];
        const LaneVec4<F> r_a = load(lane, row.r_a), r_b = load(lane, row.r_b);
        const LaneVec4<F> v = frame.reflected(pair.relative_velocity(r_a, r_b));
        F normal_impulse;
        const F change =
            solve_normal(lane, row.along, frame.g * v[3], soft, sweep.pass, normal_impulse);
        LaneVec4<F> tangent_change{};
        if constexpr (kFriction) {
            GeneralFriction& friction = coloured.general_friction[k];
            LaneVec4<F> slip =
                (v + load(lane, friction.slip)) + change * load(lane, friction.normal_response);
            slip[3] = F{};  // that along the normal
            const LaneVec4<F> old = load(lane, friction.impulse);
            const LaneVec4<F> tangent =
                friction_impulse<F>(lane, friction, old, slip, mu * normal_impulse);
            store(lane, tangent, friction.impulse);
            tangent_change = tangent - old;
        }
        pair.apply(r_a, r_b, frame.world(tangent_change, change));
        if (sweep.measured) left = larger(left, velocity_left(lane, row.along, change));
    }
    pair.store();
    return left;
}

template <bool kFriction, bool kUneven>
void start_all(const ColouredStage& stage, BatchRange batches, LaneCount lanes) {
    const Simulation& simulation = stage.simulation;
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.general[i];
        std::array<EightPoints, kManifoldPoints> points;
        Eight rounding;
        coloured.frames[i].friction = {};
        for (std::size_t k = 0; k < kLanes && batch.points[k] > 0; ++k) {
            for (std::size_t p = 0; p < batch.points[k]; ++p)
                put_point(stage, batch.contact[k] + static_cast<std::uint32_t>(p), k, points[p]);
            const Contact& c = stage.step.contacts[batch.contact[k]];
            coloured.frames[i].friction.lane[k] = float_friction(simulation, c);
            rounding.lane[k] =
                static_cast<float>(least_response(simulation, c.a, c.b) * stage.mass_unit);
        }
        for_lanes({i, i + 1}, lanes, false, [&](const auto& lane, std::uint32_t) {
            start_points<kFriction, kUneven>(stage, lane, batch, coloured.frames[i], points,
                                             rounding);
        });
    }
}

template <bool kFriction, bool kUneven>
double sweep_all(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes) {
    float most = 0;
    for_lanes(batches, lanes, sweep.backward, [&](const auto& lane, std::uint32_t batch) {
        const auto left = solve_points<kFriction, kUneven>(stage, lane, batch, sweep);
        if (sweep.measured) most = std::max(most, largest_lane(left));
    });
    return most;
}

}  // namespace

void start_general(const ColouredStage& stage, BatchRange batches, LaneCount lanes) {
    const ColouredIslands& coloured = stage.step.coloured;
    if (coloured.friction)
        return coloured.turns_unevenly ? start_all<true, true>(stage, batches, lanes)
                                       : start_all<true, false>(stage, batches, lanes);
    return coloured.turns_unevenly ? start_all<false, true>(stage, batches, lanes)
                                   : start_all<false, false>(stage, batches, lanes);
}

double sweep_general(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes) {
    const ColouredIslands& coloured = stage.step.coloured;
    if (coloured.friction)
        return coloured.turns_unevenly ? sweep_all<true, true>(stage, batches, sweep, lanes)
                                       : sweep_all<true, false>(stage, batches, sweep, lanes);
    return coloured.turns_unevenly ? sweep_all<false, true>(stage, batches, sweep, lanes)
                                   : sweep_all<false, false>(stage, batches, sweep, lanes);
}

void keep_general(const ColouredStage& stage, BatchRange batches) {
    const ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.general[i];
        for (std::size_t k = 0; k < kLanes && batch.points[k] > 0; ++k) {
            Vec4 h;
            for (int axis = 0; axis < 4; ++axis) h[axis] = coloured.frames[i].h[axis].lane[k];
            for (std::uint32_t p = 0; p < batch.points[k]; ++p) {
                const float normal = coloured.rows[batch.row + p].along.impulse.lane[k];
                if (stage.cause == Cause::kBlow) {
                    stage.step.hit[batch.contact[k] + p] = normal > 0;
                    continue;
                }
                ContactImpulse& impulse = stage.step.impulses[batch.contact[k] + p];
                impulse.normal = stage.mass_unit * normal;
                impulse.tangent.setZero();
                if (!coloured.friction) continue;
                Vec4 tangent = Vec4::Zero();
                for (int axis = 0; axis < 3; ++axis)
                    tangent[axis] = coloured.general_friction[batch.row + p].impulse[axis].lane[k];
                impulse.tangent = stage.mass_unit * (tangent - h.dot(tangent) * h);
            }
        }
    }
}

}  // namespace tesserae
