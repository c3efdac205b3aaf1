// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/dynamics/step/schedule.hpp"
#include "core/dynamics/stepper.hpp"
#include "core/world/ball_tree.hpp"
#include "core/world/world.hpp"

namespace tesserae {

/// Numbers that are given out once, in ascending order, and the places of those in use.
class Numbers {
  public:
    Numbers() = default;
    /// Takes numbers 0 to count - 1 into use.
    explicit Numbers(std::size_t count);
    /// Takes these into use, ascending and below `next`.
    Numbers(std::vector<std::uint32_t> used, std::uint32_t next)
        : used_(std::move(used)), next_(next) {}

    /// Takes the next number into use.
    /// @throws InputError   all are used up
    std::uint32_t add();
    /// Returns the place of a number, or size() if it is not in use.
    std::size_t place_of(std::uint32_t number) const;
    /// Leaves out the numbers whose places are marked by 1.
    void remove(const std::vector<std::uint8_t>& marks);

    const std::vector<std::uint32_t>& used() const { return used_; }
    std::size_t size() const { return used_.size(); }
    std::uint32_t operator[](std::size_t place) const { return used_[place]; }
    std::uint32_t next() const { return next_; }

  private:
    std::vector<std::uint32_t> used_;
    std::uint32_t next_ = 0;
};

/// What is in a World: a Stepper, the numbers of its bodies and joints, and what was changed since
/// the last step. Bodies and joints that are added are appended at once. What is removed is marked,
/// and taken out by settle(), so that many calls cost as much as one.
class World::Inside {
  public:
    Inside(Simulation simulation, std::shared_ptr<Workers> workers);
    Inside(const Inside& other);

    Simulation& simulation() { return *simulation_; }
    const Numbers& bodies() const { return bodies_; }
    const Numbers& joints() const { return joints_; }

    /// Returns the place of a body or a joint in the lists of the simulation.
    /// @throws InputError   there is none with this number
    BodyId place_of(BodyId body) const;
    std::size_t place_of_joint(JointId joint) const;
    bool has(BodyId body) const;
    bool has_joint(JointId joint) const;

    BodyId add(const BodyType& type, const BodyState& state);
    void remove(BodyId place);
    JointId add_joint(Joint joint);
    void remove_joint(std::size_t place);
    /// Takes out what was removed, and computes what every step needs from the bodies, if that has
    /// changed.
    void settle();

    void set_state(BodyId place, const BodyState& state);
    void set_workers(std::shared_ptr<Workers> workers);
    /// Wakes a body, all that sleep with it, and the sleeping ones that it touches.
    void wake(BodyId place);
    void wake_all();
    /// Returns the wrench that acts on a body in the next step, to be changed.
    Wrench& force_on(BodyId place);
    /// Has to be called before anything but contacts and joints turns bodies by a force.
    void begin_turning();

    StepReport step(double dt, const StopQuestion* stop = nullptr);
    /// Returns the bodies' arrays, and what keeps them alive.
    std::shared_ptr<const Stepper> stepper();
    const std::vector<ContactReading>& contacts();
    ContactChanges contact_changes();
    const BallTree& tree();

    /// Writes all but the workers to bytes; makes one of them.
    friend class WorldBytes;

  private:
    std::uint32_t place_of_type(const BodyType& type);
    void begin_change();
    void begin_change_of_bodies();
    void take_out_removed();
    void wake_island(BodyId root);
    StepReport do_step(double dt, const StopQuestion* stop);
    std::vector<TouchingPair> touching_pairs();

    std::shared_ptr<Stepper> stepper_;  ///< shared with those who look at its arrays
    Simulation* simulation_;            ///< of the stepper
    std::shared_ptr<Workers> workers_;
    std::unique_ptr<Schedule> schedule_;  ///< of the workers, from the first step on
    Numbers bodies_, joints_;
    std::vector<std::uint8_t> removed_, removed_joints_;         ///< of every one; empty if none is
    std::unordered_multimap<std::size_t, std::uint32_t> types_;  ///< places of types by hash
    bool is_turned_ = false;                                     ///< see begin_turning()
    bool is_stale_ = false;  ///< what is computed from the bodies may not fit
    std::vector<ContactReading> contacts_;
    bool has_contacts_ = true;           ///< contacts_ are those of the last step
    std::vector<TouchingPair> touched_;  ///< at the last call of contact_changes()
    BallTree tree_;
    bool has_tree_ = false;  ///< tree_ is of the bodies as they are
};

}  // namespace tesserae
