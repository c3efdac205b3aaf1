// SPDX-License-Identifier: Apache-2.0
#include "core/world/world.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "core/dynamics/constraints/make_joint.hpp"
#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/diagnostics/joint_state.hpp"
#include "core/dynamics/diagnostics/momentum.hpp"
#include "core/error.hpp"
#include "core/world/check.hpp"
#include "core/world/inside.hpp"
#include "core/world/make_world.hpp"

namespace tesserae {
namespace {

Simulation empty_simulation(const PhysicsSettings& settings) {
    check(settings);
    return make_simulation({}, settings);
}

/// The numbers of a type, as if something else than contacts turned it.
TypeProperties properties_of(const BodyType& type) {
    Bodies one;
    one.types = {type};
    one.type = {0};
    const BodyId turned[] = {0};
    return type_properties(one, turned).front();
}

void check_place(const BodyType& type, const BodyState& state) {
    check(state);
    const bool is_at_rest_at_origin = state.position == Vec4::Zero() && state.rotor == Rotor{} &&
                                      state.velocity == Vec4::Zero() &&
                                      state.angular_velocity == Bivector{};
    if (!is_bounded(type.shape) && !is_at_rest_at_origin)
        throw InputError(
            fmt::format("state: a {} stands still at the origin; expected zeros and a rotor of 1",
                        name_of(type.shape)));
}

/// Checks the state of one of several bodies. Errors begin with what name() returns.
template <class Name>
void check_row(const BodyType& type, const BodyState& state, const Name& name) {
    try {
        check_place(type, state);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", name(), error.what()));
    }
}

/// Returns the wrench about a body's centre of a force, or an impulse, at a point.
Wrench about_centre(const Bodies& bodies, BodyId place, const Vec4& force, const Vec4& point) {
    return {force, wedge(point - bodies.position[place], force)};
}

template <class Item>
void require_length(const char* place, std::span<const Item> items, std::size_t count) {
    if (items.empty() || items.size() == count) return;
    throw InputError(fmt::format("{}: has {} rows; expected one for each of {} bodies", place,
                                 items.size(), count));
}

}  // namespace

World::World(const PhysicsSettings& settings, std::shared_ptr<Workers> workers)
    : inside_(std::make_unique<Inside>(empty_simulation(settings), std::move(workers))) {}
World::World(std::unique_ptr<Inside> inside) : inside_(std::move(inside)) {}
World::~World() = default;
World::World(const World& other) : inside_(std::make_unique<Inside>(*other.inside_)) {}
World& World::operator=(const World& other) {
    if (this != &other) inside_ = std::make_unique<Inside>(*other.inside_);
    return *this;
}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

World make_world(Simulation simulation, std::shared_ptr<Workers> workers) {
    return World(std::make_unique<World::Inside>(std::move(simulation), std::move(workers)));
}

const PhysicsSettings& World::settings() const { return inside_->simulation().settings; }

void World::set_gravity(const Vec4& gravity) {
    check("gravity", gravity);
    inside_->wake_all();
    inside_->simulation().settings.gravity = gravity;
}

void World::set_workers(std::shared_ptr<Workers> workers) {
    inside_->set_workers(std::move(workers));
}

BodyId World::add(const BodyType& type, const BodyState& state) {
    check(type);
    check_place(type, state);
    return inside_->add(type, state);
}

std::vector<BodyId> World::add_many(const BodyType& type, std::span<const BodyState> states) {
    check(type);
    for (std::size_t i = 0; i < states.size(); ++i)
        check_row(type, states[i], [i] { return fmt::format("row {}", i); });
    std::vector<BodyId> added;
    added.reserve(states.size());
    for (const BodyState& state : states) added.push_back(inside_->add(type, state));
    return added;
}

void World::remove(BodyId body) { inside_->remove(inside_->place_of(body)); }
bool World::has(BodyId body) const { return inside_->has(body); }
std::size_t World::size() const { return ids().size(); }

std::span<const BodyId> World::ids() const {
    inside_->settle();
    return inside_->bodies().used();
}

const BodyType& World::type(BodyId body) const {
    return inside_->simulation().bodies.type_of(inside_->place_of(body));
}

BodyState World::state(BodyId body) const {
    const BodyId place = inside_->place_of(body);
    const Bodies& bodies = inside_->simulation().bodies;
    return {bodies.position[place], bodies.rotor[place], bodies.velocity[place],
            bodies.angular_velocity[place]};
}

void World::set_state(BodyId body, const BodyState& state) {
    const BodyId place = inside_->place_of(body);
    check_place(inside_->simulation().bodies.type_of(place), state);
    inside_->set_state(place, state);
}

bool World::is_asleep(BodyId body) const {
    const BodyId place = inside_->place_of(body);
    const std::vector<BodyId>& asleep = inside_->simulation().memory.asleep;
    return !asleep.empty() && asleep[place] != kAwake;
}

void World::wake(BodyId body) { inside_->wake(inside_->place_of(body)); }

BodyArrays World::arrays() const {
    const std::shared_ptr<const Stepper> stepper = inside_->stepper();
    const Bodies& bodies = stepper->bodies();
    return {bodies.position, bodies.rotor, bodies.velocity, bodies.angular_velocity, stepper};
}

void World::set_arrays(std::span<const Vec4> position, std::span<const Rotor> rotor,
                       std::span<const Vec4> velocity, std::span<const Bivector> angular_velocity) {
    const std::size_t count = size();
    require_length("position", position, count);
    require_length("rotor", rotor, count);
    require_length("velocity", velocity, count);
    require_length("angular_velocity", angular_velocity, count);
    std::vector<BodyState> states(count);
    const Bodies& bodies = inside_->simulation().bodies;
    for (std::size_t i = 0; i < count; ++i) {
        states[i] = {position.empty() ? bodies.position[i] : position[i],
                     rotor.empty() ? bodies.rotor[i] : rotor[i],
                     velocity.empty() ? bodies.velocity[i] : velocity[i],
                     angular_velocity.empty() ? bodies.angular_velocity[i] : angular_velocity[i]};
        check_row(bodies.type_of(static_cast<BodyId>(i)), states[i],
                  [&] { return fmt::format("row {}, body {}", i, ids()[i]); });
    }
    inside_->wake_all();
    for (std::size_t i = 0; i < count; ++i) inside_->set_state(static_cast<BodyId>(i), states[i]);
}

void World::apply_impulse(BodyId body, const Vec4& impulse, const Vec4& point) {
    check("impulse", impulse);
    check("point", point);
    const BodyId place = inside_->place_of(body);
    const Bodies& bodies = inside_->simulation().bodies;
    const TypeProperties type = properties_of(bodies.type_of(place));
    const Wrench wrench = about_centre(bodies, place, impulse, point);
    BodyState state = this->state(body);
    state.velocity += type.inverse_mass * wrench.impulse;
    state.angular_velocity += angular_response(type, state.rotor, wrench.moment);
    inside_->set_state(place, state);
}

void World::apply_angular_impulse(BodyId body, const Bivector& impulse) {
    check("impulse", impulse);
    const BodyId place = inside_->place_of(body);
    BodyState state = this->state(body);
    state.angular_velocity += angular_response(
        properties_of(inside_->simulation().bodies.type_of(place)), state.rotor, impulse);
    inside_->set_state(place, state);
}

void World::apply_force(BodyId body, const Vec4& force, const Vec4& point) {
    check("force", force);
    check("point", point);
    const BodyId place = inside_->place_of(body);
    const Wrench more = about_centre(inside_->simulation().bodies, place, force, point);
    if (!(more.moment == Bivector{})) inside_->begin_turning();
    Wrench& wrench = inside_->force_on(place);
    wrench.impulse += more.impulse, wrench.moment += more.moment;
}

void World::apply_torque(BodyId body, const Bivector& torque) {
    check("torque", torque);
    const BodyId place = inside_->place_of(body);
    inside_->begin_turning();
    inside_->force_on(place).moment += torque;
}

JointId World::join(const JointDescription& joint, BodyId a, BodyId b) {
    JointDescription whole = joint;
    complete(whole);
    const BodyId place_a = inside_->place_of(a);
    const BodyId place_b = b == kWorld ? kWorld : inside_->place_of(b);
    const Bodies& bodies = inside_->simulation().bodies;
    if (a == b) throw InputError(fmt::format("joint: body {} cannot be joined to itself", a));
    if (!bodies.is_movable(place_a) && (b == kWorld || !bodies.is_movable(place_b)))
        throw InputError(
            fmt::format("joint: neither body {} nor {} may move; expected that one may", a,
                        b == kWorld ? "the world" : fmt::format("body {}", b)));
    const auto has_centre = [&](BodyId place) {
        return place != kWorld && is_bounded(bodies.type_of(place).shape);
    };
    if (is_line(joint.type) &&
        ((!joint.anchor_a && !has_centre(place_a)) || (!joint.anchor_b && !has_centre(place_b))))
        throw InputError("joint: expected anchors where a body has no centre, or is the world");
    const auto fail = [](const char* member, std::string_view what) {
        throw InputError(fmt::format("joint: {}: {}", member, what));
    };
    set_length(whole, bodies, place_a, place_b, fail);
    return inside_->add_joint(make_joint(whole, bodies, place_a, place_b, fail));
}

void World::remove_joint(JointId joint) { inside_->remove_joint(inside_->place_of_joint(joint)); }
bool World::has_joint(JointId joint) const { return inside_->has_joint(joint); }

std::span<const JointId> World::joint_ids() const {
    inside_->settle();
    return inside_->joints().used();
}

JointReading World::joint(JointId joint) const {
    inside_->settle();
    const std::size_t place = inside_->place_of_joint(joint);
    const std::shared_ptr<const Stepper> stepper = inside_->stepper();
    const Joints& joints = stepper->simulation().joints;
    const Joint& which = joints.all[place];
    const auto impulses = stepper->joint_impulses();
    const JointState state =
        state_of(which, stepper->bodies(), place < impulses.size() ? impulses[place] : Wrench{});
    const Numbers& ids = inside_->bodies();
    const bool of_world = which.a == kWorld;
    return {ids[of_world ? which.b : which.a],
            of_world ? kWorld : ids[which.b],
            !stepper->memory().broken.empty() && stepper->memory().broken[place] != 0,
            state.impulse,
            state.angular_impulse,
            state.error,
            state.angular_error,
            state.position};
}

StepReport World::step() { return step(1 / settings().steps_per_second); }
StepReport World::step(double dt) { return inside_->step(dt); }
StepReport World::step(double dt, StopQuestion stop) { return inside_->step(dt, &stop); }
double World::time() const { return inside_->simulation().memory.time; }

std::span<const ContactReading> World::contacts() const {
    inside_->settle();
    return inside_->contacts();
}
ContactChanges World::contact_changes() {
    inside_->settle();
    return inside_->contact_changes();
}

double World::kinetic_energy() const {
    return tesserae::kinetic_energy(inside_->stepper()->bodies());
}
double World::potential_energy() const {
    return tesserae::potential_energy(inside_->stepper()->bodies(), settings().gravity);
}
Vec4 World::momentum() const { return total_momentum(inside_->stepper()->bodies()); }
Bivector World::angular_momentum() const {
    return total_angular_momentum(inside_->stepper()->bodies());
}

}  // namespace tesserae
