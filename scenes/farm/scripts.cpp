// SPDX-License-Identifier: Apache-2.0
#include "scenes/farm/scripts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/process/shell_word.hpp"
#include "scenes/process/version.hpp"

namespace tesserae::scenes {
namespace {

/// How every script finds the film's folder. Slurm runs a copy of the script from a folder of its
/// own, in the folder from which it was submitted.
constexpr const char* kFindFolder = R"sh(set -euo pipefail
folder=$(dirname "${BASH_SOURCE[0]}")/..
[ -f "$folder/submit/film.sh" ] || folder=${SLURM_SUBMIT_DIR:-$folder}
cd "$folder" 2>/dev/null && [ -f submit/film.sh ] || {
    echo "tesserae: $folder/submit is not seen from $(hostname): put the film's folder where all nodes see it" >&2
    exit 1
}
. submit/film.sh
)sh";

constexpr const char* kFilm = R"sh(# Sourced by the scripts beside it, in the film's folder.

# The program, where the nodes see it.
program={program}

# Its version, the first line of --version: frames of different ones are not mixed.
version={version}

found=$("$program" --version) || {{
    echo "tesserae: $program does not run on $(hostname)" >&2
    exit 1
}}
found=${{found%%$'\n'*}}
[ "$found" = "$version" ] || {{
    echo "tesserae: $program is \"$found\", the film was submitted for \"$version\": submit it again" >&2
    exit 1
}}

# Where bodies move: what simulate.sh makes.
trajectory={trajectory}
set_trajectory=()
[ -z "$trajectory" ] || set_trajectory=(--trajectory "$trajectory")

# Frames need the whole trajectory.
require_trajectory() {{
    [ -z "$trajectory" ] || [ -f "$trajectory" ] || {{
        if [ -f "$trajectory.partial" ]; then
            echo "tesserae: $PWD/$trajectory is not complete: submit/simulate.sh still writes it, or was stopped" >&2
        else
            echo "tesserae: $PWD/$trajectory is not there: run submit/simulate.sh first" >&2
        fi
        exit 1
    }}
}}

# render OPTIONS...: complete frames are kept. What a disturbed file system spoils is tried again.
render() {{
    local attempt status=0
    for attempt in 1 2 3; do
        status=0
        "$program" render submit/scene.toml ${{set_trajectory[@]+"${{set_trajectory[@]}}"}} \
            -o . --quiet "$@" || status=$?
        [ "$status" = 1 ] || return "$status"
        sleep "$attempt"
    done
    return "$status"
}}
)sh";

constexpr const char* kSimulate = R"sh(
# Continues what an earlier run has left; a complete trajectory is kept.
[ -z "$trajectory" ] || exec "$program" simulate submit/scene.toml -o "$trajectory" --quiet
)sh";

constexpr const char* kFrames = R"sh(
# Which frames: those of the command line, else of this task's line in tasks.txt.
[ $# != 0 ] || set -- $(sed -n "$((SLURM_ARRAY_TASK_ID + 1))p" submit/tasks.txt)
require_trajectory
render --frames "$@"
)sh";

constexpr const char* kFinish = R"sh(
# What tasks have lost is made here; usually nothing.
require_trajectory
render --frames "$(paste -sd , submit/tasks.txt)"
"$program" status .

# The MP4, by a program that can make one.
if "$program" film --help >/dev/null 2>&1; then
    "$program" film .
else
    echo "no MP4: this program has no command for it"
fi
)sh";

constexpr const char* kSubmit = R"sh(#!/usr/bin/env bash
# Submits the film to Slurm: simulate once, then the frames, then a last look at them. Run again, it
# submits what is missing; tasks whose frames are complete end at once.
{find}
if "$program" status . --quiet >/dev/null 2>&1; then
    echo "complete: nothing to submit"
    exit 0
fi
if [ -s submit/jobs ] && [ -n "$(squeue --noheader --jobs "$(paste -sd , submit/jobs)" 2>/dev/null)" ]; then
    echo "its jobs are in the queue: tesserae status tells how far they are"
    exit 0
