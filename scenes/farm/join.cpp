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

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

/// What may be lost at most when a process is killed [s on one core].
constexpr double kPartSeconds = 300;
/// A part is some tiles, and costs the frame's preparation again.
constexpr double kMostParts = 1000;

/// The parts are joined before they are removed: a kill in between leaves what can be joined again.
void join_and_remove(const std::vector<fs::path>& parts, const render::FrameFiles& files) {
    render::join_parts(parts, files.exr, files.preview);
    for (const fs::path& part : parts) {
        std::error_code ignored;
        fs::remove(part, ignored);
    }
}

std::vector<fs::path> part_files(const fs::path& exr, int count) {
    std::vector<fs::path> files;
    for (int k = 1; k <= count; ++k) files.push_back(part_file(exr, {k, count}));
    return files;
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

render::FrameStats render_in_parts(const render::Picture& picture, const render::FrameInfo& info,
                                   const render::FrameFiles& files, int count, bool overwrite,
                                   const std::atomic<bool>& stop) {
    render::FrameStats stats;
    for (int k = 1; k <= count; ++k) {
        const render::FramePart part = {k, count};
        const auto done =
            render::render_part(picture, info, part, part_file(files.exr, part), overwrite, stop);
        if (done) stats += *done;
    }
    join_and_remove(part_files(files.exr, count), files);
    return stats;
}

JoinReport join_folder(const fs::path& folder) {
    const fs::path frames = folder / "frames";
    if (!fs::is_directory(frames))
        throw InputError(
            fmt::format("{}: has no folder of frames; expected the DIR of tesserae render --tiles",
                        folder.string()));
    // By frame and count.
    std::map<std::pair<std::string, int>, std::set<int>> found;
    const std::regex name(R"((.+\.[0-9]{4,8})\.([0-9]{1,6})of([0-9]{1,6})\.tiles)");
    for (const auto& entry : fs::directory_iterator(frames)) {
        const std::string file = entry.path().filename().string();
        std::smatch match;
        if (std::regex_match(file, match, name))
            found[{match[1].str(), std::stoi(match[3].str())}].insert(std::stoi(match[2].str()));
    }

    JoinReport report;
    for (const auto& entry : found) {
        const std::string& stem = entry.first.first;
        const int count = entry.first.second;
        std::vector<int> missing;
        for (int k = 1; k <= count; ++k)
            if (!entry.second.contains(k)) missing.push_back(k);
        if (!missing.empty()) {
            report.missing.push_back(
                fmt::format("{}: parts {} of {}", stem, frames_text(missing), count));
            continue;
        }
        const fs::path exr = frames / (stem + ".exr");
        join_and_remove(part_files(exr, count), {exr, folder / "preview" / (stem + ".png")});
        ++report.joined;
    }
    return report;
}

}  // namespace tesserae::scenes
