// SPDX-License-Identifier: Apache-2.0
#include "scenes/program/options.hpp"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "parallel/threads.hpp"
#include "scenes/generate/generate.hpp"

namespace tesserae::scenes {
namespace {

constexpr const char* kExitStatuses =
    "Exit status: 0 done; 1 failed while running, or diff: not equal, status, join: not complete; "
    "2 command line or input file wrong; 130, 143 stopped by a signal, what is finished is kept";

void add_common(CLI::App& app, CommandLine& line) {
    app.add_option("--threads", line.threads, "threads (default: the cores granted to the process)")
        ->check(CLI::Range(1, parallel::kMostThreads));
    app.add_flag("--quiet", line.quiet, "no progress line");
    app.add_flag("--json", line.json, "one JSON object on standard output, at the end");
}

void add_scene(CLI::App& app, CommandLine& line) {
    add_common(app, line);
    app.add_option("scene", line.file, "scene file (TOML)")->required()->type_name("FILE.toml");
    app.add_option("--set", line.sets,
                   "one scene key, for example physics.iterations=20 or body.NAME.mass=2")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
}

void add_output(CLI::App& app, CommandLine& line, const char* what, const char* kind) {
    app.add_option("-o,--output", line.output, what)->required()->type_name(kind);
    app.add_flag("--overwrite", line.overwrite, "replace results of another scene");
}

void add_frames(CLI::App& app, CommandLine& line, const char* what) {
    app.add_option("--frames", line.frames, what);
}

constexpr const char* kFrames = "for example 0-239x2,300 (default: all)";

void add_picture(CLI::App& app, CommandLine& line, Typed& typed) {
    add_frames(app, line, kFrames);
    app.add_option("--size", typed.size, "WIDTHxHEIGHT, instead of the scene's");
    app.add_option("--samples", typed.samples, "a pixel, instead of the scene's");
    app.add_option("--crop", typed.crop, "x0,y0,x1,y1: pixels from the top left, half open");
    app.add_option("--integrator", typed.integrator, "how light is found, instead of the scene's")
        ->type_name("{direct,path}");
    app.add_option("--intersector", typed.intersector,
                   "how rays meet bodies, instead of the scene's")
        ->type_name("{trace,analytic}");
    app.add_flag("--draft", line.draft,
                 "a tenth of the time: small, few samples, direct, every second frame, into "
                 "DIR/draft");
}

void add_simulation(CLI::App& app, CommandLine& line) {
    app.add_option("--store-every", line.store_every,
                   "store every K-th step (default: the steps that the frames need)")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 53));
    app.add_option("--trace", line.trace,
                   "which thread simulated what when, as JSON for Perfetto or chrome://tracing")
        ->type_name("FILE.json");
}

void add_view(CLI::App& app, CommandLine& line) {
    CLI::App& view = *app.add_subcommand(
        "view", "one self-contained page, to look around in the slice with a browser");
    add_common(view, line);
    view.add_option("file", line.file,
                    "scene file (TOML), simulated first into FILE.h5 where bodies move; or a "
                    "trajectory (HDF5)")
        ->required()
        ->type_name("FILE.toml|h5");
    view.add_option("--set", line.sets, "one scene key, for example render.frames_per_second=12")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
    add_output(view, line, "the page", "FILE.html");
    add_frames(view, line, "that the page shows, for example 0 or 0-239x2 (default: all)");
    view.add_option("--near-slice", line.near_slice,
                    "leave out bodies that never come as near as this to the film's slice [m]")
        ->check(CLI::NonNegativeNumber);
}

void add_compare(CLI::App& app, CommandLine& line) {
    CLI::App& hash = *app.add_subcommand(
        "hash", "a short hash of what is in files, to compare on different machines");
    add_common(hash, line);
    hash.add_option(
            "files", line.files,
            ".h5, .exr or .toml files, or folders of frames: names, types and values count, "
            "not compression or program version")
        ->required()
        ->type_name("FILE.toml|h5|exr");

    CLI::App& diff = *app.add_subcommand(
        "diff", "where two trajectories, images, scenes or folders of frames first differ");
    add_common(diff, line);
    diff.add_option("files", line.files, "A and B, of one kind; exit status 1 if they differ")
        ->required()
        ->type_name("FILE.toml|h5|exr")
        ->expected(2);
}

void add_tools(CLI::App& app, CommandLine& line) {
    CLI::App& plot = *app.add_subcommand(
        "plot",
        "energies, momenta, contacts, overlap and residual over time, or what joints do, by "
        "gnuplot");
    add_common(plot, line);
    plot.add_option("file", line.file, "trajectory (HDF5)")->required()->type_name("FILE.h5");
    add_output(plot, line, "the picture", "FILE.svg|png");
    plot.add_option("--joint", line.joints,
                    "a joint's name: its impulses, errors and position instead")
        ->allow_extra_args(false);

    CLI::App& exported = *app.add_subcommand(
        "export", "the slice's bodies as meshes, a frame a file, for other programs");
    add_common(exported, line);
    exported.add_option("file", line.file, "trajectory (HDF5)")->required()->type_name("FILE.h5");
    exported
        .add_option("--set", line.sets,
                    "one key of the trajectory's scene, for example camera.position=[0,2,-8,0.5]")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
    exported.add_option("--format", line.format, "ply, or vtk (ParaView opens NAME.pvd)")
        ->required()
        ->check(CLI::IsMember({"ply", "vtk"}));
    add_output(exported, line, "folder for the meshes and the camera's path", "DIR");
    add_frames(exported, line, kFrames);
    exported
        .add_option("--tolerance", line.tolerance,
                    "how far a round body's mesh may be from its surface [m] (default: a "
                    "thousandth of its diameter)")
        ->check(CLI::PositiveNumber);
    exported
        .add_option("--extent", line.extent,
                    "where planes end: half the side of a cube about the first frame's camera [m] "
                    "(default: over a thousand times as far as any body at the start)")
        ->check(CLI::PositiveNumber);
}

