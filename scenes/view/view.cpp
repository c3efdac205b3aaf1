// SPDX-License-Identifier: Apache-2.0
#include "scenes/view/view.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>

#include "core/error.hpp"
#include "core/file/file_writer.hpp"
#include "render/camera/camera.hpp"
#include "scenes/film/film_camera.hpp"
#include "scenes/film/poses.hpp"
#include "scenes/process/memory.hpp"
#include "scenes/process/progress.hpp"
#include "scenes/process/signals.hpp"
#include "scenes/timeline.hpp"
#include "scenes/trajectory/trajectory.hpp"
#include "scenes/view/page.hpp"
#include "scenes/view/page_joints.hpp"
#include "scenes/view/page_scene.hpp"
#include "scenes/view/pose_tracks.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

/// Bodies' poses at the moments of a page, read one after the other.
class ViewPoses {
  public:
    /// @param asked   frames; empty: all
    ViewPoses(const Scene& scene, const fs::path& trajectory, const std::vector<int>& asked)
        : bodies_(scene.bodies) {
        const std::vector<int> frames =
            asked.empty() ? parse_frames("", frame_count(scene)) : asked;
        if (!trajectory.empty()) rows_ = std::make_unique<TrajectoryReader>(trajectory);
        if (!rows_ || !asked.empty() || has_steps_of(scene, frames)) {
            rows_.reset();
            poses_ = std::make_unique<Poses>(scene, frames, trajectory);
            for (const int frame : frames) instants_.push_back(frame_instant(scene, frame));
            FilmCamera camera(scene, poses_.get());
            for (const int frame : frames)
                moments_.push_back({frame_instant(scene, frame).time, camera.at(frame).value()});
            return;
        }
        if (rows_->rows() == 0)
            throw InputError(fmt::format("{}: holds no step yet", trajectory.string()));
        const Poses checked(scene, {}, trajectory);  // that it is of this scene's motion
        FilmCamera camera(scene, &checked);
        for (std::size_t row = 0; row < rows_->rows(); ++row) {
            if (scene.follows()) rows_->read_row(row, bodies_);
            const double time = rows_->times()[row];
            moments_.push_back({time, camera.at(time, bodies_)});
        }
    }

    const std::vector<ViewMoment>& moments() const { return moments_; }
    /// The last step at or before each moment.
    std::vector<std::uint64_t> steps() const {
        if (rows_) return rows_->steps();
        std::vector<std::uint64_t> steps;
        for (const FrameInstant& instant : instants_) steps.push_back(instant.step);
        return steps;
    }
    /// Valid until the next call.
    const Bodies& at(std::size_t moment) {
        if (poses_) return poses_->at(instants_[moment]);
        rows_->read_row(moment, bodies_);
        return bodies_;
    }

  private:
    bool has_steps_of(const Scene& scene, const std::vector<int>& frames) const {
        const auto& steps = rows_->steps();
        for (const int frame : frames) {
            const FrameInstant at = frame_instant(scene, frame);
            if (!std::binary_search(steps.begin(), steps.end(), at.step)) return false;
            if (at.fraction > 0 && !std::binary_search(steps.begin(), steps.end(), at.step + 1))
                return false;
        }
        return true;
    }

    Bodies bodies_;
    std::unique_ptr<TrajectoryReader> rows_;  ///< its rows are the moments
    std::unique_ptr<Poses> poses_;            ///< or the film's frames
    std::vector<FrameInstant> instants_;
    std::vector<ViewMoment> moments_;
};

void require_room(const Scene& scene, const PoseRanges& ranges, std::size_t moments,
                  const ViewOptions& options) {
    const std::uint64_t bytes =
        PosePacker::bytes_of(ranges, moments) + kPageJointBytes * scene.joints.size();
    const std::string what =
        fmt::format("{}: {} bodies at {} moments would take {} MB", scene.file.string(),
                    ranges.tracks().size(), moments, bytes / 1'000'000);
    if (bytes > options.most_pose_bytes)
        throw InputError(fmt::format(
            "{}, a page holds {} MB: leave out what is never {} the film's slice with --near-slice "
            "METRES, or frames with --set render.frames_per_second=N",
            what, options.most_pose_bytes / 1'000'000, options.near_slice ? "as near" : "near"));
    // The bits, their bytes, the page.
    if (4 * bytes > available_memory())
        throw InputError(
            fmt::format("{}, making the page needs {} MB of memory", what, 4 * bytes / 1'000'000));
}

}  // namespace

void require_page(const fs::path& file, bool overwrite) {
    if (file.extension() != ".html")
        throw InputError(fmt::format("-o {}: expected a name that ends in .html", file.string()));
    if (overwrite || !fs::exists(file)) return;
    if (!fs::is_regular_file(file))
        throw InputError(fmt::format("{}: is there and no file", file.string()));
    std::ifstream in(file, std::ios::binary);
    std::string beginning(2000, '\0');
    in.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
    if (in.bad())
        throw InputError(
            fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
    if (page_hash(beginning).empty())
        throw InputError(fmt::format(
            "{}: is no page that tesserae view has made; choose another name, or --overwrite",
            file.string()));
}

ViewReport write_view(const Scene& scene, const fs::path& trajectory, const fs::path& file,
                      const ViewOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    ViewPoses poses(scene, trajectory, options.frames);
    const std::vector<ViewMoment>& moments = poses.moments();
    Progress progress("packing", "moments", 2 * moments.size(), options.quiet);
    std::uint64_t done = 0;
    const auto for_each_moment = [&](auto&& use) {
        for (std::size_t i = 0; i < moments.size(); ++i) {
            if (stop_requested()) throw Stopped();
            use(poses.at(i), moments[i]);
            progress.update(++done);
        }
    };

    PoseRanges ranges(scene.bodies, scene.appearance, scene.materials);
    show_anchors(scene, ranges);
    for_each_moment([&](const Bodies& bodies, const ViewMoment& moment) {
        ranges.add(bodies, render::Camera(moment.camera, scene.render.width, scene.render.height));
    });
    if (options.near_slice) ranges.keep_near_slice(*options.near_slice);
    require_room(scene, ranges, moments.size(), options);

    PosePacker packer(ranges, moments.size());
    for_each_moment([&](const Bodies& bodies, const ViewMoment&) { packer.add(bodies); });
    std::vector<PageJoint> joints = page_joints(scene, ranges.tracks());
    if (!trajectory.empty()) find_broken(joints, scene, trajectory, poses.steps());
    const std::string page =
        page_text(scene.hash, page_scene(scene, moments, options.near_slice, joints),
                  packer.take_bytes(scene.bodies), !joints.empty());
    write_file(file, page);

    ViewReport report;
    report.bodies = ranges.tracks().size();
    report.moments = moments.size();
    report.bytes = page.size();
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return report;
}

}  // namespace tesserae::scenes
