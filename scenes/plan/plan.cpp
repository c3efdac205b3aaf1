#include "scenes/plan/plan.hpp"

#include <algorithm>

#include "core/dynamics/stages/islands.hpp"
#include "core/dynamics/state/needs.hpp"
#include "core/error.hpp"
#include "render/scene/frame_scene.hpp"
#include "scenes/plan/plan_picture.hpp"
#include "scenes/process/memory.hpp"
#include "scenes/timeline.hpp"
#include "scenes/trajectory/trajectory.hpp"

namespace tesserae::scenes {
namespace {

/// Bytes of one body's position, rotor, velocity, angular velocity in memory and in a stored step.
constexpr std::uint64_t kStateBytes = (4 + 8 + 4 + 6) * sizeof(double);
/// States alive at once: the scene's, the world's before and after a step, two stored steps between
/// which a frame lies, and the frame's.
constexpr std::uint64_t kStates = 6;
/// Of a step, for a movable body: bounds, pairs, contacts and rows, with what the lists have spare.
/// Measured in piles of 10^4: a sphere with its 3 contact points, a box with 16 (bench, peers).
constexpr std::uint64_t kSphereStepBytes = 4'000, kStepBytes = 14'000;
/// A body's bounds in the picture's hierarchy and lists.
constexpr std::uint64_t kPictureBytes = 300;
/// The program, its libraries and their buffers.
constexpr std::uint64_t kProgramBytes = 100'000'000;
/// A pixel of a tile in flight, all channels, before and after compression.
constexpr std::uint64_t kPixelBytes = 200;

bool any_motion(const Scene& scene) {
    if (!scene.physics || scene.physics->duration == 0) return false;
    const Bodies& bodies = scene.bodies;
    const bool falls = !scene.physics->gravity.isZero(0);
    for (BodyId id = 0; id < bodies.size(); ++id) {
        const BodyType& type = bodies.type_of(id);
        if (!is_bounded(type.shape)) continue;
        if ((falls && !type.fixed_position) || !bodies.velocity[id].isZero(0) ||
            !(bodies.angular_velocity[id] == Bivector{}))
            return true;
        // Overlapping bodies push each other apart even without gravity.
        if (bodies.is_movable(id) && bodies.size() > 1) return true;
    }
    return false;
}

/// What the solver does beyond its simplest: one sub-step a step, no relaxation, no sleeping.
void decide_solver(const Scene& scene, const Needs& needs, bool fits_floats, Plan& plan) {
    const PhysicsSettings& physics = *scene.physics;
    if (plan.movable_bodies == 0) {
        plan.decisions.push_back({"contacts", false, "no body can be moved by them"});
        return;
    }
    plan.decisions.push_back(
        {"friction", needs.friction,
         needs.friction ? "contacts have tangent rows"
                        : "friction = 0 of all that moves: contacts have no tangent rows"});
    plan.decisions.push_back({"restitution", needs.restitution,
                              needs.restitution ? "contacts may rebound"
                                                : "restitution = 0 everywhere: nothing rebounds"});
    plan.decisions.push_back(
        {"islands in colours", fits_floats,
         fits_floats ? fmt::format("islands of {} contacts or more, eight contacts at a time in "
                                   "float; smaller ones one by one",
                                   kColouredFrom)
                     : "masses or sizes are too far apart for float: contacts one by one"});
    plan.decisions.push_back(
        {"sub-steps", physics.substeps > 1,
         fmt::format("{} a step, {} iterations each", physics.substeps, physics.iterations)});
    const bool soft = physics.solver == Solver::kSoft;
    plan.decisions.push_back(
        {"relaxation of soft contacts", soft,
         soft ? "solver = \"soft\": velocity that only removes overlap is given back"
              : "solver = \"impulse\""});
    plan.decisions.push_back(
        {"sleeping", physics.sleeping,
         physics.sleeping ? "islands at rest are left out until touched" : "sleeping = false"});
}

void decide_physics(const Scene& scene, Plan& plan) {
    if (!scene.physics)
        plan.decisions.push_back({"physics", false, "the scene has no [physics] table: a still"});
    else if (!plan.moves)
        plan.decisions.push_back({"physics", false, "nothing can move: every frame shows time 0"});
    else
        plan.decisions.push_back({"physics", true,
                                  fmt::format("{} of {} bodies can be moved by contacts",
                                              plan.movable_bodies, plan.bodies)});
    if (!plan.moves) return;
    const std::vector<TypeProperties> types = type_properties(scene.bodies);
    const Needs needs = needs_of(scene.bodies, types);
    plan.decisions.push_back(
        {"rotors and angular velocities", needs.turning,
         needs.turning ? "bodies turn, or contacts can turn them"
                       : "nothing turns at the start, and no contact turns a sphere without "
                         "friction or what has a fixed rotation"});
    const char* inertia = "there are bodies whose inertia depends on the direction";
    if (!needs.turning)
        inertia = "nothing turns";
    else if (!needs.uneven_inertia)
        inertia = "what turns are spheres and cubes: their inertia is one number";
    plan.decisions.push_back({"gyroscopic term and 6x6 inertia", needs.uneven_inertia, inertia});
    decide_solver(scene, needs, fit_floats(types), plan);
}

}  // namespace

Plan make_plan(const Scene& scene, int threads) {
    Plan plan;
    plan.bodies = scene.bodies.size();
    const auto can_move = [&](std::uint32_t type) { return is_movable(scene.bodies.types[type]); };
    plan.movable_bodies = count_if_type(scene.bodies, can_move);
    plan.moves = any_motion(scene);
    plan.steps = step_count(scene);
    plan.frames = frame_count(scene);

    const render::Settings& r = scene.render;
    const render::Crop crop = r.window();
    const auto pixels = static_cast<std::uint64_t>(crop.x1 - crop.x0) * (crop.y1 - crop.y0);
    // With several samples a pixel's centre has a ray of its own, for depth, normal and id.
    const auto samples = static_cast<std::uint64_t>(r.most_samples());
    const std::uint64_t rays = samples == 1 ? 1 : samples + 1;
    plan.view_rays = pixels * rays * plan.frames;
    const auto tile = static_cast<std::uint64_t>(r.tile) * r.tile;
    const std::uint64_t movable_spheres = count_if_type(scene.bodies, [&](std::uint32_t type) {
        return can_move(type) &&
               std::holds_alternative<Hypersphere>(scene.bodies.types[type].shape);
    });
    plan.memory_bytes =
        kProgramBytes + scene.source.size() + scene.effective.size() +
        plan.bodies * (kStates * kStateBytes + kPictureBytes) + movable_spheres * kSphereStepBytes +
        (plan.movable_bodies - movable_spheres) * kStepBytes + 4 * threads * tile * kPixelBytes;
    if (scene.camera.shutter > 0)
        plan.memory_bytes += kPictureBytes * plan.bodies *
                             render::most_instants(plan.bodies, static_cast<int>(samples));
    if (plan.moves)
        plan.trajectory_bytes =
            plan.bodies * (2 * plan.frames * kStateBytes +
                           description_bytes({scene.bodies.types, scene.bodies.type, scene.names}));

    decide_physics(scene, plan);
    decide_picture(scene, plan);
    return plan;
}

void require_memory(const Plan& plan, const Scene& scene) {
    const std::uint64_t available = available_memory();
    if (plan.memory_bytes > available)
        throw InputError(
            fmt::format("{}: needs about {:.1f} GB of memory for {} bodies, {:.1f} GB are free: "
                        "use fewer bodies "
                        "or a larger machine",
                        scene.file.string(), 1e-9 * static_cast<double>(plan.memory_bytes),
                        plan.bodies, 1e-9 * static_cast<double>(available)));
}

}  // namespace tesserae::scenes
