// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/dynamics/bodies/body.hpp"
#include "core/dynamics/constraints/joint_description.hpp"
#include "core/dynamics/step/report.hpp"
#include "core/dynamics/step/settings.hpp"
#include "core/stop.hpp"
#include "core/world/readings.hpp"
#include "core/world/workers.hpp"

namespace tesserae {

struct Simulation;

/// A world of rigid bodies in four dimensions. Bodies and joints are added and removed between
/// steps, read, moved and pushed.
///
/// Bodies and joints have numbers, counted from 0 in the order in which they are added. The number
/// of one that was removed is not used again.
///
/// The same calls give the same bits, with any number of threads. A world belongs to one thread at
/// a time: calls from several threads at once need a lock. Different worlds are independent.
///
/// Functions that take a body's or joint's number throw InputError if the world has none with it.
/// Every number that is given is checked. An InputError says which one is wrong, and what was
/// expected; the world is then as before the call.
class World {
  public:
    /// Makes an empty world.
    /// @param workers   the threads that steps use; none: the calling thread alone, which tests
    ///                  every two bodies for contacts and is slow for more than some hundred
    /// @throws InputError   a setting is out of its range
    explicit World(const PhysicsSettings& settings = {}, std::shared_ptr<Workers> workers = {});
    ~World();
    /// Copies the whole state: the copy goes on with the same bits. It shares the workers.
    World(const World& other);
    World& operator=(const World& other);
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    const PhysicsSettings& settings() const;
    /// @throws InputError   a component is not finite
    void set_gravity(const Vec4& gravity);
    /// Sets the threads that steps use. It changes no result.
    void set_workers(std::shared_ptr<Workers> workers);

    // ---- bodies ------------------------------------------------------------------------------

    /// Adds a body and returns its number. A body of an unbounded shape stands still at the origin.
    BodyId add(const BodyType& type, const BodyState& state = {});
    /// Adds bodies of one type, and returns their numbers, which follow each other.
    std::vector<BodyId> add_many(const BodyType& type, std::span<const BodyState> states);
    /// Removes a body and its joints. What touched it or slept with it is awake afterwards.
    void remove(BodyId body);
    bool has(BodyId body) const;
    /// Returns the number of bodies.
    std::size_t size() const;
    /// Returns the bodies, ascending. It is valid until bodies are added or removed.
    std::span<const BodyId> ids() const;

    const BodyType& type(BodyId body) const;
    BodyState state(BodyId body) const;
    /// Moves a body and gives it another velocity. It wakes the body.
    void set_state(BodyId body, const BodyState& state);
    /// Returns whether a body sleeps; see PhysicsSettings::sleeping.
    bool is_asleep(BodyId body) const;
    void wake(BodyId body);

    /// Returns the state of all bodies, in the order of ids().
    BodyArrays arrays() const;
    /// Sets the state of all bodies, in the order of ids(), and wakes them. An empty span leaves a
    /// part as it is.
    void set_arrays(std::span<const Vec4> position, std::span<const Rotor> rotor,
                    std::span<const Vec4> velocity, std::span<const Bivector> angular_velocity);

    // ---- pushes ------------------------------------------------------------------------------
    // What has a fixed position or rotation does not change that part of its motion by them.

    /// Changes a body's motion at once. It wakes the body.
    /// @param impulse   world [N s]
    /// @param point     where it acts, world [m]
    void apply_impulse(BodyId body, const Vec4& impulse, const Vec4& point);
    /// Changes how a body turns at once. It wakes the body.
    /// @param impulse   world [N m s]
    void apply_angular_impulse(BodyId body, const Bivector& impulse);
    /// Lets a force act during the next step only. Forces of several calls are added. It wakes the
    /// body.
    /// @param force   world [N]
    /// @param point   where it acts, world [m]
    void apply_force(BodyId body, const Vec4& force, const Vec4& point);
    /// Lets a torque act during the next step only.
    /// @param torque   world [N m]
    void apply_torque(BodyId body, const Bivector& torque);

    // ---- joints ------------------------------------------------------------------------------

    /// Joins two bodies where they are now, or a body and the world, and returns the joint's
    /// number.
    JointId join(const JointDescription& joint, BodyId a, BodyId b = kWorld);
    void remove_joint(JointId joint);
    bool has_joint(JointId joint) const;
    /// Returns the joints, ascending. It is valid until joints are added or removed.
    std::span<const JointId> joint_ids() const;
    /// Returns what a joint is and did in the last step.
    JointReading joint(JointId joint) const;

    // ---- the step ----------------------------------------------------------------------------

    /// Advances by 1 / settings().steps_per_second.
    /// @throws LeftFiniteRange   a body became too fast or too far away; the world is then as
    ///                           before the call
    StepReport step();
    /// Advances by a time [s].
    /// @throws InputError        dt is not finite or not > 0
    /// @throws LeftFiniteRange   as above
    StepReport step(double dt);
    /// Advances by a time [s], unless it is told to stop.
    /// @param stop       is asked first, and where there is much work again and again amid the
    /// step,
    ///                   by all threads of the workers
    /// @throws Stopped   it was true; the world is then as before the call
    StepReport step(double dt, StopQuestion stop);
    /// Returns the time of all steps [s].
    double time() const;

    // ---- readings ----------------------------------------------------------------------------

    /// Returns the contact points of the last step: those of its last sub-step that touch, overlap
    /// or push, ascending by bodies. Points between bodies that sleep are not among them. It is
    /// valid until the next step.
    std::span<const ContactReading> contacts() const;
    /// Returns which pairs of bodies touch since the last call, and which do so no more. Call it
    /// after every step to miss none. Bodies that sleep touch each other still.
    ContactChanges contact_changes();

    /// Returns the sum of all m v^2 / 2 + omega . L / 2 [J].
    double kinetic_energy() const;
    /// Returns the sum of all -m g . x [J].
    double potential_energy() const;
    /// Returns the sum of all m v [kg m/s].
    Vec4 momentum() const;
    /// Returns the angular momentum about the origin [kg m^2/s].
    Bivector angular_momentum() const;

    // ---- queries -----------------------------------------------------------------------------

    /// Returns the first body that a ray meets.
    /// @param direction   any length but 0
    /// @param reach       greatest distance [m]
    /// @return nothing if there is none; a ray that starts in a body meets it at once
    std::optional<RayHit> ray(const Vec4& origin, const Vec4& direction,
                              double reach = kNoLimit) const;
    /// Returns the bodies that touch or overlap a shape at a place, ascending.
    std::vector<BodyId> overlapping(const Shape& shape, const Vec4& position,
                                    const Rotor& rotor = {}) const;
    /// Returns the body whose surface is nearest to a point: inside a body the distance is
    /// negative, and the deepest counts.
    /// @param reach   greatest distance [m]
    /// @return nothing if there is none
    std::optional<Nearest> nearest(const Vec4& point, double reach = kNoLimit) const;

    // ---- state -------------------------------------------------------------------------------

    /// Returns the whole state as bytes. A world that is loaded from them goes on with the same
    /// bits.
    std::string save() const;
    /// Makes a world from bytes.
    /// @throws InputError   they are not of save(), are damaged, or come from a program that moves
    ///                      bodies otherwise
    static World load(std::string_view bytes, std::shared_ptr<Workers> workers = {});

    class Inside;  ///< no public header says what it is

  private:
    friend World make_world(Simulation simulation, std::shared_ptr<Workers> workers);
    explicit World(std::unique_ptr<Inside> inside);

    std::unique_ptr<Inside> inside_;
};

}  // namespace tesserae
