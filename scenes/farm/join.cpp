// SPDX-License-Identifier: Apache-2.0
#include "scenes/farm/join.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "core/error.hpp"
#include "render/file/part_file.hpp"
#include "scenes/farm/estimate.hpp"
#include "scenes/process/messages.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

/// What may be lost at most when a process is killed [s on one core].
constexpr double kPartSeconds = 300;
/// A part is some tiles, and costs the frame's preparation again.
constexpr double kMostParts = 1000;

/// As `render --tiles` allows it.
constexpr int kMostFileParts = 100'000;

std::vector<fs::path> part_files(const fs::path& exr, int count) {
    std::vector<fs::path> files;
    for (int k = 1; k <= count; ++k) files.push_back(part_file(exr, {k, count}));
    return files;
}

/// The parts are joined before they are removed: a kill in between leaves what can be joined again,
/// or parts of a whole frame.
void join_and_remove(int count, const render::FrameFiles& files) {
    render::join_parts(part_files(files.exr, count), files.exr, files.preview);
    remove_parts(files.exr, count);
}

/// Parts of one frame, cut in the same way.
struct PartSet {
    std::string stem;  ///< NAME.0007
    int count = 0;     ///< of parts

    auto operator<=>(const PartSet&) const = default;
};

std::vector<fs::path> paths_in(const fs::path& folder) {
    std::vector<fs::path> paths;
    std::error_code error;
    fs::directory_iterator at(folder, error);
    for (; !error && at != fs::directory_iterator(); at.increment(error))
        paths.push_back(at->path());
    if (error)
        throw RunError(fmt::format("{}: cannot be read: {}", folder.string(), error.message()));
    return paths;
}

/// The parts that lie in a folder, by frame and count. What only looks like one is told.
std::map<PartSet, std::set<int>> find_parts(const fs::path& frames, JoinReport& report) {
    std::map<PartSet, std::set<int>> found;
    const std::regex name(R"((.+\.[0-9]{4,8})\.([0-9]{1,9})of([0-9]{1,9})\.tiles)");
    for (const fs::path& path : paths_in(frames)) {
        const std::string file = path.filename().string();
        std::smatch match;
        if (!std::regex_match(file, match, name)) continue;
        const int number = std::stoi(match[2].str()), count = std::stoi(match[3].str());
        const fs::path exr = frames / (match[1].str() + ".exr");
        const bool is_part = 1 <= number && number <= count && count <= kMostFileParts &&
                             part_file(exr, {number, count}) == path;
        if (is_part)
            found[{match[1].str(), count}].insert(number);
        else
            report.wrong.push_back(
                fmt::format("{}: is not the name of a part: expected NAME.0000.KofN.tiles with 1 "
                            "<= K <= N <= {}; remove it",
                            path.string(), kMostFileParts));
    }
    return found;
}

/// Parts of a frame lack others. That is as it should be where the frame is whole: then they are
/// removed. @return the frame is there
bool remove_leftovers(const PartSet& parts, const std::set<int>& there, const fs::path& exr,
                      JoinReport& report) {
    if (!fs::exists(exr)) return false;
    const fs::path first = part_file(exr, {*there.begin(), parts.count});
    if (render::is_made_of(exr, render::read_part_info(first))) {
        remove_parts(exr, parts.count);
        report.removed += static_cast<int>(there.size());
    } else {
        report.wrong.push_back(fmt::format("{}: is a part of another frame than {}; remove it",
                                           first.string(), exr.string()));
    }
    return true;
}

/// Whether another process has joined a frame meanwhile: it is there, and its parts go.
bool is_joined_elsewhere(const PartSet& parts, const fs::path& exr) {
    const std::vector<fs::path> files = part_files(exr, parts.count);
    const auto is_there = [](const fs::path& file) { return fs::exists(file); };
    return is_there(exr) && !std::all_of(files.begin(), files.end(), is_there);
}

}  // namespace

fs::path part_file(const fs::path& exr, const render::FramePart& part) {
    fs::path file = exr;
    return file.replace_extension(fmt::format("{}of{}.tiles", part.number, part.count));
}

int parts_of_frame(const Scene& scene) {
    const double seconds = frame_core_seconds(scene);
    return static_cast<int>(std::clamp(std::ceil(seconds / kPartSeconds), 1.0, kMostParts));
}

std::optional<render::FrameStats> render_one_part(const render::Picture& picture,
                                                  const render::FrameInfo& info,
                                                  const render::FramePart& part,
                                                  const fs::path& exr, bool overwrite,
                                                  const std::atomic<bool>& stop) {
    const fs::path file = part_file(exr, part);
    if (fs::exists(file))
        if (const std::string damage = render::damage_of_part(file); !damage.empty())
            tell(fmt::format("{}: rendered again", damage));
    return render::render_part(picture, info, part, file, overwrite, stop);
}

void remove_parts(const fs::path& exr, int count) {
    for (const fs::path& part : part_files(exr, count)) {
        std::error_code ignored;
        fs::remove(part, ignored);
    }
}

render::FrameStats render_in_parts(const render::Picture& picture, const render::FrameInfo& info,
                                   const render::FrameFiles& files, int count, bool overwrite,
                                   const std::atomic<bool>& stop) {
    render::FrameStats stats;
    for (int k = 1; k <= count; ++k) {
        const auto done = render_one_part(picture, info, {k, count}, files.exr, overwrite, stop);
        if (done) stats += *done;
    }
    join_and_remove(count, files);
    return stats;
}

JoinReport join_folder(const fs::path& folder) {
    const fs::path frames = folder / "frames";
    if (!fs::is_directory(frames))
        throw InputError(
            fmt::format("{}: has no folder of frames; expected the DIR of tesserae render --tiles",
                        folder.string()));
    JoinReport report;
    for (const auto& [parts, there] : find_parts(frames, report)) {
        const fs::path exr = frames / (parts.stem + ".exr");
        try {
            std::vector<int> missing;
            for (int k = 1; k <= parts.count; ++k)
                if (!there.contains(k)) missing.push_back(k);
            if (missing.empty()) {
                join_and_remove(parts.count, {exr, folder / "preview" / (parts.stem + ".png")});
                ++report.joined;
            } else if (!remove_leftovers(parts, there, exr, report)) {
                report.missing.push_back(fmt::format("{}: parts {} of {}", parts.stem,
                                                     frames_text(missing), parts.count));
            }
        } catch (const RunError&) {
            if (!is_joined_elsewhere(parts, exr)) throw;
        } catch (const InputError& error) {
            // The other frames are joined all the same.
            report.wrong.push_back(
                fmt::format("{}; tesserae render --tiles makes that part again", error.what()));
        }
    }
    return report;
}

}  // namespace tesserae::scenes
