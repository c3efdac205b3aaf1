// SPDX-License-Identifier: Apache-2.0
#include "scenes/plan/plan.hpp"

#include <algorithm>
#include <concepts>
#include <unordered_set>
#include <vector>

#include "core/dynamics/bodies/needs.hpp"
#include "core/dynamics/islands/islands.hpp"
#include "core/error.hpp"
#include "render/file/preview.hpp"
#include "render/picture_needs.hpp"
#include "render/tile/frame_scene.hpp"
#include "scenes/plan/plan_picture.hpp"
#include "scenes/process/memory.hpp"
#include "scenes/timeline.hpp"
#include "scenes/trajectory/joint_datasets.hpp"
#include "scenes/trajectory/trajectory.hpp"

namespace tesserae::scenes {
namespace {

/// Of a pixel of a preview: its sums, and its code.
constexpr std::uint64_t kPreviewBytes = sizeof(render::Preview::Sum) + 4;
/// Bytes of one body's position, rotor, velocity, angular velocity in memory and in a stored step.
constexpr std::uint64_t kStateBytes = (4 + 8 + 4 + 6) * sizeof(double);
/// States alive at once: while simulating the scene's, where the world begins, and its two about a
/// step; while rendering the scene's, two stored steps between which a frame lies, and the frame's,
/// with what reading takes.
constexpr std::uint64_t kSimulateStates = 4, kRenderStates = 6;
/// Of a step, for a movable body: bounds, pairs, contacts and rows, and what a checkpoint copies.
/// Measured: a sphere of a pile of 10^4, a box with 16 contact points (tesserae simulate).
constexpr std::uint64_t kSphereStepBytes = 1'900, kStepBytes = 7'000;
/// Of these in a checkpoint: impulses, and a box's manifolds.
constexpr std::uint64_t kSphereCheckpointBytes = 120, kCheckpointBytes = 1'200;
/// A body's bounds in the picture's hierarchy and lists.
constexpr std::uint64_t kPictureBytes = 300;
/// How a body moves between two stored steps inside an open shutter.
constexpr std::uint64_t kMotionBytes = 256;
/// The program, its libraries and their buffers, while it renders and while it simulates.
constexpr std::uint64_t kRenderProgramBytes = 100'000'000, kSimulateProgramBytes = 25'000'000;
/// A pixel of a tile in flight, all channels, before and after compression.
constexpr std::uint64_t kPixelBytes = 200;
/// The same of its further layers, and of its Cryptomattes.
constexpr std::uint64_t kLayerBytes = 100, kMatteBytes = 200;
/// Of a ghost beside one slice, with its bounds in a hierarchy.
constexpr std::uint64_t kGhostBytes = 350;
/// Of a body, with its name and what says so in a header.
constexpr std::uint64_t kMatteNameBytes = 200;
/// More states for vectors of motion: the neighbours of a frame and of the one before it.
constexpr std::uint64_t kNeighbourStates = 4;
/// Tiles of a thread in memory: of large ones two are under way (tiles_in_flight,
/// render/frame.cpp), each in the renderer's and the writer's form; of small ones more are, which
/// weigh little.
constexpr std::uint64_t kTilesOfThread = 4;

bool any_motion(const Scene& scene) {
    if (!scene.physics || scene.physics->duration == 0) return false;
    const Bodies& bodies = scene.bodies;
    const bool falls = !scene.physics->gravity.isZero(0);
    const bool is_driven = std::any_of(scene.joints.begin(), scene.joints.end(),
                                       [](const Joint& joint) { return !joint.drives.empty(); });
    for (BodyId id = 0; id < bodies.size(); ++id) {
        const BodyType& type = bodies.type_of(id);
        if (!is_bounded(type.shape)) continue;
        if ((falls && !type.fixed_position && type.gravity_scale != 0) ||
            !bodies.velocity[id].isZero(0) || !(bodies.angular_velocity[id] == Bivector{}))
            return true;
        // Even without gravity, overlapping bodies push each other apart, and springs pull.
        if (bodies.is_movable(id) && (bodies.size() > 1 || is_driven)) return true;
    }
    return false;
}

bool any_fits_floats(const std::vector<TypeProperties>& types) {
    return std::any_of(types.begin(), types.end(),
                       [](const TypeProperties& type) { return type.movable && type.fits_floats; });
}

/// What the solver does beyond its simplest: one sub-step a step, no sleeping.
void decide_solver(const PhysicsSettings& physics, const Needs& needs, bool fits_floats,
                   Plan& plan) {
    plan.decide("friction", needs.friction, "contacts have tangent rows",
                "friction = 0 of all that moves: contacts have no tangent rows");
    plan.decide("rolling friction", needs.rolling, "contacts resist rolling and twisting",
                "no rolling_friction at contacts with friction of what can turn");
    plan.decide("restitution", needs.restitution, "contacts may rebound",
                "restitution = 0 everywhere: nothing rebounds");
    plan.decide("seams", needs.internal_edges, "flush faces of several bodies are gone over as one",
                "no hyperboxes: no body has faces that could be flush");
    plan.decide("islands in colours", fits_floats,
                fmt::format("islands of {} contacts or more, eight contacts at a time in float; "
                            "smaller ones one by one",
                            kColouredFrom),
                "no body's size fits in floats: contacts one by one");
    const std::string until = physics.tolerance > 0
                                  ? fmt::format("at most {} sweeps a solve, until {} m/s are left",
                                                physics.iterations, physics.tolerance)
                                  : fmt::format("{} sweeps a solve", physics.iterations);
    const std::string substeps = fmt::format("{} a step, {}", physics.substeps, until);
    plan.decide("sub-steps", physics.substeps > 1, substeps, substeps);
    plan.decide("sleeping", physics.sleeping, "islands at rest are left out until touched",
                "sleeping = false");
}

void decide_physics(const Scene& scene, Plan& plan) {
    plan.decide(
        "physics", plan.moves,
        fmt::format("{} of {} bodies can be moved by contacts", plan.movable_bodies, plan.bodies),
        scene.physics ? "nothing can move: every frame shows time 0"
                      : "the scene has no [physics] table: a still");
    if (!plan.moves) return;
    if (plan.joints > 0)
        plan.decide("joints", true, fmt::format("{} between bodies, or the world", plan.joints));
    const std::vector<TypeProperties> types = type_properties(scene.bodies);
    const Needs needs = needs_of(scene.bodies, types);
    plan.decide("rotors and angular velocities", needs.turning,
                "bodies turn, or contacts can turn them",
                "nothing turns at the start, and no contact turns a sphere without friction or "
                "what has a fixed rotation");
    plan.decide("gyroscopic term and 6x6 inertia", needs.uneven_inertia,
                "there are bodies whose inertia depends on the direction",
                needs.turning ? "what turns has one number for its inertia, as spheres and cubes"
                              : "nothing turns");
    if (plan.movable_bodies == 0)
        plan.decide("contacts", false, "", "no body can be moved by them");
    else
        decide_solver(*scene.physics, needs, any_fits_floats(types), plan);
}

/// What hulls take, of which equal shapes share one.
std::uint64_t hull_bytes(const std::vector<BodyType>& types) {
    std::unordered_set<const HullBody*> counted;
    std::uint64_t bytes = 0;
    for (const BodyType& type : types)
        std::visit(
            [&]<class S>(const S& shape) {
                if constexpr (std::derived_from<S, HullShape>)
                    if (counted.insert(shape.body.get()).second) bytes += shared_bytes(shape);
            },
            type.shape);
    return bytes;
}

std::uint64_t movable_spheres(const Scene& scene) {
    return count_if_type(scene.bodies, [&](std::uint32_t number) {
        const BodyType& type = scene.bodies.types[number];
        return is_movable(type) && std::holds_alternative<Hypersphere>(type.shape);
    });
}

std::uint64_t memory_to_simulate(const Scene& scene, const Plan& plan) {
    const std::uint64_t spheres = movable_spheres(scene);
    return kSimulateProgramBytes + plan.bodies * kSimulateStates * kStateBytes +
           spheres * kSphereStepBytes + (plan.movable_bodies - spheres) * kStepBytes;
}

std::uint64_t memory_to_render(const Scene& scene, const Plan& plan, int threads) {
    const auto tile = static_cast<std::uint64_t>(scene.render.tile) * scene.render.tile;
    std::uint64_t bytes = kRenderProgramBytes +
                          plan.bodies * (kRenderStates * kStateBytes + kPictureBytes) +
                          kTilesOfThread * threads * tile * kPixelBytes;
    const render::PreviewSize preview =
        render::preview_size_of(scene.render, scene.render.window());
    bytes += static_cast<std::uint64_t>(preview.width) * preview.height * kPreviewBytes;
    const render::Channels& channels = scene.render.channels;
    if (scene.render.has_layers()) bytes += kTilesOfThread * threads * tile * kLayerBytes;
    if (scene.render.has_ghosts())
        bytes += plan.bodies * static_cast<std::uint64_t>(scene.camera.slices) * kGhostBytes;
    if (channels.cryptomatte)
        bytes += kTilesOfThread * threads * tile * kMatteBytes + plan.bodies * kMatteNameBytes;
    if (channels.motion) bytes += plan.bodies * kNeighbourStates * kStateBytes;
    if (scene.camera.shutter > 0)
        bytes +=
            plan.bodies * (kPictureBytes * render::most_intervals(plan.bodies) +
                           (kStateBytes + kMotionBytes) * (1 + shutter_steps(scene, 0).size()));
    return bytes;
}

/// Of the steps of the first frames of a scene.
std::uint64_t trajectory_bytes(const Scene& scene, const Plan& plan, int frames) {
    if (!plan.moves) return 0;
    // A frame lies between two stored steps, its shutter over some more.
    const std::uint64_t rows =
        (2 + shutter_steps(scene, 0).size()) * static_cast<std::uint64_t>(frames);
    return rows * (plan.bodies * kStateBytes + plan.joints * kJointRowBytes) +
           plan.bodies * description_bytes({scene.bodies.types, scene.bodies.type, scene.names});
}

std::string memory_text(std::uint64_t bytes) {
    const double megabytes = 1e-6 * static_cast<double>(bytes);
    return megabytes < 1000 ? fmt::format("{:.1f} MB", megabytes)
                            : fmt::format("{:.3f} GB", 1e-3 * megabytes);
}

}  // namespace

Plan make_plan(const Scene& scene, int threads) {
    Plan plan;
    plan.warnings = scene.unused;
    plan.bodies = scene.bodies.size();
    const auto can_move = [&](std::uint32_t type) { return is_movable(scene.bodies.types[type]); };
    plan.movable_bodies = count_if_type(scene.bodies, can_move);
    plan.joints = scene.joints.size();
    plan.moves = any_motion(scene);
    plan.steps = step_count(scene);
    plan.frames = frame_count(scene);

    const render::Settings& r = scene.render;
    const render::Crop crop = r.window();
    const auto pixels = static_cast<std::uint64_t>(crop.x1 - crop.x0) * (crop.y1 - crop.y0);
    plan.view_rays = pixels * render::most_view_rays(r) * plan.frames;
    // One after the other.
    plan.memory_bytes = std::max(plan.moves ? memory_to_simulate(scene, plan) : 0,
                                 memory_to_render(scene, plan, threads)) +
                        hull_bytes(scene.bodies.types) + scene.source.size() +
                        scene.effective.size();
    const std::uint64_t spheres = movable_spheres(scene);
    if (plan.moves)
        plan.checkpoint_bytes =
            spheres * kSphereCheckpointBytes + (plan.movable_bodies - spheres) * kCheckpointBytes;
    plan.trajectory_bytes = trajectory_bytes(scene, plan, plan.frames);

    decide_physics(scene, plan);
    decide_picture(scene, plan);
    return plan;
}

void narrow_to(Plan& plan, const Scene& scene, const std::vector<int>& frames) {
    plan.view_rays = plan.view_rays / static_cast<std::uint64_t>(plan.frames) * frames.size();
    plan.trajectory_bytes = trajectory_bytes(scene, plan, frames.back() + 1);
}

void require_memory(const Plan& plan, const Scene& scene) {
    const std::uint64_t available = available_memory();
    if (plan.memory_bytes > available)
        throw InputError(
            fmt::format("{}: needs about {} of memory for {} bodies, {} are free: use fewer bodies "
                        "or a larger machine",
                        scene.file.string(), memory_text(plan.memory_bytes), plan.bodies,
                        memory_text(available)));
}

}  // namespace tesserae::scenes
