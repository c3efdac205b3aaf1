// SPDX-License-Identifier: Apache-2.0
#include "scenes/farm/submit.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>

#include "core/error.hpp"
#include "core/file/file_writer.hpp"
#include "scenes/farm/scripts.hpp"
#include "scenes/film/film.hpp"
#include "scenes/film/mattes.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/process/shell_word.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

fs::path this_program() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    if (error) throw RunError(fmt::format("/proc/self/exe: cannot be read: {}", error.message()));
    return program;
}

/// What film() makes before its first frame: tasks that begin at once shall find it.
void prepare_folder(const Scene& scene, const fs::path& folder) {
    for (const char* name : {"frames", "preview", "submit/log"}) create_folder(folder / name);
    write_file(folder / kSceneFile, scene.effective);
    write_file(folder / "submit" / "scene.toml", scene.effective);
    if (scene.render.channels.cryptomatte) mattes_of(scene, folder / "frames");
}

/// Options go into lines of the scripts, where the end of a line would begin a command.
void require_one_line(const char* option, const std::string& value) {
    const auto ends_line = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
    if (std::any_of(value.begin(), value.end(), ends_line))
        throw InputError(fmt::format("{} {}: holds a control character: expected one line of text",
                                     option, toml_text(value)));
}

void require_plain(const FarmRequest& request, const fs::path& folder) {
    require_one_line("--partition", request.partition);
    require_one_line("--account", request.account);
    for (const std::string& option : request.sbatch) require_one_line("--sbatch", option);
    // Commands are printed a line each.
    require_one_line("-o", folder.string());
}

}  // namespace

FarmReport write_farm(const Scene& scene, const std::vector<int>& frames, const fs::path& folder,
                      const FarmRequest& request, bool overwrite) {
    require_plain(request, folder);
    if (scene.render.crop)
        throw InputError(
            "--crop: a crop is no film; tesserae render --crop makes it, or use --size");
    require_folder_of(scene, folder, overwrite ? Replace::kAll : Replace::kNothing);
    prepare_folder(scene, folder);

    FarmFilm film;
    film.name = scene.name;
    film.program = this_program();
    film.estimate = estimate_farm(scene, frames.size(), request);
    film.moves = make_plan(scene, 1).moves;
    film.tasks = divide_frames(frames, film.estimate.chunk);
    film.request = request;

    FarmReport report;
    report.scripts = folder / "submit";
    report.estimate = film.estimate;
    report.moves = film.moves;
    for (const FarmScript& script : farm_scripts(film))
        write_file(report.scripts / script.name, script.text);
    const std::string script = shell_word(fs::absolute(report.scripts / "frames.sh").string());
    for (const std::string& task : film.tasks)
        report.commands.push_back(fmt::format("bash {} {}", script, task));
    return report;
}

ShellOutput shell_output(const std::string& command) {
    ShellOutput output;
    std::FILE* pipe = ::popen(command.c_str(), "r");
    if (pipe == nullptr) return {127, {}};
    char buffer[4096];
    while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, pipe))
        output.text.append(buffer, count);
    const int status = ::pclose(pipe);
    output.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    while (output.text.ends_with('\n')) output.text.pop_back();
    return output;
}

std::string submit_farm(const fs::path& scripts) {
    if (shell_output("command -v sbatch").status != 0)
        throw RunError(
            fmt::format("sbatch: not found, so that nothing is submitted; where Slurm is: bash {}",
                        shell_word((scripts / "submit.sh").string())));
    const std::string script = shell_word(fs::absolute(scripts / "submit.sh").string());
    const ShellOutput output = shell_output("bash " + script + " 2>&1");
    if (output.status != 0)
        throw RunError(fmt::format("{}: Slurm did not take it: {}",
                                   (scripts / "submit.sh").string(), output.text));
    return output.text;
}

}  // namespace tesserae::scenes
