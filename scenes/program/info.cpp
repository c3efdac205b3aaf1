// SPDX-License-Identifier: Apache-2.0
#include "scenes/program/info.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <set>

#include "core/error.hpp"
#include "render/file/image_info.hpp"
#include "render/file/whole_image.hpp"
#include "scenes/compare/file_kind.hpp"
#include "scenes/load/load.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/trajectory/trajectory.hpp"

namespace tesserae::scenes {
namespace {

using Facts = std::vector<Fact>;
using Json = nlohmann::ordered_json;

/// A number, or its name where JSON has none for it.
Json json_number(double value) {
    if (std::isfinite(value)) return value;
    if (std::isnan(value)) return "nan";
    return value > 0 ? "inf" : "-inf";
}

Fact text(const char* name, const std::string& value) { return {name, value, value}; }

/// A whole number.
template <class Number>
Fact count(const char* name, Number value) {
    return {name, value, fmt::format("{}", value)};
}

/// How many vertices, edges, faces and cells a hull has.
std::array<std::size_t, 4> counts_of(const Hull& hull) {
    std::set<std::array<std::uint16_t, 2>> edges;
    std::size_t sides = 0;
    for (const HullCell& cell : hull.cells) {
        sides += cell.sides.size();
        for (const auto& edge : cell.edges) {
            const auto [first, second] =
                std::minmax(cell.vertices[edge[0]], cell.vertices[edge[1]]);
            edges.insert({first, second});
        }
    }
    // Every face is a side of two cells.
    return {hull.vertices.size(), edges.size(), sides / 2, hull.cells.size()};
}

/// The hulls of a scene, each with the first body that has it: points typed with a few digits may
/// have more cells than they should.
void append_hulls(Facts& facts, const Scene& scene) {
    constexpr std::size_t kMostShown = 20;
    std::set<const Hull*> known;
    Json list = Json::array();
    std::string shown;
    for (const NamedBodies& named : scene.names)
        std::visit(
            [&]<class S>(const S& shape) {
                if constexpr (std::derived_from<S, HullShape>) {
                    if (!known.insert(&shape.body->hull).second) return;
                    const auto [v, e, f, c] = counts_of(shape.body->hull);
                    list.push_back({{"body", named.name},
                                    {"vertices", v},
                                    {"edges", e},
                                    {"faces", f},
                                    {"cells", c}});
                    if (known.size() > kMostShown) return;
                    shown += fmt::format("{}{}: {} vertices, {} edges, {} faces, {} cells",
                                         shown.empty() ? "" : "; ", named.name, v, e, f, c);
                }
            },
            scene.bodies.type_of(named.first).shape);
    if (known.empty()) return;
    if (known.size() > kMostShown) shown += fmt::format("; and {} more", known.size() - kMostShown);
    facts.push_back({"hulls", list, shown});
}

Facts scene_facts(const std::filesystem::path& file, int threads) {
    const Scene scene = load_scene(file, {});
    const Plan plan = make_plan(scene, threads);
    const auto [width, height] = std::pair(scene.render.width, scene.render.height);
    Facts facts = {text("kind", "scene"),
                   text("name", scene.name),
                   text("hash", scene.hash),
                   text("motion hash", scene.motion_hash),
                   count("bodies", plan.bodies),
                   count("movable bodies", plan.movable_bodies),
                   count("joints", scene.joints.size()),
                   count("materials", scene.materials.size()),
                   count("suns", scene.lights.suns.size()),
                   count("point lights", scene.lights.points.size()),
                   count("sphere lights", scene.lights.spheres.size()),
                   count("steps", plan.steps),
                   count("frames", plan.frames),
                   {"size", {width, height}, fmt::format("{}x{}", width, height)},
                   count("samples", scene.render.samples)};
    append_hulls(facts, scene);
    return facts;
}

double energy_of(const StepFacts& row) { return row.kinetic_energy + row.potential_energy; }

Fact energy(const char* name, const StepFacts& row) {
    return {name,
            {{"value", json_number(energy_of(row))},
             {"unit", "J"},
             {"kinetic", json_number(row.kinetic_energy)},
             {"potential", json_number(row.potential_energy)}},
            fmt::format("{:.9g} J: {:.6g} kinetic, {:.6g} potential", energy_of(row),
                        row.kinetic_energy, row.potential_energy)};
}

/// The largest value of a function of the rows, and the step where it is first reached.
template <class Value>
Fact largest(const char* name, const std::vector<StepFacts>& rows, Value&& value,
             const char* unit) {
    const auto at = std::max_element(rows.begin(), rows.end(), [&](const auto& a, const auto& b) {
        return value(a) < value(b);
    });
    return {name,
            {{"value", json_number(value(*at))}, {"unit", unit}, {"step", at->step}},
            fmt::format("{:.3g} {} at step {}", value(*at), unit, at->step)};
}

/// How far the stored steps are from what an exact motion would keep. Gravity and bodies that move
/// at a given velocity change energy and momentum too.
void append_diagnostics(Facts& facts, const std::vector<StepFacts>& rows) {
    const StepFacts &first = rows.front(), &last = rows.back();
    const auto energy_change = [&](const StepFacts& row) {
        return std::abs(energy_of(row) - energy_of(first));
    };
    const auto momentum_change = [&](const StepFacts& row) {
        return (row.momentum - first.momentum).norm();
    };
    const auto angular_change = [&](const StepFacts& row) {
        return norm(row.angular_momentum - first.angular_momentum);
    };
    const auto penetration = [](const StepFacts& row) { return row.report.penetration; };
    const auto mean = [](const StepFacts& row) { return row.report.mean_penetration; };
    const auto residual = [](const StepFacts& row) { return row.report.residual; };
    std::uint64_t sweeps = 0;
    for (const StepFacts& row : rows) sweeps = std::max(sweeps, row.report.sweeps);
    facts.insert(facts.end(), {count("last step", last.step),
                               {"last time",
                                {{"value", json_number(last.time)}, {"unit", "s"}},
                                fmt::format("{} s", last.time)},
                               energy("energy, first row", first),
                               energy("energy, last row", last),
                               largest("largest energy change", rows, energy_change, "J"),
                               largest("momentum change", rows, momentum_change, "kg m/s"),
                               largest("angular momentum change", rows, angular_change, "kg m^2/s"),
                               count("contacts, last row", last.report.contacts),
                               {"asleep, last row", last.report.asleep,
                                fmt::format("{} bodies", last.report.asleep)},
                               largest("deepest penetration", rows, penetration, "m"),
                               largest("largest mean penetration", rows, mean, "m"),
                               largest("largest solver residual", rows, residual, "m/s"),
                               count("most solver sweeps", sweeps)});
}

Facts trajectory_facts(const std::filesystem::path& file) {
    const TrajectoryReader trajectory(file);
    const TrajectoryHeader& header = trajectory.header();
    Facts facts = {text("kind", "trajectory"),
                   text("scene", header.scene_name),
                   text("motion hash", header.motion_hash),
                   count("motion version", header.motion_version),
                   text("written by", "tesserae " + header.program_version),
                   count("bodies", header.bodies),
                   count("joints", header.joints.size()),
                   {"steps per second", json_number(header.steps_per_second),
                    fmt::format("{}", header.steps_per_second)},
                   count("rows", trajectory.rows())};
    if (trajectory.rows() == 0) return facts;
    if (header.last_step) {
        const std::uint64_t last = trajectory.steps().back();
        const bool ends_early = last < *header.last_step;
        facts.push_back({"complete", !ends_early,
                         ends_early
                             ? fmt::format("no: ends at step {} of {}; the command that made "
                                           "it, without --frames, continues it",
                                           last, *header.last_step)
                             : "yes"});
    }
    append_diagnostics(facts, trajectory.facts());
    if (!header.joints.empty()) {
        const auto broken = trajectory.joints(trajectory.rows() - 1).broken;
        facts.push_back(count("broken joints, last row",
                              std::ssize(broken) - std::ranges::count(broken, std::uint8_t{0})));
    }
    return facts;
}

Json json_of(const render::ImageAttribute& attribute) {
    if (const auto* real = std::get_if<double>(&attribute.value)) return json_number(*real);
    if (const auto* reals = std::get_if<std::vector<double>>(&attribute.value)) {
        Json list = Json::array();
        for (double real : *reals) list.push_back(json_number(real));
        return list;
    }
    return std::visit([](const auto& value) { return Json(value); }, attribute.value);
}

Facts image_facts(const std::filesystem::path& file) {
    const render::ImageInfo image = render::read_image_info(file);
    if (!render::is_whole_image(file))
        throw InputError(fmt::format(
            "{}: is cut off: it ends before the pixels that its header tells of", file.string()));
    Facts facts = {
        text("kind", "image"),
        {"size", {image.width, image.height}, fmt::format("{}x{}", image.width, image.height)},
        {"pixels held",
         {image.x0, image.y0, image.x1, image.y1},
         fmt::format("{},{} to {},{}", image.x0, image.y0, image.x1, image.y1)},
        {"channels", image.channels, fmt::format("{}", fmt::join(image.channels, " "))}};
    if (!image.scene_hash.empty()) {
        facts.push_back(count("motion version", image.motion_version));
        facts.push_back(count("picture version", image.picture_version));
    }
    for (const render::ImageAttribute& attribute : image.attributes)
        facts.push_back({attribute.name, json_of(attribute), attribute.text});
    return facts;
}

}  // namespace

Facts facts_about(const std::filesystem::path& file, int threads) {
    switch (kind_of(file)) {
        case FileKind::kTrajectory:
            return trajectory_facts(file);
        case FileKind::kImage:
            return image_facts(file);
        case FileKind::kScene:
        case FileKind::kFrames:
            break;
    }
    return scene_facts(file, threads);  // its errors also name what cannot be read at all
}

}  // namespace tesserae::scenes
