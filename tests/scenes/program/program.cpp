// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/program/program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace tesserae::scenes::testing {

namespace fs = std::filesystem;

namespace {
int films_wanted = 0;
}

WithFilms::WithFilms() { ++films_wanted; }
WithFilms::~WithFilms() { --films_wanted; }

Outcome tesserae(const std::vector<std::string>& arguments, int signal, int milliseconds) {
    const Folder folder("program");
    const std::string out = folder.file("out"), err = folder.file("err");
    const auto begin = std::chrono::steady_clock::now();
    const pid_t child = fork();
    if (child == 0) {
        const auto redirect = [](const std::string& file, int to) {
            dup2(open(file.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), to);
        };
        redirect(out, STDOUT_FILENO);
        redirect(err, STDERR_FILENO);
        std::vector<std::string> words = arguments;
        words.insert(words.begin(), TESSERAE_PROGRAM);
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        if (films_wanted == 0 && !arguments.empty() && arguments.front() == "run")
            setenv("PATH", "/nonexistent", 1);
        execv(argv[0], argv.data());
        _exit(127);
    }
    if (signal != 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        kill(child, signal);
    }
    int status = 0;
    waitpid(child, &status, 0);
    Outcome outcome;
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    outcome.milliseconds =
        static_cast<int>((std::chrono::steady_clock::now() - begin) / std::chrono::milliseconds(1));
    outcome.out = content(out);
    outcome.err = content(err);
    return outcome;
}

bool is_installed(const std::string& program) {
    return std::system(fmt::format("command -v {} >/dev/null", program).c_str()) == 0;
}

std::string Folder::write(const std::string& name, const std::string& text) const {
    std::ofstream(path() / name, std::ios::binary) << text;
    return file(name);
}

std::vector<std::string> files_below(const fs::path& folder) {
    std::vector<std::string> files;
    if (fs::exists(folder))
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (!entry.is_symlink() && entry.is_regular_file())
                files.push_back(entry.path().lexically_relative(folder).string());
    std::sort(files.begin(), files.end());
    return files;
}

std::string small_scene(double duration) {
    return fmt::format(R"(
[physics]
duration = {}
steps_per_second = 60
[camera]
position = [0, 2, -6, 0]
look_at = [0, 0.5, 0, 0]
[render]
size = [64, 48]
samples = 2
frames_per_second = 20
tile = 16
[[light]]
type = "sun"
direction = [0.4, -1, 0.5, 0.2]
strength = 3
[[light]]
type = "sky"
strength = 0.4
[[body]]
name = "floor"
shape = "hyperplane"
normal = [0, 1, 0, 0]
offset = 0
[[body]]
name = "ball"
shape = "hypersphere"
radius = 0.5
position = [0.1, 3, 0, 0.1]
velocity = [0, -1, 0, 0]
angular_velocity = {{ xw = 3 }}
restitution = 0.6
[[lattice]]
name = "rain"
shape = "hypersphere"
radius = 0.25
count = [3, 3, 3, 1]
spacing = [0.6, 0.6, 0.6, 0.6]
jitter = 0.05
position = [0, 1.2, 0, 0]
)",
                       duration);
}

}  // namespace tesserae::scenes::testing
