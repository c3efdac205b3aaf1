#include "scenes/load/load.hpp"

#include <algorithm>

#include "core/dynamics/motion_version.hpp"
#include "core/error.hpp"
#include "scenes/load/hash.hpp"
#include "scenes/load/load_parts.hpp"
#include "scenes/load/versions.hpp"

namespace tesserae::scenes {
namespace {

bool is_file_name(std::string_view name) {
    return !name.empty() && name.size() <= 64 && name.front() != '.' &&
           std::all_of(name.begin(), name.end(), [](char c) {
               return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
                      c == '.' || c == '_' || c == '-';
           });
}

}  // namespace

void load_name(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out) {
    constexpr const char* kRule = "expected 1 to 64 of A-Z a-z 0-9 . _ -, not starting with a dot";
    scene.name = scene.file.stem().string();
    bool is_given = false;
    if (const auto* table = root.table("scene")) {
        TableReader reader(*table, origin, "[scene]");
        is_given = reader.read("name", scene.name);
        if (is_given && !is_file_name(scene.name)) reader.fail("name", kRule);
        reader.finish();
    }
    if (!is_given && !is_file_name(scene.name))
        throw InputError(
            fmt::format("{}: the file's stem names the scene: {}; rename it or give "
                        "[scene] a name",
                        origin.place, kRule));
    out.table("[scene]");
    out.key("name", scene.name);
}

void load_physics(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out) {
    const auto* table = root.table("physics");
    if (table == nullptr) return;
    constexpr std::string_view kSolvers[] = {"impulse", "soft"};
    constexpr std::string_view kIntegrators[] = {"euler", "midpoint"};
    PhysicsSettings physics;
    TableReader reader(*table, origin, "[physics]");
    reader.read("gravity", physics.gravity, Rule::kFinite);
    reader.read("duration", physics.duration, Rule::kNonNegative);
    reader.read("steps_per_second", physics.steps_per_second, Rule::kPositive);
    reader.read("iterations", physics.iterations, 1, 10000);
    reader.read("substeps", physics.substeps, 1, 1000);
    std::size_t solver = physics.solver == Solver::kImpulse ? 0 : 1;
    std::size_t integrator = physics.integrator == Integrator::kEuler ? 0 : 1;
    reader.read("solver", solver, kSolvers);
    reader.read("integrator", integrator, kIntegrators);
    physics.solver = solver == 0 ? Solver::kImpulse : Solver::kSoft;
    physics.integrator = integrator == 0 ? Integrator::kEuler : Integrator::kMidpoint;
    reader.read("sleeping", physics.sleeping);
    auto seed = static_cast<std::int64_t>(physics.seed);
    reader.read("seed", seed, 0, std::numeric_limits<std::int64_t>::max());
    physics.seed = static_cast<std::uint64_t>(seed);
    reader.finish();
    scene.physics = physics;

    out.table("[physics]");
    out.key("gravity", physics.gravity);
    out.key("duration", physics.duration);
    out.key("steps_per_second", physics.steps_per_second);
    out.key("iterations", std::int64_t{physics.iterations});
    out.key("substeps", std::int64_t{physics.substeps});
    out.key("solver", kSolvers[solver]);
    out.key("integrator", kIntegrators[integrator]);
    out.key("sleeping", physics.sleeping);
    out.key("seed", seed);
}

Scene load_scene(const std::filesystem::path& file, std::span<const std::string> sets) {
    Overrides overrides(sets);
    Scene scene;
    scene.file = file;
    scene.source = read_scene_file(file);
    const Origin origin{printable(file.string(), 400)};
    const SceneText text = cut_scene_text(scene.source, origin.place);
    TomlDocument document(text.rest, origin);
    if (document.is_empty() && text.body_count == 0)
        throw InputError(fmt::format(
            "{}: is empty; expected tables such as [[body]], [camera] and [render]", origin.place));
    overrides.apply(document.root(), text.body_count);

    TableReader root(document.root(), origin, "scene file");
    for (const char* table :
         {"scene", "physics", "material", "body", "lattice", "camera", "light", "render"})
        root.has(table);
    root.finish();
    EffectiveWriter out;
    load_name(root, origin, scene, out);
    load_physics(root, origin, scene, out);
    const MaterialNumbers materials = load_materials(root, origin, scene, out);
    load_bodies(root, origin, text, materials, overrides, scene, out);
    load_camera(root, origin, scene, out);
    load_lights(root, origin, scene, out);
    load_render(root, origin, scene, out);
    require_view(scene, origin);

    scene.hash = hex_hash(out.text());
    scene.motion_hash = motion_hash(out.text(), kMotionVersion);
    scene.effective = out.take_text();
    return scene;
}

}  // namespace tesserae::scenes
