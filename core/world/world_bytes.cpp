// SPDX-License-Identifier: Apache-2.0
#include "core/world/world_bytes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dynamics/motion_version.hpp"
#include "core/error.hpp"
#include "core/world/bytes.hpp"
#include "core/world/check.hpp"

namespace tesserae {

// What is written of each type. These are found by their arguments, so not in a nameless namespace.

/// The parameters of a shape, as its room lists them.
template <class Archive, class Shaped>
requires requires { Shaped::kName; }
void archive(Archive& of, Shaped& shape) {
    // Which parameters a polychoron has depends on this one.
    if constexpr (std::is_same_v<Shaped, Polychoron>) of(shape.regular);
    shape.parameters(shape, [&](const Key&, auto& value, Rule) { archive(of, value); });
}
template <class Archive>
void archive(Archive& of, BodyType& t) {
    archive(of, t.shape);
    of(t.mass), of(t.friction), of(t.rolling_friction), of(t.restitution);
    of(t.fixed_position), of(t.fixed_rotation);
    of(t.gravity_scale), of(t.damping), of(t.group), of(t.collides_with);
}
template <class Archive>
void archive(Archive& of, PhysicsSettings& s) {
    archive(of, s.gravity);
    of(s.duration), of(s.steps_per_second), of(s.substeps), of(s.iterations), of(s.tolerance);
    of(s.integrator), of(s.sleeping), of(s.seed);
}
template <class Archive>
void archive(Archive& of, PointJoint& kind) {
    archive(of, kind.on_a), archive(of, kind.on_b);
}
template <class Archive>
void archive(Archive& of, LineJoint& kind) {
    archive(of, kind.on_a), archive(of, kind.on_b), of(kind.length);
}
template <class Archive>
void archive(Archive& of, FrameJoint& kind) {
    archive(of, kind.on_a), archive(of, kind.on_b);
    archive(of, kind.axes_a), archive(of, kind.axes_b);
}
template <class Archive>
void archive(Archive& of, JointLimit& limit) {
    of(limit.coordinate), of(limit.low), of(limit.high);
}
template <class Archive>
void archive(Archive& of, JointDrive& drive) {
    of(drive.coordinate), of(drive.target), of(drive.speed), of(drive.stiffness);
    of(drive.damping), of(drive.holds_speed), of(drive.most);
}
template <class Archive>
void archive(Archive& of, Joint& joint) {
    of(joint.a), of(joint.b), archive(of, joint.kind), of(joint.collide), of(joint.held);
    archive(of, joint.limits), archive(of, joint.drives);
    of(joint.break_force), of(joint.break_torque);
}
template <class Archive>
void archive(Archive& of, Wrench& wrench) {
    archive(of, wrench.impulse), archive(of, wrench.moment);
}
template <class Archive>
void archive(Archive& of, KeptImpulse& impulse) {
    of(impulse.a), of(impulse.b), of(impulse.feature), of(impulse.normal);
    archive(of, impulse.slope);
}
template <class Archive>
void archive(Archive& of, KeptManifold& kept) {
    of(kept.a), of(kept.b), archive(of, kept.offset), archive(of, kept.rotor);
}
template <class Archive>
void archive(Archive& of, TouchingPair& pair) {
    of(pair.a), of(pair.b);
}

namespace {

constexpr std::string_view kMagic = "tesserae world 1\n";

/// All of a world that does not follow from the rest.
struct Content {
    PhysicsSettings settings;
    Bodies bodies;
    std::vector<Joint> joints;
    std::vector<Wrench> forces;
    double time = 0;
    std::vector<KeptImpulse> impulses;
    std::vector<Bivector> angular_impulses;
    std::vector<Wrench> joint_impulses;
    std::vector<std::uint8_t> broken;
    std::vector<BodyId> asleep;
    std::vector<KeptManifold> kept;
    std::vector<double> still;
    std::vector<std::uint32_t> body_ids, joint_ids;
    std::uint32_t next_body = 0, next_joint = 0;
    bool is_turned = false;
    std::vector<TouchingPair> touched;
};
template <class Archive>
void archive(Archive& of, Content& c) {
    archive(of, c.settings);
    archive(of, c.bodies.types), archive(of, c.bodies.type);
    archive(of, c.bodies.position), archive(of, c.bodies.rotor);
    archive(of, c.bodies.velocity), archive(of, c.bodies.angular_velocity);
    archive(of, c.joints), archive(of, c.forces), of(c.time);
    archive(of, c.impulses), archive(of, c.angular_impulses), archive(of, c.joint_impulses);
    archive(of, c.broken), archive(of, c.asleep), archive(of, c.kept), archive(of, c.still);
    archive(of, c.body_ids), archive(of, c.joint_ids);
    of(c.next_body), of(c.next_joint), of(c.is_turned), archive(of, c.touched);
}

/// FNV-1a, of 64 bits: tells damage by chance.
std::uint64_t checksum_of(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char byte : bytes) hash = (hash ^ static_cast<std::uint8_t>(byte)) * 0x100000001b3;
    return hash;
}

// ---- what is believed ----------------------------------------------------------------------

[[noreturn]] void fail(std::string_view what) {
    throw InputError(fmt::format("world: the bytes are damaged: {}", what));
}
void require(bool holds, std::string_view what) {
    if (!holds) fail(what);
}

bool is_finite(const Vec4& v) { return v.allFinite(); }
bool is_finite(const Bivector& b) { return std::isfinite(dot(b, b)); }
bool is_finite(const Wrench& w) { return is_finite(w.impulse) && is_finite(w.moment); }
bool is_number(double x) { return !std::isnan(x); }

/// Positions may be farther away than a body may be placed.
void require_states(const Bodies& bodies) {
    const std::size_t count = bodies.size();
    require(bodies.position.size() == count && bodies.rotor.size() == count &&
                bodies.velocity.size() == count && bodies.angular_velocity.size() == count,
            "arrays of bodies differ in length");
    for (std::size_t i = 0; i < count; ++i) {
        require(bodies.type[i] < bodies.types.size(), "a body has no type");
        require(is_finite(bodies.position[i]) && is_finite(bodies.velocity[i]) &&
                    is_finite(bodies.angular_velocity[i]),
                "a state is not finite");
        check(BodyState{Vec4::Zero(), bodies.rotor[i], Vec4::Zero(), {}});
        if (!is_bounded(bodies.type_of(static_cast<BodyId>(i)).shape))
            require(bodies.position[i] == Vec4::Zero() && bodies.rotor[i] == Rotor{},
                    "a hyperplane is not at the origin");
    }
}

void require_joint(const Joint& joint) {
    const auto require_frame = [](const auto& kind) {
        require(is_finite(kind.on_a) && is_finite(kind.on_b), "an anchor is not finite");
        if constexpr (requires { kind.length; })
            require(kind.length >= 0 && std::isfinite(kind.length), "a length");
        if constexpr (requires { kind.axes_a; })
            for (const Rotor& axes : {kind.axes_a, kind.axes_b})
                check(BodyState{Vec4::Zero(), axes, Vec4::Zero(), {}});
    };
    std::visit(require_frame, joint.kind);
    for (const JointLimit& limit : joint.limits) require(limit.low <= limit.high, "a limit");
    for (const JointDrive& drive : joint.drives)
        require(std::isfinite(drive.target) && std::isfinite(drive.speed) && drive.stiffness >= 0 &&
                    std::isfinite(drive.stiffness) && drive.damping >= 0 &&
                    std::isfinite(drive.damping) && drive.most > 0,
                "a drive");
    require(is_number(joint.break_force) && is_number(joint.break_torque), "a breaking force");
}

void require_memory(const Content& c) {
    const std::size_t count = c.bodies.size();
    const auto is_pair = [&](const auto& of) { return of.a < of.b && of.b < count; };
    const auto key = [](const KeptImpulse& i) { return std::tuple(i.a, i.b, i.feature); };
    for (std::size_t i = 0; i < c.impulses.size(); ++i) {
        const KeptImpulse& impulse = c.impulses[i];
        const bool is_in_order = i == 0 || key(c.impulses[i - 1]) < key(impulse);
        const bool is_impulse = impulse.normal > 0 && std::isfinite(impulse.normal) &&
                                std::all_of(impulse.slope.begin(), impulse.slope.end(),
                                            [](float part) { return std::isfinite(part); });
        require(is_pair(impulse) && is_in_order && is_impulse, "an impulse");
    }
    const auto all = [](const auto& list) {
        return std::all_of(list.begin(), list.end(), [](const auto& x) { return is_finite(x); });
    };
    const auto has = [](const auto& list, std::size_t size) {
        return list.empty() || list.size() == size;
    };
    require(has(c.angular_impulses, c.impulses.size()) && all(c.angular_impulses), "impulses");
    require(all(c.joint_impulses) && has(c.broken, c.joints.size()), "joints");
    require(has(c.forces, count) && all(c.forces), "forces");
    require(has(c.asleep, count) && has(c.still, count), "sleeping bodies");
    require(c.settings.sleeping || (c.asleep.empty() && c.still.empty()), "sleeping bodies");
    for (const BodyId root : c.asleep)
        require(root == kAwake || (root < count && c.asleep[root] == root), "a sleeping body");
    for (const double time : c.still) require(time >= 0, "a time of rest");
    for (std::size_t i = 0; i < c.kept.size(); ++i) {
        const KeptManifold& kept = c.kept[i];
        const bool is_in_order =
            i == 0 || std::pair(c.kept[i - 1].a, c.kept[i - 1].b) < std::pair(kept.a, kept.b);
        require(is_pair(kept) && is_in_order && is_finite(Vec4(kept.offset)), "a manifold");
        check(BodyState{Vec4::Zero(), kept.rotor, Vec4::Zero(), {}});
    }
    require(std::isfinite(c.time) && c.time >= 0, "a time");
}

void require_numbers(const std::vector<std::uint32_t>& used, std::uint32_t next,
                     std::size_t count) {
    require(used.size() == count, "numbers");
    require(std::adjacent_find(used.begin(), used.end(), std::greater_equal()) == used.end() &&
                (used.empty() || used.back() < next),
            "numbers are not ascending");
}

void make_sound(Content& c) {
    check(c.settings);
    for (BodyType& type : c.bodies.types) {
        check(type);
        make_complete(type.shape);
    }
    require_states(c.bodies);
    for (const Joint& joint : c.joints) require_joint(joint);
    require_memory(c);
    require_numbers(c.body_ids, c.next_body, c.bodies.size());
    require_numbers(c.joint_ids, c.next_joint, c.joints.size());
    require(std::adjacent_find(c.touched.begin(), c.touched.end(), std::greater_equal()) ==
                c.touched.end(),
            "touching pairs");
}

StepMemory memory_of(const Content& c) {
    StepMemory memory;
    for (const KeptImpulse& impulse : c.impulses) memory.impulses.push_back(impulse);
    memory.angular_impulses = c.angular_impulses;
    memory.joint_impulses = c.joint_impulses;
    memory.broken = c.broken;
    memory.asleep = c.asleep;
    memory.still = c.still;
    memory.time = c.time;
    if (c.kept.empty()) return memory;
    KeptManifolds& list = memory.kept.emplace_back();
    for (const KeptManifold& kept : c.kept) list.push_back(std::make_shared<KeptManifold>(kept));
    return memory;
}

}  // namespace

