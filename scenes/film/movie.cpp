// SPDX-License-Identifier: Apache-2.0
#include "scenes/film/movie.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

#include "core/error.hpp"
#include "core/file/partial_file.hpp"
#include "core/file/read_file.hpp"
#include "render/file/image_info.hpp"
#include "scenes/film/film_folder.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/hash.hpp"
#include "scenes/process/messages.hpp"
#include "scenes/process/progress.hpp"
#include "scenes/process/signals.hpp"
#include "scenes/timeline.hpp"

extern char** environ;

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

fs::path preview_file(const Scene& scene, const fs::path& folder, int frame) {
    return folder / "preview" / fmt::format("{}.{:04}.png", scene.name, frame);
}

fs::path image_file(const Scene& scene, const fs::path& folder, int frame) {
    return folder / "frames" / fmt::format("{}.{:04}.exr", scene.name, frame);
}

/// The number in NAME.0042.png or whatever the file's end; none of another file.
std::optional<int> frame_number(const std::string& file, const std::string& name,
                                std::string_view end) {
    if (!file.starts_with(name + ".") || !file.ends_with(end)) return std::nullopt;
    const char* const first = file.data() + name.size() + 1;
    const char* const last = file.data() + file.size() - end.size();
    int number = 0;
    const auto [at, error] = std::from_chars(first, last, number);
    if (error != std::errc() || at != last || number < 0) return std::nullopt;
    // Written as the program does: four digits at least, and no more zeros in front than they need.
    if (fmt::format("{:04}", number) != std::string_view(first, last)) return std::nullopt;
    return number;
}

/// From one preview to the next, the same all along.
int stride_of(const std::vector<int>& numbers, const fs::path& folder) {
    if (numbers.size() < 2)
        throw InputError(fmt::format("{}: holds {} of a film's frames: expected two or more",
                                     folder.string(), numbers.size()));
    int stride = numbers[1] - numbers[0];
    for (std::size_t i = 2; i < numbers.size(); ++i)
        stride = std::min(stride, numbers[i] - numbers[i - 1]);
    for (std::size_t i = 1; i < numbers.size(); ++i)
        if (numbers[i] - numbers[i - 1] != stride)
            throw InputError(
                fmt::format("{}: the preview of frame {} is missing, which the same command that "
                            "made the others makes",
                            folder.string(), numbers[i - 1] + stride));
    return stride;
}

using Size = std::array<unsigned, 2>;

/// By the header of a PNG file; content checks are ffmpeg's.
Size size_of(const std::string& png, const fs::path& file) {
    const auto number = [&](std::size_t at) {
        unsigned value = 0;
        for (std::size_t i = at; i < at + 4; ++i)
            value = value << 8 | static_cast<unsigned char>(png[i]);
        return value;
    };
    if (png.size() < 24 || !png.starts_with("\x89PNG\r\n\x1a\n"))
        throw InputError(fmt::format("{}: is no PNG picture", file.string()));
    return {number(16), number(20)};
}

/// A frame that is there besides its preview is one of the scene.
void require_frame_of(const Scene& scene, const fs::path& file, int frame) {
    if (!fs::exists(file)) return;
    const render::ImageInfo there = render::read_image_info(file);
    if (!is_frame_of(scene, there, frame))
        throw InputError(
            fmt::format("{}: is a frame of another scene than {} of this folder; render it again",
                        file.string(), kSceneFile));
}

