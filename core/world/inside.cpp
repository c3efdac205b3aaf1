// SPDX-License-Identifier: Apache-2.0
#include "core/world/inside.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>
#include <numeric>

#include "core/error.hpp"
#include "core/world/check.hpp"
#include "core/world/take_out.hpp"

namespace tesserae {
namespace {

/// Returns a hash of the parameters of a shape and a mass: equal types have equal ones.
class TypeHash {
  public:
    explicit TypeHash(const BodyType& type) : hash_(type.shape.index()) {
        add(type.mass);
        std::visit(
            [&](const auto& shape) {
                shape.parameters(
                    shape, [&](const Key&, const auto& value, Rule) { add_parameter(value); });
            },
            type.shape);
    }
    std::size_t value() const { return hash_; }

  private:
    void add(double number) {
        // Both zeros are equal.
        hash_ = std::rotl(hash_, 7) * 0x9e3779b97f4a7c15 ^ std::hash<double>()(number);
    }
    void add_parameter(double value) { add(value); }
    template <int kSize>
    void add_parameter(const Eigen::Matrix<double, kSize, 1>& values) {
        for (const double value : values) add(value);
    }
    void add_parameter(const std::vector<Vec4>& points) {
        for (const Vec4& point : points) add_parameter(point);
    }
    void add_parameter(const std::array<std::int64_t, 2>& values) {
        for (const std::int64_t value : values) add(static_cast<double>(value));
    }
    void add_parameter(RegularPolychoron which) { add(static_cast<double>(which)); }

