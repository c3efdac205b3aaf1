// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/islands/colouring.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "core/counting_sort.hpp"
#include "core/dynamics/step/room.hpp"

namespace tesserae {
namespace {

/// A bit of a word each; what is left over is solved one by one.
constexpr int kColours = 64;

/// Within a colour the pairs of round bodies come first, then those of 8, 7, ..., 1 points, so that
/// the lanes of a batch have about as many, and then the constraints that are no contacts.
constexpr std::size_t kOthers = 1 + kManifoldPoints, kKinds = kOthers + 1;

template <std::size_t kTangents, class Lanes>
void size_impulses(std::size_t rows, bool friction, RowImpulses<kTangents, Lanes>& impulses) {
    resize_anew(impulses.normal, rows);
    resize_anew(impulses.tangent, friction ? rows : 0);
}

void size_directions(ColouredIslands& coloured) {
    resize_anew(coloured.direction, coloured.bodies.size());
    resize_anew(coloured.warm_start, coloured.bodies.size());
    if (coloured.turns_unevenly) resize_anew(coloured.inertias, coloured.bodies.size());
    size_impulses(coloured.round.size(), coloured.friction, coloured.last_round);
    size_impulses(coloured.round.size(), coloured.friction, coloured.round_direction);
    size_impulses(coloured.general_rows, coloured.friction, coloured.last_general);
    size_impulses(coloured.general_rows, coloured.friction, coloured.general_direction);
    resize_anew(coloured.round_work, coloured.round.size());
    resize_anew(coloured.general_work, coloured.general.size());
    resize_anew(coloured.round_lane_work, coloured.round.size());
    resize_anew(coloured.general_lane_work, coloured.general.size());
    resize_anew(coloured.others_work, coloured.others.size());
}

}  // namespace

void Colouring::begin(const Simulation& simulation, StepData& step) {
    ColouredIslands& coloured = step.coloured;
    coloured.friction = simulation.needs.friction;
    coloured.rolling = simulation.needs.rolling;
    coloured.turns_unevenly = simulation.needs.uneven_inertia;
    coloured.islands.clear();
    coloured.group.clear();
    coloured.first_body.assign(1, 1);
    coloured.first_member.assign(1, 0);
    coloured.first_colour.assign(1, 0);
    coloured.shares_batches.clear();
    coloured.mass_unit.clear();
    coloured.bodies.assign(1, BodyId{0});  // stands for those that contacts do not move
    coloured.colours.clear();
    coloured.round.clear();
    coloured.general.clear();
    coloured.others.clear();
    coloured.general_rows = coloured.point_responses = 0;
    place_.clear();
    used_.clear();
}

void Colouring::add(const Simulation& simulation, StepData& step,
                    std::span<const std::uint32_t> group, bool share) {
    ColouredIslands& coloured = step.coloured;
    place_.resize(simulation.bodies.size(), 0);
    pairs_.clear();
    member_ = 0;
    for (const std::uint32_t island : group) add_member(simulation, step, island), ++member_;
    // Large enough for the largest group: small ones come before and after it.
    if (order_.size() < pairs_.size()) resize_anew(order_, pairs_.size());
    counting_sort(
        pairs_.size(), (kColours + 1) * kKinds, [&](std::size_t i) { return pairs_[i].bucket; },
        start_,
        [&](std::size_t i, std::size_t place) { order_[place] = static_cast<std::uint32_t>(i); });

    auto rows_of_round = static_cast<std::uint32_t>(coloured.round.size());  // one each
    for (std::size_t colour = 0; colour <= kColours; ++colour) {
        const std::uint32_t* const start = &start_[colour * kKinds];
        if (start[0] == start[kKinds] && colour < kColours) continue;
        const BatchRange round = add_batches(step, {start, 2}, rows_of_round, coloured.round);
        // The pairs of an island alone need not have equally many points.
        const std::array<std::uint32_t, 2> all = {start[1], start[kOthers]};
        const BatchRange general =
            add_batches(step, share ? std::span(&start[1], kOthers) : std::span(all),
                        coloured.general_rows, coloured.general);
        for (std::uint32_t i = general.begin; i < general.end; ++i) {
            coloured.general[i].response = coloured.point_responses;
            coloured.point_responses += responses_of(coloured.general[i].rows);
        }
        coloured.colours.push_back(
            {round, general, add_others(step, {start[kOthers], start[kKinds]})});
    }
    coloured.first_member.push_back(static_cast<std::uint32_t>(coloured.islands.size()));
    coloured.first_colour.push_back(static_cast<std::uint32_t>(coloured.colours.size()));
    coloured.shares_batches.push_back(share);
}

/// The bodies and pairs of an island.
void Colouring::add_member(const Simulation& simulation, StepData& step, std::size_t island) {
    ColouredIslands& coloured = step.coloured;
    step.islands.coloured[island] = static_cast<std::uint32_t>(coloured.islands.size());
    coloured.islands.push_back(static_cast<std::uint32_t>(island));
    coloured.group.push_back(static_cast<std::uint32_t>(coloured.shares_batches.size()));
    list_pairs(simulation, step, island);
    // The middle of the masses' range, as its logarithm.
    int least = std::numeric_limits<int>::max(), most = std::numeric_limits<int>::min();
    for (std::size_t i = coloured.first_body.back(); i < coloured.bodies.size(); ++i) {
        const int exponent = std::ilogb(simulation.type_of(coloured.bodies[i]).mass);
        least = std::min(least, exponent), most = std::max(most, exponent);
    }
    coloured.mass_unit.push_back(std::ldexp(1.0, (least + most) / 2));
    coloured.first_body.push_back(static_cast<std::uint32_t>(coloured.bodies.size()));
}

void Colouring::end(StepData& step) {
    ColouredIslands& coloured = step.coloured;
    resize_anew(coloured.changes, coloured.bodies.size());
    resize_anew(coloured.last_changes, coloured.bodies.size());
    resize_anew(coloured.body_sums,
                coloured.bodies.size() / kSumPiece + coloured.first_body.size());
    size_directions(coloured);
    if (coloured.turns_unevenly) {
        resize_anew(coloured.inverse_inertias, coloured.bodies.size());
        resize_anew(coloured.pair_inertias, coloured.general.size());
    }
    size_impulses(coloured.round.size(), coloured.friction, coloured.round_impulses);
    size_impulses(coloured.general_rows, coloured.friction, coloured.impulses);
    resize_anew(coloured.round_rows, coloured.round.size());
    resize_anew(coloured.round_second, coloured.round.size());
    resize_anew(coloured.frames, coloured.general.size());
    resize_anew(coloured.round_left, coloured.round.size());
    resize_anew(coloured.general_left, coloured.general.size());
    resize_anew(coloured.rows, coloured.general_rows);
    resize_anew(coloured.second, coloured.general_rows);
    resize_anew(coloured.point_response, coloured.point_responses);
    if (!coloured.friction) return;
    resize_anew(coloured.round_friction, coloured.round.size());
    resize_anew(coloured.pair_friction, coloured.general.size());
    resize_anew(coloured.general_friction, coloured.general_rows);
    if (!coloured.rolling) return;
    resize_anew(coloured.round_rolling, coloured.round.size());
    resize_anew(coloured.pair_rolling, coloured.general.size());
    resize_anew(coloured.general_rolling, coloured.general_rows);
}

std::uint32_t Colouring::place_of(const Simulation& simulation, StepData& step, BodyId id) {
    if (!simulation.is_movable(id)) return 0;
    std::uint32_t& place = place_[id];
    if (place == 0) {
        place = static_cast<std::uint32_t>(step.coloured.bodies.size());
        step.coloured.bodies.push_back(id);
    }
    return place;
}

void Colouring::list_pairs(const Simulation& simulation, StepData& step, std::size_t island) {
    for (const std::uint32_t n : step.islands.runs_in(island)) {
        const ContactList::Run run = step.contacts.nth_run(n);
        for (std::size_t begin = run.begin; begin < run.end; begin += kManifoldPoints)
            add_pair(simulation, step, run, {begin, std::min(run.end, begin + kManifoldPoints)});
    }
    for (const std::uint32_t i : step.islands.constraints_in(island)) {
        Constraint& constraint = step.constraints[i];
        constraint.place_a = place_of(simulation, step, constraint.a);
        constraint.place_b = place_of(simulation, step, constraint.b);
        used_.resize(step.coloured.bodies.size(), 0);
        const int colour = colour_of(constraint.place_a, constraint.place_b);
        pairs_.push_back({i, static_cast<std::uint16_t>(colour * kKinds + kOthers), 0, member_});
    }
}

void Colouring::add_pair(const Simulation& simulation, StepData& step, const ContactList::Run& run,
                         Range contacts) {
    Pair pair;
    pair.first = static_cast<std::uint32_t>(contacts.begin);
    const std::uint32_t a = place_of(simulation, step, run.a);
    const std::uint32_t b = place_of(simulation, step, run.b);
    const std::size_t points = contacts.end - contacts.begin;
    const bool round =
        points == 1 && simulation.type_of(run.a).round && simulation.type_of(run.b).round;
    pair.points = static_cast<std::uint8_t>(points);
    pair.member = member_;
    used_.resize(step.coloured.bodies.size(), 0);
    const std::size_t kind = round ? 0 : 1 + kManifoldPoints - points;
    pair.bucket = static_cast<std::uint16_t>(colour_of(a, b) * kKinds + kind);
    pairs_.push_back(pair);
}

/// The first that none of its movable bodies has yet; kColours if all are taken.
int Colouring::colour_of(std::uint32_t a, std::uint32_t b) {
    // The first place is all immovable bodies': it takes no colour.
    const std::uint64_t taken = (a > 0 ? used_[a] : 0) | (b > 0 ? used_[b] : 0);
    const int colour = std::countr_one(taken);
    if (colour == kColours) return colour;
    used_[a] |= std::uint64_t{1} << colour;
    used_[b] |= std::uint64_t{1} << colour;
    return colour;
}

BatchRange Colouring::add_others(StepData& step, Range some) const {
    std::vector<std::uint32_t>& others = step.coloured.others;
    BatchRange range;
    range.begin = static_cast<std::uint32_t>(others.size());
    for (std::size_t i = some.begin; i < some.end; ++i) others.push_back(pairs_[order_[i]].first);
    range.end = static_cast<std::uint32_t>(others.size());
    return range;
}

/// Of pairs of several kinds, each in batches of its own: places in order_ from one start to the
/// next.
BatchRange Colouring::add_batches(const StepData& step, std::span<const std::uint32_t> starts,
                                  std::uint32_t& rows, std::vector<Batch>& batches) const {
    BatchRange range;
    range.begin = static_cast<std::uint32_t>(batches.size());
    for (std::size_t kind = 0; kind + 1 < starts.size(); ++kind)
        for (std::size_t begin = starts[kind]; begin < starts[kind + 1]; begin += kLanes)
            add_batch(step, {begin, std::min<std::size_t>(starts[kind + 1], begin + kLanes)}, rows,
                      batches);
    range.end = static_cast<std::uint32_t>(batches.size());
    return range;
}

void Colouring::add_batch(const StepData& step, Range pairs, std::uint32_t& rows,
                          std::vector<Batch>& batches) const {
    Batch& batch = batches.emplace_back();
    batch.row = rows;
    for (std::size_t k = 0; k < pairs.end - pairs.begin; ++k) {
        const Pair& pair = pairs_[order_[pairs.begin + k]];
        const auto [a, b] = step.contacts.pair(pair.first);
        batch.a[k] = place_[a], batch.b[k] = place_[b];
        batch.contact[k] = pair.first, batch.points[k] = pair.points;
        batch.member[k] = pair.member;
        batch.members = batch.members | Members::only(pair.member);
        batch.rows = std::max<std::uint32_t>(batch.rows, pair.points);
    }
    rows += batch.rows;
}

}  // namespace tesserae
