#include "scenes/program/info.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "render/file/image_info.hpp"
#include "scenes/file_kind.hpp"
#include "scenes/load/load.hpp"
#include "scenes/plan.hpp"
#include "scenes/trajectory/trajectory.hpp"

namespace tesserae::scenes {
namespace {

using Facts = std::vector<std::pair<std::string, std::string>>;

Facts scene_facts(const std::filesystem::path& file, int threads) {
    const Scene scene = load_scene(file, {});
    const Plan plan = make_plan(scene, threads);
    return {{"kind", "scene"},
            {"name", scene.name},
            {"hash", scene.hash},
            {"motion hash", scene.motion_hash},
            {"bodies", fmt::format("{}", plan.bodies)},
            {"movable bodies", fmt::format("{}", plan.movable_bodies)},
            {"materials", fmt::format("{}", scene.materials.size())},
            {"suns", fmt::format("{}", scene.lights.suns.size())},
            {"point lights", fmt::format("{}", scene.lights.points.size())},
            {"sphere lights", fmt::format("{}", scene.lights.spheres.size())},
            {"steps", fmt::format("{}", plan.steps)},
            {"frames", fmt::format("{}", plan.frames)},
            {"size", fmt::format("{}x{}", scene.render.width, scene.render.height)},
            {"samples", fmt::format("{}", scene.render.samples)}};
}

double energy_of(const StepFacts& row) { return row.kinetic_energy + row.potential_energy; }

/// The largest value of a function of the rows, and the step where it is first reached.
template <class Value>
std::string largest(const std::vector<StepFacts>& rows, Value&& value, const char* unit) {
    const auto at = std::max_element(rows.begin(), rows.end(), [&](const auto& a, const auto& b) {
        return value(a) < value(b);
    });
    return fmt::format("{:.3g} {} at step {}", value(*at), unit, at->step);
}

/// How far the stored steps are from what an exact motion would keep. Gravity and bodies that move
/// at a given velocity change energy and momentum too.
void append_diagnostics(Facts& facts, const std::vector<StepFacts>& rows) {
    const StepFacts &first = rows.front(), &last = rows.back();
    const auto energy = [](const StepFacts& row) {
        return fmt::format("{:.9g} J: {:.6g} kinetic, {:.6g} potential", energy_of(row),
                           row.kinetic_energy, row.potential_energy);
    };
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
    facts.insert(facts.end(),
                 {{"last step", fmt::format("{}", last.step)},
                  {"last time", fmt::format("{} s", last.time)},
                  {"energy, first row", energy(first)},
                  {"energy, last row", energy(last)},
                  {"largest energy change", largest(rows, energy_change, "J")},
                  {"momentum change", largest(rows, momentum_change, "kg m/s")},
                  {"angular momentum change", largest(rows, angular_change, "kg m^2/s")},
                  {"contacts, last row", fmt::format("{}", last.report.contacts)},
                  {"asleep, last row", fmt::format("{} bodies", last.report.asleep)},
                  {"deepest penetration", largest(rows, penetration, "m")},
                  {"largest mean penetration", largest(rows, mean, "m")},
                  {"largest solver residual", largest(rows, residual, "m/s")}});
}

Facts trajectory_facts(const std::filesystem::path& file) {
    const TrajectoryReader trajectory(file);
    const TrajectoryHeader& header = trajectory.header();
    Facts facts = {{"kind", "trajectory"},
                   {"scene", header.scene_name},
                   {"motion hash", header.motion_hash},
                   {"written by", "tesserae " + header.program_version},
                   {"bodies", fmt::format("{}", header.bodies)},
                   {"steps per second", fmt::format("{}", header.steps_per_second)},
                   {"rows", fmt::format("{}", trajectory.rows())}};
    if (trajectory.rows() == 0) return facts;
    append_diagnostics(facts, trajectory.facts());
    return facts;
}

Facts image_facts(const std::filesystem::path& file) {
    const render::ImageInfo image = render::read_image_info(file);
    Facts facts = {
        {"kind", "image"},
        {"size", fmt::format("{}x{}", image.width, image.height)},
        {"pixels held", fmt::format("{},{} to {},{}", image.x0, image.y0, image.x1, image.y1)},
        {"channels", fmt::format("{}", fmt::join(image.channels, " "))}};
    facts.insert(facts.end(), image.attributes.begin(), image.attributes.end());
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