std::string WorldBytes::write(World::Inside& inside) {
    inside.settle();
    const Simulation& simulation = inside.simulation();
    const StepMemory& memory = simulation.memory;
    Content c;
    c.settings = simulation.settings, c.bodies = simulation.bodies;
    c.joints = simulation.joints.all, c.forces = simulation.forces, c.time = memory.time;
    for (const KeptImpulse& impulse : memory.impulses) c.impulses.push_back(impulse);
    c.angular_impulses = memory.angular_impulses, c.joint_impulses = memory.joint_impulses;
    c.broken = memory.broken, c.asleep = memory.asleep, c.still = memory.still;
    for (const KeptManifolds& list : memory.kept)
        for (const auto& kept : list) c.kept.push_back(*kept);
    c.body_ids = inside.bodies_.used(), c.next_body = inside.bodies_.next();
    c.joint_ids = inside.joints_.used(), c.next_joint = inside.joints_.next();
    c.is_turned = inside.is_turned_, c.touched = inside.touched_;

    std::string bytes(kMagic);
    ByteWriter writer(bytes);
    writer(kMotionVersion);
    archive(writer, c);
    writer(checksum_of(bytes));
    return bytes;
}

std::unique_ptr<World::Inside> WorldBytes::read(std::string_view bytes,
                                                std::shared_ptr<Workers> workers) {
    if (!bytes.starts_with(kMagic))
        throw InputError("world: these are not the bytes of a saved world");
    std::uint64_t checksum = 0;
    if (bytes.size() < kMagic.size() + sizeof checksum) fail("they end too early");
    const std::string_view body = bytes.substr(0, bytes.size() - sizeof checksum);
    ByteReader(bytes.substr(body.size()))(checksum);
    require(checksum == checksum_of(body), "their checksum is another");
    ByteReader reader(body.substr(kMagic.size()));
    int version = 0;
    reader(version);
    if (version != kMotionVersion)
        throw InputError(
            fmt::format("world: was saved by motion version {}; this is version {}, "
                        "which moves bodies otherwise",
                        version, kMotionVersion));
    Content c;
    archive(reader, c);
    require(reader.is_at_end(), "there are more");
    make_sound(c);

    Simulation simulation;
    simulation.bodies = std::move(c.bodies);
    simulation.settings = c.settings;
    simulation.joints.all = std::move(c.joints);
    simulation.forces = std::move(c.forces);
    simulation.memory = memory_of(c);
    auto inside = std::make_unique<World::Inside>(std::move(simulation), std::move(workers));
    inside->bodies_ = Numbers(std::move(c.body_ids), c.next_body);
    inside->joints_ = Numbers(std::move(c.joint_ids), c.next_joint);
    inside->is_turned_ = c.is_turned;
    inside->touched_ = std::move(c.touched);
    inside->is_stale_ = true;
    inside->settle();
    const Simulation& made = inside->simulation();
    require(made.memory.joint_impulses.size() <= made.joints.parts(), "impulses of joints");
    require(
        !made.needs.rolling || made.memory.angular_impulses.size() == made.memory.impulses.size(),
        "impulses of rolling");
    return inside;
}

std::string World::save() const { return WorldBytes::write(*inside_); }

World World::load(std::string_view bytes, std::shared_ptr<Workers> workers) {
    return World(WorldBytes::read(bytes, std::move(workers)));
}

}  // namespace tesserae
