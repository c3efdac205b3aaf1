#include "scenes/program/info.hpp"

#include <fmt/ranges.h>

#include <array>
#include <fstream>

#include "core/error.hpp"
#include "render/file/image_info.hpp"
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
            {"steps", fmt::format("{}", plan.steps)},
            {"frames", fmt::format("{}", plan.frames)},
            {"size", fmt::format("{}x{}", scene.render.width, scene.render.height)},
            {"samples", fmt::format("{}", scene.render.samples)}};
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
    const std::vector<StepFacts> rows = trajectory.facts();
    double penetration = 0;
    for (const StepFacts& row : rows) penetration = std::max(penetration, row.report.penetration);
    const auto energy = [](const StepFacts& row) {
        return fmt::format("{:.6g} J kinetic, {:.6g} J potential", row.kinetic_energy,
                           row.potential_energy);
    };
    facts.insert(facts.end(),
                 {{"last step", fmt::format("{}", rows.back().step)},
                  {"last time", fmt::format("{} s", rows.back().time)},
                  {"energy, first row", energy(rows.front())},
                  {"energy, last row", energy(rows.back())},
                  {"contacts, last row", fmt::format("{}", rows.back().report.contacts)},
                  {"deepest penetration", fmt::format("{:.3g} m", penetration)}});
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
    std::array<unsigned char, 8> start = {};
    if (std::filesystem::is_regular_file(file)) {
        std::ifstream in(file, std::ios::binary);
        in.read(reinterpret_cast<char*>(start.data()), start.size());
    }
    if (start == std::array<unsigned char, 8>{0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'})
        return trajectory_facts(file);
    if (start[0] == 0x76 && start[1] == 0x2f && start[2] == 0x31 && start[3] == 0x01)
        return image_facts(file);
    return scene_facts(file, threads);  // its errors also name what cannot be read at all
}

}  // namespace tesserae::scenes
