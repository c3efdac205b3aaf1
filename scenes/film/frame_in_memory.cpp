// SPDX-License-Identifier: Apache-2.0
#include "scenes/film/frame_in_memory.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "core/error.hpp"
#include "render/frame.hpp"
#include "render/picture_inside.hpp"
#include "scenes/film/film.hpp"
#include "scenes/film/mattes.hpp"
#include "scenes/film/shots.hpp"
#include "scenes/load/hash.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

tesserae::Picture rendered(const Scene& scene, const render::Picture& picture,
                           const render::FrameInfo& info, const Watch& watch) {
    render::FrameInMemory frame = render::render_in_memory(
        picture, info, *watch.stop,
        [&](std::uint64_t done, std::uint64_t total) { watch.tell(done, total); });
    frame.picture->warnings = picture_warnings(frame.stats, scene, info.frame);
    return tesserae::Picture(std::move(frame.picture));
}

/// The types of a world's bodies, each with its looks, beside those of the scene.
class TypesOfWorld {
  public:
    /// @param shown   gets the types; has those of the scene already
    explicit TypesOfWorld(Scene& shown) : shown_(shown) {
        render::Appearance gone;
        gone.visible = false;
        last_ = gone_ = add({Hypersphere{1}}, gone);
    }

    /// The type of the numbers that are not used any more.
    std::uint32_t gone() const { return gone_; }
    /// @param like   a type of the scene that it was of, or none
    std::uint32_t number_of(const BodyType& type, std::optional<std::uint32_t> like) {
        if (like && shown_.bodies.types[*like] == type) return *like;
        const render::Appearance looks = like ? shown_.appearance[*like] : render::Appearance();
        // Bodies that were added together mostly are of one type.
        if (!(shown_.bodies.types[last_] == type && shown_.appearance[last_] == looks))
            last_ = add(type, looks);
        return last_;
    }

  private:
    std::uint32_t add(const BodyType& type, const render::Appearance& looks) {
        shown_.bodies.types.push_back(type);
        shown_.appearance.push_back(looks);
        return static_cast<std::uint32_t>(shown_.appearance.size() - 1);
    }

    Scene& shown_;
    std::uint32_t gone_ = 0;
    std::uint32_t last_ = 0;
};

/// Leaves so many bodies their names, and calls those after them "added".
void rename_bodies(std::vector<NamedBodies>& names, std::uint32_t before, std::uint32_t count) {
    while (!names.empty() && names.back().first >= count) names.pop_back();
    if (count < before && !names.empty()) names.back().count = count - names.back().first;
    if (count > before) names.push_back({"added", before, count - before, true});
}

}  // namespace

tesserae::Picture frame_in_memory(const Scene& scene, int frame,
                                  const std::filesystem::path& trajectory, const Watch& watch) {
    if (!has_frame(scene, frame))
        throw InputError(fmt::format("{}: frame {}: the scene has frames 0 to {}",
                                     scene.file.string(), frame, frame_count(scene) - 1));
    if (trajectory.empty() && make_plan(scene, 1).moves && last_step_needed(scene, {frame}) > 0)
        throw InputError(
            fmt::format("{}: frame {}: bodies have moved by then: it needs a "
                        "trajectory, which simulating makes",
                        scene.file.string(), frame));
    Shots shots(scene, {frame}, trajectory);
    shots.name_mattes({});
    const Shot shot = shots.shot(frame);
    return rendered(scene, shots.picture(shot), shot.info, watch);
}

Scene scene_of_world(const Scene& scene, const World& world) {
    Scene shown = scene;
    const std::span<const BodyId> ids = world.ids();
    const BodyArrays now = world.arrays();
    const auto before = static_cast<std::uint32_t>(scene.bodies.size());
    const std::uint32_t count = ids.empty() ? 0 : ids.back() + 1;
    TypesOfWorld types(shown);

    Bodies& bodies = shown.bodies;
    bodies.type.assign(count, types.gone());
    bodies.position.assign(count, Vec4::Zero());
    bodies.rotor.assign(count, {});
    bodies.velocity.assign(count, Vec4::Zero());
    bodies.angular_velocity.assign(count, {});
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const BodyId id = ids[i];
        std::optional<std::uint32_t> like;
        if (id < before) like = scene.bodies.type[id];
        bodies.type[id] = types.number_of(world.type(id), like);
        bodies.position[id] = now.position[i];
        bodies.rotor[id] = now.rotor[i];
        bodies.velocity[id] = now.velocity[i];
        bodies.angular_velocity[id] = now.angular_velocity[i];
    }
    rename_bodies(shown.names, before, count);
    return shown;
}

tesserae::Picture world_in_memory(const Scene& scene, const World& world, int number,
                                  const Watch& watch) {
    if (const auto followed = scene.camera_motion.followed;
        scene.follows() && !world.has(*followed))
        throw InputError(
            fmt::format("body {} \"{}\": the camera follows it, and the world has it "
                        "no more",
                        *followed, scene.camera_motion.follow));
    const Scene shown = scene_of_world(scene, world);
    // The scene's own: it knows where the body that it follows was at time 0.
    FilmCamera camera(scene);
    const Exposure exposure(shown, camera, shown.bodies, world.time());
    render::Picture picture = exposure.picture(shown, number);
    std::optional<render::Mattes> mattes;
    if (shown.render.channels.cryptomatte) picture.mattes = &mattes.emplace(mattes_of(shown, {}));

    render::FrameInfo info = common_info(shown);
    info.frame = number;
    info.time = world.time();
    // It is no frame of the scene, and must not be taken for one.
    info.scene_hash = hex_hash(scene.effective + "# a world\n");
    return rendered(scene, picture, info, watch);
}

}  // namespace tesserae::scenes
