# SPDX-License-Identifier: Apache-2.0
"""How the stages of a step grow with the bodies and shrink with the threads: one CSV file and plots.

usage: report_scaling.py HEAD SCALING_CSV RESULTS_FOLDER
HEAD holds the comment lines (machine, build, commit) that begin every CSV file; SCALING_CSV is what the
program scaling printed, every configuration several times.
"""

import collections
import csv
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from report_accuracy import save, write_csv

STAGES = ["advance_first_half", "find_pairs", "find_contacts", "build_islands",
          "solve_impacts", "integrate_velocities", "solve_islands", "advance_second_half",
          "apply_corrections", "finish_step"]
TIMES = ["step"] + STAGES
COLORS = dict(zip(STAGES, plt.get_cmap("tab10").colors))


def read(path):
    """{(scene, bodies, threads): {quantity: [value of every repeat]}}, in the order of the file."""
    runs = collections.defaultdict(lambda: collections.defaultdict(list))
    with open(path) as file:
        for row in csv.DictReader(file):
            key = row["scene"], int(row["bodies"]), int(row["threads"])
            runs[key][row["quantity"]].append(float(row["value"]))
    return runs


def spread_percent(values):
    """Largest less least, of the median."""
    middle = np.median(values)
    return 100 * (max(values) - min(values)) / middle if middle else 0


def medians(runs):
    return {key: {name: np.median(values) for name, values in quantities.items()}
            for key, quantities in runs.items()}


def ratios(of, scene, bodies, threads):
    """{stage: (1 thread over n, serial share)}. By Amdahl's law n threads take s + (1 - s)/n of the
    time, s the share that does not gain: what is serial, what waits, and what the memory limits."""
    table = {}
    if threads == 1 or (scene, bodies, 1) not in of or (scene, bodies, threads) not in of:
        return table
    one, many = of[scene, bodies, 1], of[scene, bodies, threads]
    for stage in TIMES:
        key = f"{stage}_ms"
        if one.get(key) and many.get(key):
            gain = one[key] / many[key]
            table[stage] = gain, (threads / gain - 1) / (threads - 1)
    return table