fi
mkdir -p submit/log
simulated=$(sbatch --parsable submit/simulate.sh)
simulated=${{simulated%%;*}}
rendered=$(sbatch --parsable --dependency=afterok:"$simulated" --array={array} submit/frames.sh)
rendered=${{rendered%%;*}}
finished=$(sbatch --parsable --dependency=afterany:"$rendered" submit/finish.sh)
finished=${{finished%%;*}}
printf '%s\n' "$simulated" "$rendered" "$finished" >submit/jobs
echo "submitted: jobs $simulated (simulate), $rendered (frames), $finished (finish)"
)sh";

/// The lines for sbatch, each with a comment on what a site may want to change.
std::string directives(const FarmFilm& film, const char* part, const char* log, int cores,
                       int minutes) {
    std::string text;
    const auto line = [&](const char* comment, const std::string& option) {
        text += fmt::format("# {}\n#SBATCH {}\n", comment, option);
    };
    const FarmRequest& r = film.request;
    line("The name in the queue.", fmt::format("--job-name={}-{}", film.name, part));
    line("A log a task, in the film's folder; a requeued task goes on in it.",
         fmt::format("--output=submit/log/{}", log));
    text += "#SBATCH --open-mode=append\n";
    line("Cores of a task, all on one node; more make a frame faster, fewer start earlier.",
         fmt::format("--nodes=1 --ntasks=1 --cpus-per-task={}", cores));
    line("Memory of a task: half as much again as the plan's estimate.",
         fmt::format("--mem={}M", film.estimate.memory_mib));
    line(
        "Minutes until a task is ended: 15 and eight times the estimate. What is finished is kept.",
        fmt::format("--time={}", minutes));
    line("A task whose node fails begins again, and skips what is complete.", "--requeue");
    line("A job that waits for one that failed leaves the queue.", "--kill-on-invalid-dep=yes");
    if (!r.partition.empty()) line("Where it runs.", "--partition=" + shell_word(r.partition));
    if (!r.account.empty()) line("Who pays.", "--account=" + shell_word(r.account));
    for (const std::string& option : r.sbatch) line("As asked for.", option);
    return text;
}

std::string script(const char* what, const std::string& sbatch, const char* work) {
    return fmt::format("#!/usr/bin/env bash\n# {}\n{}{}{}", what, sbatch, kFindFolder, work);
}

}  // namespace

std::vector<FarmScript> farm_scripts(const FarmFilm& film) {
    const FarmEstimate& e = film.estimate;
    const std::string throttle =
        film.request.max_running > 0 ? fmt::format("%{}", film.request.max_running) : "";
    // A film that nothing moves in has no simulation, only the script's start.
    const int simulate_cores = film.moves ? e.cores : 1;
    return {
        {"film.sh", fmt::format(kFilm, fmt::arg("program", shell_word(film.program.string())),
                                fmt::arg("version", shell_word(version_line())),
                                fmt::arg("trajectory", film.moves ? "trajectory.h5" : ""))},
        {"simulate.sh",
         script("Moves the bodies: DIR/trajectory.h5.",
                directives(film, "simulate", "simulate-%j.log", simulate_cores, e.simulate_minutes),
                kSimulate)},
        {"frames.sh",
         script("Renders some frames: of a job array's task, or \"bash frames.sh 0-4\" anywhere.",
                directives(film, "frames", "frames-%A_%a.log", e.cores, e.frame_minutes), kFrames)},
        {"finish.sh",
         script("Checks every frame, makes what is missing, and the MP4.",
                directives(film, "finish", "finish-%j.log", e.cores, e.frame_minutes), kFinish)},
        {"submit.sh",
         fmt::format(kSubmit, fmt::arg("find", kFindFolder),
                     fmt::arg("array", fmt::format("0-{}{}", film.tasks.size() - 1, throttle)))},
        {"tasks.txt", fmt::format("{}\n", fmt::join(film.tasks, "\n"))}};
}

}  // namespace tesserae::scenes
