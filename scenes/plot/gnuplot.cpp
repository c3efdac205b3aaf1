// SPDX-License-Identifier: Apache-2.0
#include "scenes/plot/gnuplot.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "core/error.hpp"

namespace tesserae::scenes {
namespace {

[[noreturn]] void gnuplot_failed(const std::string& reason) {
    throw RunError("gnuplot: " + reason);
}

/// A file without a name, in memory: a process can read a long script from one while it writes into
/// another, where two pipes would each wait for the other end.
class MemoryFile {
  public:
    explicit MemoryFile(const std::string& content = {})
        : descriptor_(::memfd_create("gnuplot", MFD_CLOEXEC)) {
        if (descriptor_ < 0) gnuplot_failed(std::strerror(errno));
        for (std::size_t done = 0; done < content.size();) {
            const ssize_t count =
                ::pwrite(descriptor_, content.data() + done, content.size() - done, done);
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) gnuplot_failed(std::strerror(errno));
            done += static_cast<std::size_t>(count);
        }
    }
    ~MemoryFile() { ::close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    int descriptor() const { return descriptor_; }
    std::string content() const {
        std::string content;
        char piece[1 << 16];
        while (true) {
            const ssize_t count = ::pread(descriptor_, piece, sizeof piece, content.size());
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) gnuplot_failed(std::strerror(errno));
            if (count == 0) return content;
            content.append(piece, static_cast<std::size_t>(count));
        }
    }

  private:
    int descriptor_;
};

/// A variable of the environment as "NAME=value", or its default.
std::string variable(const char* name, const char* otherwise) {
    const char* value = std::getenv(name);
    return std::string(name) + "=" + (value ? value : otherwise);
}

pid_t start_gnuplot(const MemoryFile& script, const MemoryFile& output, const MemoryFile& said) {
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, script.descriptor(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, output.descriptor(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, said.descriptor(), STDERR_FILENO);

    // -d: no start-up files. The user's language and gnuplot's own variables would change the
    // bytes; the home folder is where lists of fonts are kept.
    std::string name = "gnuplot", option = "-d", script_name = "-";
    std::string path = variable("PATH", "/usr/bin:/bin"), home = variable("HOME", "/");
    std::string language = "LC_ALL=C.UTF-8";
    char* arguments[] = {name.data(), option.data(), script_name.data(), nullptr};
    char* environment[] = {path.data(), home.data(), language.data(), nullptr};
    pid_t child = 0;
    const int error = ::posix_spawnp(&child, "gnuplot", &files, nullptr, arguments, environment);
    posix_spawn_file_actions_destroy(&files);
    if (error == ENOENT) gnuplot_failed("is not installed; as root: apt-get install gnuplot-nox");
    if (error != 0) gnuplot_failed(std::strerror(error));
    return child;
}

}  // namespace

std::string gnuplot_output(const std::string& script) {
    const MemoryFile input(script), output, said;
    const pid_t child = start_gnuplot(input, output, said);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFSIGNALED(status))
        gnuplot_failed(fmt::format("was ended by signal {} ({})", WTERMSIG(status),
                                   ::strsignal(WTERMSIG(status))));
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        gnuplot_failed(
            fmt::format("failed with exit status {}: {}", WEXITSTATUS(status), said.content()));
    return output.content();
}

}  // namespace tesserae::scenes