void add_farm(CLI::App& app, CommandLine& line, Typed& typed) {
    CLI::App& submit = *app.add_subcommand("submit", "job scripts of a film for Slurm or any farm");
    add_scene(submit, line);
    add_output(submit, line, "folder that all nodes see: job scripts, trajectory, frames", "DIR");
    add_picture(submit, line, typed);
    FarmRequest& farm = line.farm;
    const auto count = CLI::Range(1, 10'000'000);
    submit.add_flag("--now", farm.now, "submit to Slurm, not only write the scripts");
    submit.add_option("--for", farm.kind, "slurm, or commands: one a task, for any other farm")
        ->check(CLI::IsMember({"slurm", "commands"}));
    submit.add_option("--partition", farm.partition, "Slurm's partition");
    submit.add_option("--account", farm.account, "Slurm's account");
    submit.add_option("--max-running", farm.max_running, "tasks at once")->check(count);
    submit.add_option("--cores", farm.cores, "of a task (default: 4)")->check(count);
    submit.add_option("--chunk", farm.chunk, "frames of a task (default: some minutes of them)")
        ->check(count);
    submit.add_option("--sbatch", farm.sbatch, "any further option of sbatch")
        ->allow_extra_args(false);

    CLI::App& join = *app.add_subcommand("join", "whole frames of the parts of render --tiles");
    add_common(join, line);
    join.add_option("folder", line.file, "folder of render")->required()->type_name("DIR");

    CLI::App& status = *app.add_subcommand(
        "status", "frames complete, missing, invalid; exit status 0 only when complete");
    add_common(status, line);
    status.add_option("folder", line.file, "folder of run, render or submit")
        ->required()
        ->type_name("DIR");
}

}  // namespace

void add_commands(CLI::App& app, CommandLine& line, Typed& typed) {
    // What it prints is not known here: see program().
    CLI::Option* version =
        app.set_version_flag("--version", "", "print version, commit, compiler and libraries");
    app.add_flag("--json", line.json, "of --version: as one JSON object")->needs(version);
    app.require_subcommand(1);
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::Throw);

    CLI::App& run = *app.add_subcommand("run", "simulate, render, preview: the main job");
    add_scene(run, line);
    add_output(run, line, "folder for the trajectory, frames, previews and report", "DIR");
    add_picture(run, line, typed);
    add_simulation(run, line);

    CLI::App& simulate = *app.add_subcommand("simulate", "move the bodies, store a trajectory");
    add_scene(simulate, line);
    add_output(simulate, line, "trajectory file (HDF5)", "FILE.h5");
    add_frames(simulate, line,
               "to the last of these, for example 0-9 (default: to the last of all)");
    add_simulation(simulate, line);

    CLI::App& render = *app.add_subcommand("render", "frames of a still, or of a trajectory");
    add_scene(render, line);
    add_output(render, line, "folder for the frames and previews", "DIR");
    render
        .add_option("--trajectory", line.trajectory,
                    "made by tesserae simulate (default: simulates first where bodies move)")
        ->type_name("FILE.h5");
    render.add_option("--tiles", typed.tiles,
                      "K/N: the K-th of N parts of each frame, for tesserae join");
    add_picture(render, line, typed);

    CLI::App& film = *app.add_subcommand("film", "an MP4 of a folder's previews, by ffmpeg");
    add_common(film, line);
    film.add_option("folder", line.file, "that run or render has made")
        ->required()
        ->type_name("DIR");

    add_view(app, line);

    CLI::App& plan =
        *app.add_subcommand("plan", "what a scene needs, what is left out, what it costs");
    add_scene(plan, line);
    add_frames(plan, line, kFrames);
    plan.add_option("--trajectory", line.trajectory,
                    "made by tesserae simulate: tells when bodies are in the picture")
        ->type_name("FILE.h5");

    CLI::App& info = *app.add_subcommand("info", "a summary of a scene, trajectory or image");
    add_common(info, line);
    info.add_option("file", line.file, "a scene, trajectory or image")
        ->required()
        ->type_name("FILE.toml|h5|exr");

    add_compare(app, line);
    add_tools(app, line);

    CLI::App& generate =
        *app.add_subcommand("generate", "a many-body scene, as TOML on standard output");
    generate.add_option("name", line.generator, "which")
        ->required()
        ->type_name(fmt::format("{{{}}}", fmt::join(kGenerators, ",")));
    generate.add_option("--bodies", line.bodies, "how many, beside floor and walls")
        ->required()
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000}));

    CLI::App& reference = *app.add_subcommand(
        "reference", "every table and key of scene files: unit, default, range, meaning");
    reference
        .add_option("topic", line.topic,
                    "a table, key or shape, for example render, body.friction, hyperbox; or "
                    "commands, man, completion (default: all of scene files)")
        ->type_name("TOPIC");
    reference.add_option("shell", line.shell, "of completion: a script to install for it")
        ->type_name("{bash,zsh,fish}");

    add_farm(app, line, typed);
    // Commands take over the footer that is there when they are added: none.
    app.footer(kExitStatuses);
}

}  // namespace tesserae::scenes
