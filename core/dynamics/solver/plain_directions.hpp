// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/dynamics/solver/island_directions.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Pairs of sweeps along conjugate directions over contacts that are solved one by one, in double:
/// see conjugate.hpp. It has the functions of ConjugateDirections. A step ends where the first
/// contact opens. In large islands some contact always opens early, and longer steps lead farther.
/// There is no direction after a pair of sweeps that ends with a contact that slides: its friction
/// is given by its normal impulse, which the energy does not know, and directions would lead away.
class PlainDirections {
  public:
    /// @param bodies   the movable ones
    /// @param pass     tells which targets the rows have
    PlainDirections(const Simulation& simulation, StepData& step, std::span<ContactRow> rows,
                    std::span<const BodyId> bodies, Pass pass);

    Members begun() const { return begun_; }
    void begin(Members some);
    PerMember<double> find(Members some);
    bool holds(int) const { return begun_.any() && of_.holds(); }
    void go_on(Members some);
    /// What they gain is cut otherwise: see limit_warm_starts(), has_jammed() and
    /// part_of_restitution().
    static bool is_gain(int) { return false; }
    static void take_back(Members) {}

  private:
    /// Of a row: its impulses where the pair of sweeps started, the direction, and the velocities
    /// that it aims at, less those of bodies that do not move.
    struct RowState {
        double last_normal, normal_direction, normal_aim;
        Vec4 last_tangent, tangent_direction, tangent_aim;
    };
    /// Of a body: its motion where the pair of sweeps started, what the pair has changed and the
    /// direction, each with its momentum.
    struct BodyState {
        BodyMotion last, step, direction;
        BodyMotion of_last, of_step, of_direction;
    };
    /// Is used by all islands that are solved on a thread, one after the other.
    struct Room {
        std::vector<RowState> rows;
        std::vector<BodyState> bodies;
    };
    static Room& room();

    BodyMotion momentum_of(BodyId id, const BodyMotion& motion) const;
    void start_anew();
    IslandDirections::RowSums weigh_rows() const;
    BodySums weigh_bodies();
    double longest_step(double carried) const;

    const Simulation& simulation_;
    StepData& step_;
    std::span<ContactRow> rows_;
    std::span<const BodyId> bodies_;
    Room& room_;
    Pass pass_;
    Members begun_;
    IslandDirections of_;
};

}  // namespace tesserae