def weak_efficiency(of, scene, bodies, threads):
    """Time of 1 thread with its share of the bodies over that of all threads with all; or None."""
    share = of.get((scene, bodies // threads, 1))
    if threads == 1 or not share:
        return None
    return share["step_ms"] / of[scene, bodies, threads]["step_ms"]


def write_table(path, head, runs, of):
    rows = []
    for (scene, bodies, threads), quantities in runs.items():
        for name, values in quantities.items():
            rows.append([scene, bodies, threads, name, f"{np.median(values):.4g}",
                         f"{spread_percent(values):.1f}"])
        for stage, (speedup, serial) in ratios(of, scene, bodies, threads).items():
            rows.append([scene, bodies, threads, f"{stage}_speedup", f"{speedup:.3f}", ""])
            rows.append([scene, bodies, threads, f"{stage}_serial_share", f"{serial:.3f}", ""])
        weak = weak_efficiency(of, scene, bodies, threads)
        if weak:
            rows.append([scene, bodies, threads, "weak_efficiency", f"{weak:.3f}", ""])
    write_csv(path, head, ["scene", "bodies", "threads", "quantity", "median", "spread_percent"],
              rows)


def panels(scenes):
    figure, axes = plt.subplots(1, len(scenes), figsize=(3.6 * len(scenes), 4), sharey=True,
                                squeeze=False, layout="constrained")
    for axis, scene in zip(axes[0], scenes):
        axis.set_title(scene)
        axis.set_xscale("log")
        axis.set_xlabel("bodies")
    return figure, axes[0]


def sizes_of(of, scene, threads=1):
    return sorted(bodies for name, bodies, count in of if (name, count) == (scene, threads))


def most_threads(of):
    return max(threads for _, _, threads in of)


def plot_times(path, of, scenes):
    """One thread drawn through, all dashed."""
    figure, axes = panels(scenes)
    for axis, scene in zip(axes, scenes):
        axis.set_yscale("log")
        for stage in TIMES:
            for threads, line in ((1, "-"), (most_threads(of), "--")):
                sizes = sizes_of(of, scene, threads)
                times = [1e3 * of[scene, n, threads].get(f"{stage}_ms", np.nan) / n for n in sizes]
                axis.plot(sizes, times, line, color=COLORS.get(stage, "black"), marker=".",
                          label=stage if threads == 1 else None)
    axes[0].set_ylabel(f"µs a body and step (dashed: {most_threads(of)} threads)")
    axes[-1].legend(fontsize=7, bbox_to_anchor=(1.02, 1), loc="upper left")
    save(figure, path)


def plot_shares(path, of, scenes):
    figure, axes = panels(scenes)
    for axis, scene in zip(axes, scenes):
        sizes = sizes_of(of, scene)
        times = np.array([[of[scene, n, 1].get(f"{stage}_ms", 0) for n in sizes]
                          for stage in STAGES])
        bottom = np.zeros(len(sizes))
        for stage, share in zip(STAGES, 100 * times / times.sum(axis=0)):
            axis.bar(range(len(sizes)), share, bottom=bottom, color=COLORS[stage], label=stage)
            bottom += share
        axis.set_xscale("linear")
        axis.set_xticks(range(len(sizes)), [f"{n:.0e}" for n in sizes])
    axes[0].set_ylabel("share of the step, 1 thread [%]")
    axes[-1].legend(fontsize=7, bbox_to_anchor=(1.02, 1), loc="upper left")
    save(figure, path)


def plot_threads(path, of, scenes):
    """The step's gain, and the serial share that would explain it."""
    most = most_threads(of)
    figure, (gain, serial) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
    for scene in scenes:
        sizes = [n for n in sizes_of(of, scene) if "step" in ratios(of, scene, n, most)]
        of_step = np.array([ratios(of, scene, n, most)["step"] for n in sizes]).reshape(-1, 2)
        gain.plot(sizes, of_step[:, 0], ".-", label=scene)
        serial.plot(sizes, 100 * of_step[:, 1], ".-", label=scene)
    gain.axhline(most, color="gray", lw=0.5)
    gain.set_ylabel(f"step: time of 1 thread over that of {most}")
    serial.set_ylabel("serial share by Amdahl's law [%]")
    for axis in gain, serial:
        axis.set_xscale("log")
        axis.set_xlabel("bodies")
        axis.legend(fontsize=7)
    save(figure, path)


def plot_curves(path, of, scenes):
    """The gain of the step and of each stage against the threads, of the most bodies."""
    figure, axes = panels(scenes)
    for axis, scene in zip(axes, scenes):
        bodies = max(sizes_of(of, scene))
        counts = sorted(threads for name, n, threads in of if (name, n) == (scene, bodies))
        for stage in TIMES:
            gains = [1 if threads == 1 else
                     ratios(of, scene, bodies, threads).get(stage, [np.nan])[0]
                     for threads in counts]
            axis.plot(counts, gains, ".-", color=COLORS.get(stage, "black"), label=stage)
        axis.plot(counts, counts, color="gray", lw=0.5)
        axis.set_title(f"{bodies:.0e} {scene}")
        axis.set_xlabel("threads")
        axis.set_xscale("log", base=2)
        axis.set_yscale("log", base=2)
    axes[0].set_ylabel("time of 1 thread over that of all")
    axes[-1].legend(fontsize=7, bbox_to_anchor=(1.02, 1), loc="upper left")
    save(figure, path)


def main():
    head_path, path, results = sys.argv[1:]
    with open(head_path) as file:
        head = file.read()
    runs = read(path)
    of = medians(runs)
    scenes = list(dict.fromkeys(scene for scene, _, _ in of))
    os.makedirs(results, exist_ok=True)
    write_table(f"{results}/scaling.csv", head, runs, of)
    plot_times(f"{results}/time_per_body.png", of, scenes)
    plot_shares(f"{results}/shares.png", of, scenes)
    plot_threads(f"{results}/threads.png", of, scenes)
    if most_threads(of) > 2:
        plot_curves(f"{results}/curves.png", of, scenes)


main()
