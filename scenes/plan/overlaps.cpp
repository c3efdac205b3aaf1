// SPDX-License-Identifier: Apache-2.0
#include "scenes/plan/overlaps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "core/contact/find_contacts.hpp"
#include "core/dynamics/step/step.hpp"
#include "parallel/sort_and_sweep.hpp"

namespace tesserae::scenes {
namespace {

/// Less than this many times the overlap that the solver allows is meant to touch.
constexpr double kDeep = 2;
constexpr std::size_t kMostWarnings = 5;

struct Overlap {
    double depth;  ///< [m]
    BodyId a, b;
};

std::vector<Bounds> bounds_of(const Simulation& simulation) {
    std::vector<Bounds> bounds(simulation.bodies.size());
    for (BodyId id = 0; id < bounds.size(); ++id) {
        const TypeProperties& type = simulation.type_of(id);
        if (type.bounded)
            bounds[id] = {simulation.bodies.position[id], type.radius};
        else
            bounds[id] = {Vec4::Zero(), std::numeric_limits<double>::infinity()};
    }
    return bounds;
}

/// How deep two bodies are in each other [m]; 0: they are not.
double depth_of(const Bodies& bodies, BodyId a, BodyId b, std::vector<Contact>& contacts) {
    contacts.clear();
    const auto pose = [&](BodyId id) { return Pose{bodies.position[id], bodies.rotor[id]}; };
    find_contacts(a, bodies.type_of(a).shape, pose(a), b, bodies.type_of(b).shape, pose(b), 0,
                  contacts);
    double depth = 0;
    for (const Contact& contact : contacts) depth = std::max(depth, -contact.separation);
    return depth;
}

/// Whether a joint keeps two bodies from having contacts.
bool is_apart(const Joints& joints, BodyId a, BodyId b) {
    const std::pair<BodyId, BodyId> pair = std::minmax(a, b);
    return std::binary_search(joints.apart.begin(), joints.apart.end(), pair);
}

std::string name_at(const Scene& scene, BodyId id) {
    const auto run = std::prev(
        std::upper_bound(scene.names.begin(), scene.names.end(), id,
                         [](BodyId i, const NamedBodies& named) { return i < named.first; }));
    return run->is_lattice ? fmt::format("\"{}.{}\"", run->name, id - run->first)
                           : fmt::format("\"{}\"", run->name);
}

}  // namespace

std::vector<std::string> overlap_warnings(const Scene& scene) {
    std::vector<std::string> warnings;
    if (!scene.physics || scene.physics->duration == 0) return warnings;
    const Simulation simulation = make_simulation(scene.bodies, *scene.physics, scene.joints);
    parallel::PairTable pairs;
    parallel::SortAndSweep().overlapping_pairs(simulation, bounds_of(simulation), pairs);

    std::vector<Overlap> overlaps;
    std::vector<Contact> contacts;
    pairs.for_each({0, pairs.size()}, [&](BodyId a, BodyId b) {
        if (is_apart(simulation.joints, a, b)) return;
        const TypeProperties &type_a = simulation.type_of(a), &type_b = simulation.type_of(b);
        if (type_a.inverse_mass == 0 && type_b.inverse_mass == 0) return;
        const double depth = depth_of(simulation.bodies, a, b, contacts);
        const double allowed = std::min(type_a.slop, type_b.slop);
        if (depth > kDeep * allowed) overlaps.push_back({depth, a, b});
    });
    std::stable_sort(overlaps.begin(), overlaps.end(),
                     [](const Overlap& a, const Overlap& b) { return a.depth > b.depth; });
    const std::size_t shown = std::min(kMostWarnings, overlaps.size());
    for (std::size_t i = 0; i < shown; ++i)
        warnings.push_back(fmt::format(
            "{} and {} start inside each other by {:.3g} m: they will be pushed apart",
            name_at(scene, overlaps[i].a), name_at(scene, overlaps[i].b), overlaps[i].depth));
    if (shown < overlaps.size())
        warnings.push_back(
            fmt::format("{} pairs more start inside each other", overlaps.size() - shown));
    return warnings;
}

}  // namespace tesserae::scenes
