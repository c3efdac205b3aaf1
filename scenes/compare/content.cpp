// SPDX-License-Identifier: Apache-2.0
#include "scenes/compare/content.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <exception>

#include "core/error.hpp"
#include "scenes/compare/file_content.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/hash.hpp"
#include "scenes/load/load.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

Content scene_content(const fs::path& file) {
    const Scene scene = load_scene(file, {});
    return {FileKind::kScene,
            {{"effective", "text", scene.hash}, {"motion", "text", scene.motion_hash}}};
}

Content frames_content(const fs::path& folder) {
    const std::vector<fs::path> files = frames_in(folder);
    Content content{FileKind::kFrames, std::vector<ContentEntry>(files.size())};
    std::vector<std::exception_ptr> errors(files.size());
    tbb::parallel_for(std::size_t{0}, files.size(), [&](std::size_t i) {
        try {
            content.entries[i] = {files[i].filename().string(), "image",
                                  image_content(files[i]).hash()};
        } catch (...) {
            errors[i] = std::current_exception();
        }
    });
    // The first by name, whichever thread was first.
    for (const std::exception_ptr& error : errors)
        if (error) std::rethrow_exception(error);
    return content;
}

}  // namespace

std::string Content::manifest() const {
    std::string text = fmt::format("tesserae content 1\n{}\n", name_of(kind));
    for (const ContentEntry& entry : entries)
        text += fmt::format("{} {} {}\n", toml_text(std::string_view(entry.name)),
                            entry.description, entry.hash);
    return text;
}

std::string Content::hash() const {
    return kind == FileKind::kScene ? entries.front().hash : hex_hash(manifest());
}

Content read_content(const fs::path& path) {
    switch (kind_of(path)) {
        case FileKind::kTrajectory:
            return trajectory_content(path);
        case FileKind::kImage:
            return image_content(path);
        case FileKind::kFrames:
            return frames_content(path);
        case FileKind::kScene:
            break;
    }
    return scene_content(path);
}

std::vector<fs::path> frames_in(const fs::path& folder) {
    std::error_code error;
    const fs::path below = folder / "frames";
    const fs::path place = fs::is_directory(below, error) ? below : folder;
    std::vector<fs::path> files;
    fs::directory_iterator at(place, error);
    for (; !error && at != fs::directory_iterator(); at.increment(error))
        if (at->path().extension() == ".exr") files.push_back(at->path());
    if (error) throw InputError(fmt::format("{}: {}", place.string(), error.message()));
    if (files.empty())
        throw InputError(
            fmt::format("{}: holds no frames; expected .exr files there, or in a folder frames",
                        place.string()));
    std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
        return a.filename().native() < b.filename().native();
    });
    return files;
}

std::vector<EntryDifference> differing_entries(const Content& a, const Content& b) {
    std::vector<EntryDifference> differences;
    auto i = a.entries.begin(), j = b.entries.begin();
    while (i != a.entries.end() || j != b.entries.end()) {
        if (j == b.entries.end() || (i != a.entries.end() && i->name < j->name)) {
            differences.push_back({i->name, i->description, {}});
            ++i;
        } else if (i == a.entries.end() || j->name < i->name) {
            differences.push_back({j->name, {}, j->description});
            ++j;
        } else {
            if (!(*i == *j)) differences.push_back({i->name, i->description, j->description});
            ++i, ++j;
        }
    }
    return differences;
}

}  // namespace tesserae::scenes