/// The numbers of a scene's files in a folder, ascending. Frames beyond a duration that has become
/// shorter are no part of the film.
std::vector<int> numbers_in(const fs::path& folder, const Scene& scene, std::string_view end) {
    std::vector<int> numbers;
    std::error_code error;
    fs::directory_iterator at(folder, error);
    if (error == std::errc::no_such_file_or_directory) return numbers;
    for (; !error && at != fs::directory_iterator(); at.increment(error))
        if (const auto number = frame_number(at->path().filename().string(), scene.name, end);
            number && has_frame(scene, *number))
            numbers.push_back(*number);
    if (error)
        throw RunError(fmt::format("{}: cannot be read: {}", folder.string(), error.message()));
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

/// Makes previews that are missing or damaged from their images.
void mend_previews(const Scene& scene, const fs::path& folder) {
    const OverlayPainter painter(scene);
    std::vector<int> numbers;
    std::ranges::set_union(numbers_in(folder / "frames", scene, ".exr"),
                           preview_numbers(scene, folder), std::back_inserter(numbers));
    for (const int number : numbers) {
        const render::FrameFiles files = {image_file(scene, folder, number),
                                          preview_file(scene, folder, number)};
        const std::string damage = fs::exists(files.preview)
                                       ? damage_of_preview(scene, files.preview)
                                       : fmt::format("{}: is missing", files.preview.string());
        if (damage.empty()) continue;
        require_frame_of(scene, files.exr, number);
        if (!fs::exists(files.exr) || !mend_preview(scene, number, files, painter, damage))
            throw InputError(damage +
                             "; the same command that made the others makes that frame again");
    }
}

/// Says which frames that the folder shall have are not in the film.
void tell_missing(const Scene& scene, const fs::path& folder, const std::vector<int>& numbers) {
    const std::vector<int> wanted = wanted_frames(scene, folder);
    std::vector<int> missing;
    std::ranges::set_difference(wanted, numbers, std::back_inserter(missing));
    if (missing.empty()) return;
    tell(fmt::format("{}: {} of {} frames are missing in the film: {}", folder.string(),
                     missing.size(), wanted.size(), frames_text(missing)));
}

/// A hash of the previews that a film shows, with their numbers: another as soon as one is another,
/// whatever the clock says.
class Signature {
  public:
    void add(int number, const std::string& png) {
        const std::string head = fmt::format("{} {}\n", number, png.size());
        hash_.add(head.data(), head.size());
        hash_.add(png.data(), png.size());
    }
    std::string text() const { return hash_.hex(); }

  private:
    StreamHash hash_;
};

/// A film ends with a box of free space (ISO/IEC 14496-12, 8.1.2), which players skip: its length,
/// its type, these words and the signature of the previews that the film shows.
std::string signature_box(const std::string& signature) {
    const std::string content =
        "free"
        "tesserae previews " +
        signature;
    std::string box = {'\0', '\0', '\0', static_cast<char>(content.size() + 4)};
    return box + content;
}

void append(const PartialFile& file, std::string_view bytes) {
    off_t end = ::lseek(file.descriptor(), 0, SEEK_END);
    while (end >= 0 && !bytes.empty()) {
        const ssize_t written = ::pwrite(file.descriptor(), bytes.data(), bytes.size(), end);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) break;
        bytes.remove_prefix(static_cast<std::size_t>(written));
        end += written;
    }
    if (!bytes.empty()) throw RunError(file.message("cannot be written", errno));
}

/// The child's descriptor of what it writes.
constexpr int kOutput = 3;

/// A child process that reads what is sent to it. A socket instead of a pipe: one whose reader is
/// gone is an error of the call and no signal.
class Child {
  public:
    /// @param output   opened as kOutput
    Child(std::vector<std::string> words, const fs::path& output) {
        int ends[2];
        if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
            throw RunError(fmt::format("no socket: {}", std::strerror(errno)));
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
        posix_spawn_file_actions_addopen(&actions, kOutput, output.c_str(), O_RDWR, 0);
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        const int error =
            posix_spawnp(&process_, arguments[0], &actions, nullptr, arguments.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        close(ends[1]);
        socket_ = ends[0];
        if (error == 0) return;
        close(socket_);
        throw RunError(fmt::format("{}: {}", words[0], std::strerror(error)));
    }
    ~Child() {
        if (socket_ >= 0) close(socket_);
        if (process_ <= 0) return;
        kill(process_, SIGKILL);
        wait();
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// @return false: it reads no more
    bool send(std::string_view bytes) {
        while (!bytes.empty()) {
            const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (sent < 0 && errno == EINTR) continue;
            if (sent < 0) return false;
            bytes.remove_prefix(static_cast<std::size_t>(sent));
        }
        return true;
    }
    /// Ends its input and waits. @return why it did not do its work; empty: it did
    std::string finish() {
        close(socket_);
        socket_ = -1;
        const int status = wait();
        if (WIFSIGNALED(status))
            return fmt::format("was ended by signal {} ({})", WTERMSIG(status),
                               ::strsignal(WTERMSIG(status)));
        return status == 0 ? "" : "failed; it says why above";
    }

  private:
    int wait() {
        int status = 0;
        while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
        }
        process_ = 0;
        return status;
    }

    pid_t process_ = 0;
    int socket_ = -1;
};

/// What a player takes for sRGB: the previews' values, in the colour difference signals of HDTV.
constexpr const char* kFilter =
    "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p";

/// Previews of a transparent sky, over black.
constexpr const char* kOverBlack = "format=gbrap,premultiply=inplace=1,";

std::vector<std::string> ffmpeg_words(double frames_per_second, render::Sky sky) {
    return {"ffmpeg",
            "-hide_banner",
            "-loglevel",
            "error",
            "-xerror",
            "-y",
            "-f",
            "image2pipe",
            "-framerate",
            toml_text(frames_per_second),
            "-c:v",
            "png",
            "-i",
            "pipe:0",
            "-vf",
            (sky == render::Sky::kTransparent ? kOverBlack : "") + std::string(kFilter),
            "-c:v",
            "libx264",
            "-crf",
            "18",
            "-colorspace",
            "bt709",
            "-color_primaries",
            "bt709",
            "-color_trc",
            "iec61966-2-1",
            "-movflags",
            "+faststart",
            "-f",
            "mp4",
            fmt::format("file:/dev/fd/{}", kOutput)};
}

}  // namespace