    std::uint64_t hash_;
};

}  // namespace

Numbers::Numbers(std::size_t count) : used_(count), next_(static_cast<std::uint32_t>(count)) {
    std::iota(used_.begin(), used_.end(), 0U);
}

std::uint32_t Numbers::add() {
    if (next_ == std::numeric_limits<std::uint32_t>::max())
        throw InputError("a world gives out at most 2^32 - 1 numbers, and they are used up");
    used_.push_back(next_);
    return next_++;
}

std::size_t Numbers::place_of(std::uint32_t number) const {
    // Where none was removed it is the number.
    if (number < used_.size() && used_[number] == number) return number;
    const auto place = std::lower_bound(used_.begin(), used_.end(), number);
    if (place == used_.end() || *place != number) return used_.size();
    return static_cast<std::size_t>(place - used_.begin());
}

void Numbers::remove(const std::vector<std::uint8_t>& marks) {
    if (marks.empty()) return;
    std::size_t left = 0;
    for (std::size_t i = 0; i < used_.size(); ++i)
        if (marks[i] == 0) used_[left++] = used_[i];
    used_.resize(left);
}

World::Inside::Inside(Simulation simulation, std::shared_ptr<Workers> workers)
    : stepper_(std::make_shared<Stepper>(std::move(simulation))),
      simulation_(&stepper_->simulation()),
      workers_(std::move(workers)),
      bodies_(simulation_->bodies.size()),
      joints_(simulation_->joints.all.size()) {
    for (std::uint32_t i = 0; i < simulation_->bodies.types.size(); ++i)
        types_.emplace(TypeHash(simulation_->bodies.types[i]).value(), i);
}

World::Inside::Inside(const Inside& other)
    : stepper_(std::make_shared<Stepper>(Simulation(*other.simulation_))),
      simulation_(&stepper_->simulation()),
      workers_(other.workers_),
      bodies_(other.bodies_),
      joints_(other.joints_),
      removed_(other.removed_),
      removed_joints_(other.removed_joints_),
      types_(other.types_),
      is_turned_(other.is_turned_),
      is_stale_(other.is_stale_),
      touched_(other.touched_) {}

bool World::Inside::has(BodyId body) const {
    const std::size_t place = bodies_.place_of(body);
    return place < bodies_.size() && (removed_.empty() || removed_[place] == 0);
}

bool World::Inside::has_joint(JointId joint) const {
    const std::size_t place = joints_.place_of(joint);
    return place < joints_.size() && (removed_joints_.empty() || removed_joints_[place] == 0);
}

BodyId World::Inside::place_of(BodyId body) const {
    if (body == kWorld) throw InputError("body: is the world; expected the number of a body");
    if (!has(body))
        throw InputError(fmt::format("body {}: {}; expected one that the world has", body,
                                     body < bodies_.next() ? "was removed" : "was never added"));
    return static_cast<BodyId>(bodies_.place_of(body));
}

std::size_t World::Inside::place_of_joint(JointId joint) const {
    if (!has_joint(joint))
        throw InputError(fmt::format("joint {}: {}; expected one that the world has", joint,
                                     joint < joints_.next() ? "was removed" : "was never added"));
    return joints_.place_of(joint);
}

void World::Inside::begin_change() {
    contacts();
    is_stale_ = true;
    has_tree_ = false;
}

/// Those who look at arrays keep them as they are now: the change is made in copies.
void World::Inside::begin_change_of_bodies() {
    begin_change();
    if (stepper_.use_count() == 1) return;
    stepper_ = std::make_shared<Stepper>(Simulation(*simulation_));
    simulation_ = &stepper_->simulation();
}

std::uint32_t World::Inside::place_of_type(const BodyType& type) {
    std::vector<BodyType>& types = simulation_->bodies.types;
    const std::size_t hash = TypeHash(type).value();
    for (auto [at, end] = types_.equal_range(hash); at != end; ++at)
        if (types[at->second] == type) return at->second;
    BodyType whole = type;
    make_complete(whole.shape);
    const auto place = static_cast<std::uint32_t>(types.size());
    types.push_back(std::move(whole));
    types_.emplace(hash, place);
    return place;
}

BodyId World::Inside::add(const BodyType& type, const BodyState& state) {
    begin_change_of_bodies();
    const std::uint32_t place = place_of_type(type);
    const BodyId id = bodies_.add();
    Bodies& bodies = simulation_->bodies;
    bodies.type.push_back(place);
    bodies.position.push_back(state.position);
    bodies.rotor.push_back(state.rotor);
    bodies.velocity.push_back(state.velocity);
    bodies.angular_velocity.push_back(state.angular_velocity);
    StepMemory& memory = simulation_->memory;
    if (!memory.asleep.empty()) memory.asleep.push_back(kAwake);
    if (!memory.still.empty()) memory.still.push_back(0);
    if (!simulation_->forces.empty()) simulation_->forces.push_back({});
    if (!removed_.empty()) removed_.push_back(0);
    return id;
}

void World::Inside::remove(BodyId place) {
    wake(place);
    begin_change_of_bodies();
    removed_.resize(bodies_.size());
    removed_[place] = 1;
    const std::vector<Joint>& joints = simulation_->joints.all;
    for (std::size_t i = 0; i < joints.size(); ++i)
        if ((joints[i].a == place || joints[i].b == place) &&
            (removed_joints_.empty() || removed_joints_[i] == 0))
            remove_joint(i);
}

JointId World::Inside::add_joint(Joint joint) {
    begin_change();
    for (const BodyId place : {joint.a, joint.b})
        if (place != kWorld) wake(place);
    const JointId id = joints_.add();
    Joints& joints = simulation_->joints;
    joints.all.push_back(std::move(joint));
    StepMemory& memory = simulation_->memory;
    if (!memory.broken.empty()) memory.broken.push_back(0);
    if (!removed_joints_.empty()) removed_joints_.push_back(0);
    return id;
}

void World::Inside::remove_joint(std::size_t place) {
    const Joint& joint = simulation_->joints.all[place];
    for (const BodyId body : {joint.a, joint.b})
        if (body != kWorld) wake(body);
    begin_change();
    removed_joints_.resize(joints_.size());
    removed_joints_[place] = 1;
}

void World::Inside::take_out_removed() {
    if (removed_.empty() && removed_joints_.empty()) return;
    const auto is_removed = [&](BodyId body) {
        const std::size_t place = bodies_.place_of(body);
        return place >= bodies_.size() || (!removed_.empty() && removed_[place] != 0);
    };
    std::erase_if(contacts_,
                  [&](const ContactReading& c) { return is_removed(c.a) || is_removed(c.b); });
    take_out(*simulation_, removed_, removed_joints_);
    bodies_.remove(removed_), joints_.remove(removed_joints_);
    removed_.clear(), removed_joints_.clear();
    types_.clear();
    for (std::uint32_t i = 0; i < simulation_->bodies.types.size(); ++i)
        types_.emplace(TypeHash(simulation_->bodies.types[i]).value(), i);
}

void World::Inside::settle() {
    if (!is_stale_) return;
    take_out_removed();
    Simulation& old = *simulation_;
    std::vector<BodyId> turned;
    if (is_turned_) {
        turned.resize(old.bodies.size());
        std::iota(turned.begin(), turned.end(), BodyId{0});
    }
    Simulation fresh =
        make_simulation(std::move(old.bodies), old.settings, std::move(old.joints.all), turned);
    fresh.memory = std::move(old.memory);
    fresh.forces = std::move(old.forces);
    if (!fresh.memory.broken.empty()) set_broken(fresh.joints, fresh.bodies, fresh.memory.broken);
    *stepper_ = Stepper(std::move(fresh));
    if (schedule_) schedule_->forget_hints();
    is_stale_ = false;
    has_tree_ = false;
}

void World::Inside::set_state(BodyId place, const BodyState& state) {
    wake(place);
    Bodies& bodies = simulation_->bodies;
    // Steps in which nothing turns do not look at these.
    if (!simulation_->needs.turning &&
        !(bodies.rotor[place] == state.rotor && state.angular_velocity == Bivector{}))
        begin_change();
    bodies.position[place] = state.position;
    bodies.rotor[place] = state.rotor;
    bodies.velocity[place] = state.velocity;
    bodies.angular_velocity[place] = state.angular_velocity;
    has_tree_ = false;
}

void World::Inside::set_workers(std::shared_ptr<Workers> workers) {
    workers_ = std::move(workers);
    schedule_.reset();
}

void World::Inside::wake_island(BodyId root) {
    StepMemory& memory = simulation_->memory;
    for (std::size_t i = 0; i < memory.asleep.size(); ++i) {
        if (memory.asleep[i] != root) continue;
        memory.asleep[i] = kAwake;
        if (!memory.still.empty()) memory.still[i] = 0;
    }
}

void World::Inside::wake(BodyId place) {
    StepMemory& memory = simulation_->memory;
    if (memory.asleep.empty()) return;
    if (!memory.still.empty()) memory.still[place] = 0;
    if (memory.asleep[place] != kAwake) wake_island(memory.asleep[place]);
    for (const KeptImpulses::Run& run : memory.impulses.runs()) {
        if (run.a != place && run.b != place) continue;
        const BodyId other = run.a == place ? run.b : run.a;
        if (memory.asleep[other] != kAwake) wake_island(memory.asleep[other]);
    }
}

void World::Inside::wake_all() {
    StepMemory& memory = simulation_->memory;
    std::fill(memory.asleep.begin(), memory.asleep.end(), kAwake);
    std::fill(memory.still.begin(), memory.still.end(), 0.0);
}

Wrench& World::Inside::force_on(BodyId place) {
    wake(place);
    simulation_->forces.resize(bodies_.size());
    return simulation_->forces[place];
}

void World::Inside::begin_turning() {
    if (is_turned_) return;
    begin_change();
    is_turned_ = true;
}

std::shared_ptr<const Stepper> World::Inside::stepper() {
    settle();
    return stepper_;
}

const BallTree& World::Inside::tree() {
    settle();
    if (!has_tree_) tree_ = BallTree(simulation_->bodies);
    has_tree_ = true;
    return tree_;
}

}  // namespace tesserae
