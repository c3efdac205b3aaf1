// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/world/world.hpp"
#include "render/finished_picture.hpp"

namespace tesserae {

namespace scenes {
struct Scene;
}

/// Is told how far work is: `done` of `total` steps, tiles or frames. Returns whether the work goes
/// on; if not, it ends with Stopped. It is called by one thread at a time, not always the same one.
using ProgressFunction = std::function<bool(std::uint64_t done, std::uint64_t total)>;

/// How Scene::simulate() works.
struct SimulationOptions {
    int threads = 0;                 ///< 0: as many as the cores that this process may use
    std::uint64_t store_every = 0;   ///< every so many steps are stored; 0: those that frames need
    bool overwrite = false;          ///< a trajectory of another motion or other steps is replaced
    ProgressFunction progress = {};  ///< of steps
    const std::atomic<bool>* stop = nullptr;  ///< once it is set, the work ends with Stopped
};

/// What Scene::simulate() did.
struct SimulationResult {
    std::uint64_t first_step = 0;  ///< where the work began: 0, or what was stored before
    std::uint64_t last_step = 0;   ///< of the file
    std::uint64_t stored = 0;      ///< number of stored steps in the file
    bool kept = false;             ///< nothing was missing
    double seconds = 0;            ///< that it took
};

/// How Scene::render() and Scene::render_frame() work.
struct PictureOptions {
    int threads = 0;  ///< as above
    /// The number of the picture of a world, >= 0: noise differs from number to number.
    int frame = 0;
    ProgressFunction progress = {};           ///< of tiles
    const std::atomic<bool>* stop = nullptr;  ///< as above
};

/// How Scene::film() works.
struct FilmOptions {
    int threads = 0;               ///< as above
    std::vector<int> frames = {};  ///< their numbers; empty: all
    bool overwrite = false;  ///< frames of another scene, or that look otherwise, are replaced
    ProgressFunction progress = {};           ///< of frames
    const std::atomic<bool>* stop = nullptr;  ///< as above
};

/// What Scene::film() did.
struct FilmResult {
    int rendered = 0;
    int copied = 0;  ///< from the frame before, which looks the same
    int kept = 0;    ///< were there
    double seconds = 0;
    std::filesystem::path frames;   ///< the folder of the images
    std::filesystem::path preview;  ///< of the last frame
};

/// A scene file, read and checked. It does not change; copies share what they hold and cost little.
/// FORMATS.md tells of the files that are read and written here.
class Scene {
  public:
    /// Reads a scene file.
    /// @param sets   "KEY=VALUE" in order, as for `--set` of the program
    /// @throws InputError   the file cannot be read, or anything in it or in `sets` is wrong: every
    ///                      line of the message has file, line, column, value and rule
    static Scene read(const std::filesystem::path& file, const std::vector<std::string>& sets = {});
    /// The same of a text.
    /// @param file   names the text in messages; without [scene] name its stem names the scene
    static Scene parse(std::string text, const std::vector<std::string>& sets = {},
                       const std::filesystem::path& file = "scene.toml");

    const std::string& name() const;
    /// Returns the effective text: the scene with all defaults and sets. The same scene gives the
    /// same text, which is itself a scene file.
    const std::string& text() const;
    /// Returns 32 hexadecimal digits of the effective text.
    const std::string& hash() const;
    /// Returns 32 hexadecimal digits of what moves bodies: a trajectory serves scenes with the
    /// same.
    const std::string& motion_hash() const;
    /// Returns a line for each key that changes nothing.
    const std::vector<std::string>& unused_keys() const;

    /// Returns the settings of its physics; none for a still.
    const std::optional<PhysicsSettings>& physics() const;
    int width() const;   ///< of its pictures [pixels]
    int height() const;  ///< of its pictures [pixels]
    int frames() const;  ///< number of frames, at least 1
    double frames_per_second() const;
    /// Returns the time of a frame [s].
    /// @throws InputError   the scene has no such frame
    double time_of_frame(int frame) const;

    std::size_t bodies() const;  ///< number of bodies
    std::size_t joints() const;  ///< number of joints
    /// Returns the number of the body of this name.
    /// @throws InputError   there is none, with the nearest name; or it is a lattice of several
    BodyId body(std::string_view name) const;
    /// Returns the numbers of all bodies of a name, ascending: those of a lattice share theirs.
    /// @throws InputError   there is none, with the nearest name
    std::vector<BodyId> bodies_of(std::string_view name) const;
    /// @throws InputError   the scene has no such body
    const std::string& name_of(BodyId body) const;
    /// @throws InputError   the scene has no such joint, with the nearest name
    JointId joint(std::string_view name) const;

    /// Makes a world with the scene's bodies and joints as they are at time 0. They have the same
    /// numbers. Of a still the settings are the default ones.
    /// @param workers   as for World
    World world(std::shared_ptr<Workers> workers = {}) const;

    /// Moves the bodies through the scene's time and stores their states in a trajectory: all that
    /// `tesserae simulate` does. A whole file of the same motion is kept, an unfinished one
    /// continued.
    /// @throws InputError   `file` is of another motion or of other steps, and not `overwrite`
    /// @throws RunError     a body left the finite range, or the file cannot be written
    /// @throws Stopped      the work was asked to stop; what is stored is kept
    SimulationResult simulate(const std::filesystem::path& file,
                              const SimulationOptions& options = {}) const;

    /// Renders a world as it is now, with the scene's camera at the world's time, its lights and
    /// settings. A body looks like the scene's body of the same number, whatever shape it has; one
    /// that the scene does not have is of the material "default": a grey of albedo 0.8. While the
    /// shutter is open, and for vectors of motion, bodies go on at their velocities. The picture
    /// has no overlay.
    /// @throws InputError   the camera follows a body that the world does not have; a shape cannot
    ///                      be shown
    Picture render(const World& world, const PictureOptions& options = {}) const;
    /// Renders a frame, with the pixels that film() gives.
    /// @param trajectory   of the scene's motion; none where nothing moves, or has not yet
    /// @throws InputError   the scene has no such frame; there is no trajectory, or it is of
    /// another
    ///                      motion or lacks a step that the frame needs
    Picture render_frame(int frame, const std::filesystem::path& trajectory = {},
                         const PictureOptions& options = {}) const;
    /// Renders frames into a folder, as `tesserae render` does: images in `frames`, previews in
    /// `preview`. Frames that are there are kept. What is odd (samples that are no number, damaged
    /// frames) is told on standard error.
    /// @param trajectory   of the scene's motion; none: where bodies move it is made first, as
    ///                     `folder`/trajectory.h5
    /// @throws InputError   as render_frame(); the folder holds another scene's frames
    /// @throws RunError     a file cannot be written
    /// @throws Stopped      the work was asked to stop; finished frames are kept
    FilmResult film(const std::filesystem::path& folder,
                    const std::filesystem::path& trajectory = {},
                    const FilmOptions& options = {}) const;

    /// What is in it. It is for the program itself and no part of the library.
    const scenes::Scene& inside() const { return *inside_; }
    explicit Scene(std::shared_ptr<const scenes::Scene> inside) : inside_(std::move(inside)) {}

  private:
    std::shared_ptr<const scenes::Scene> inside_;
};

}  // namespace tesserae