std::vector<int> preview_numbers(const Scene& scene, const fs::path& folder) {
    std::vector<int> numbers = numbers_in(folder / "preview", scene, ".png");
    if (!fs::exists(folder / kFramesFile)) return numbers;
    // A draft's film has its frames, whatever others are there.
    const std::vector<int> wanted = wanted_frames(scene, folder);
    std::erase_if(numbers, [&](int n) { return !std::ranges::binary_search(wanted, n); });
    return numbers;
}

fs::path movie_file(const Scene& scene, const fs::path& folder) {
    return folder / (scene.name + ".mp4");
}

bool is_movie_current(const Scene& scene, const fs::path& folder) {
    const fs::path movie = movie_file(scene, folder);
    Signature signature;
    for (const int number : preview_numbers(scene, folder))
        signature.add(number, read_file(preview_file(scene, folder, number)));
    const std::string box = signature_box(signature.text());
    std::ifstream in(movie, std::ios::binary);
    std::string end(box.size(), '\0');
    in.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
    in.read(end.data(), static_cast<std::streamsize>(end.size()));
    return in && end == box;
}

bool has_ffmpeg() {
    const char* const path = std::getenv("PATH");
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');)
        if (access((fs::path(folder) / "ffmpeg").c_str(), X_OK) == 0) return true;
    return false;
}

MovieReport make_movie(const Scene& scene, const fs::path& folder, bool quiet) {
    const auto begin = std::chrono::steady_clock::now();
    mend_previews(scene, folder);
    const std::vector<int> numbers = preview_numbers(scene, folder);
    MovieReport report;
    report.file = movie_file(scene, folder);
    report.frames = numbers.size();
    report.frames_per_second = scene.render.frames_per_second / stride_of(numbers, folder);
    for (const int number : numbers)
        require_frame_of(scene, image_file(scene, folder, number), number);
    tell_missing(scene, folder, numbers);
    if (!has_ffmpeg())
        throw RunError(
            fmt::format("{}: needs ffmpeg, which is not installed (Debian's package ffmpeg)",
                        report.file.string()));

    // A killed run's ffmpeg may still write what it had of the film: into its own file, which it
    // has by its descriptor, and not into this one's.
    PartialFile(report.file).remove();
    PartialFile output(report.file);
    Child ffmpeg(ffmpeg_words(report.frames_per_second, scene.render.sky), output.partial());
    Progress progress("filming", "frames", numbers.size(), quiet);
    std::optional<Size> size;
    Signature signature;
    bool reads = true;
    try {
        for (std::size_t i = 0; i < numbers.size() && reads; ++i) {
            if (stop_requested()) throw Stopped();
            const fs::path file = preview_file(scene, folder, numbers[i]);
            const std::string png = read_file(file);
            const Size here = size_of(png, file);
            if (!size) size = here;
            if (here != *size)
                throw InputError(fmt::format("{}: has {}x{} pixels, the first preview {}x{}",
                                             file.string(), here[0], here[1], (*size)[0],
                                             (*size)[1]));
            signature.add(numbers[i], png);
            reads = ffmpeg.send(png);
            progress.update(i + 1);
        }
        std::string failure = ffmpeg.finish();
        if (stop_requested()) throw Stopped();
        const bool is_empty = fs::file_size(output.partial()) == 0;
        if (failure.empty() && (!reads || is_empty)) failure = "ended before it had made the film";
        if (!failure.empty())
            throw RunError(fmt::format("{}: ffmpeg {}", report.file.string(), failure));
        append(output, signature_box(signature.text()));
    } catch (...) {
        output.remove();
        throw;
    }
    output.publish();
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return report;
}

}  // namespace tesserae::scenes
