# SPDX-License-Identifier: Apache-2.0
"""Error of the picture against run time: one table, plots and fitted slopes.

usage: report_picture.py HEAD PICTURE_CSV RESULTS_FOLDER
PICTURE_CSV is what picture_error and traced_rays printed. Writes picture_error.csv, and below
picture/ the plots and slopes.csv.
"""

import csv
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from report_accuracy import save, write_csv

# Errors below this [m] are rounding: no slope is fitted to them, and no less is drawn.
ROUNDING = 1e-14
# (experiment, what the value is, what the error is)
EXPERIMENTS = (
    ("samples", "samples", "RMS error against the own converged picture / mean"),
    ("sampler", "samples", "RMS error against the converged picture / mean"),
    ("tolerance", "tolerance", "RMS error of the distance [m]"),
    ("max_steps", "steps at most", "RMS error of the distance [m]"))


def slope(x, y):
    """Exponent p of y = c x^p by least squares on logarithms; empty without three points, or where
    x changes too little to say."""
    if len(x) < 3 or max(x) < 3 * min(x):
        return ""
    return f"{np.polyfit(np.log(x), np.log(y), 1)[0]:.2f}"


def main():
    head_path, path, folder = sys.argv[1:]
    with open(head_path) as file:
        head = file.read()
    with open(path) as file:
        rows = list(csv.DictReader(file))
    write_csv(f"{folder}/picture_error.csv", head, rows[0].keys(), [r.values() for r in rows])
    os.makedirs(f"{folder}/picture", exist_ok=True)

    slopes = []
    for experiment, value_name, error_name in EXPERIMENTS:
        figure, both = plt.subplots(1, 2, figsize=(11, 5), sharey=True, layout="constrained")
        ways = dict.fromkeys(r["way"] for r in rows if r["experiment"] == experiment)
        for way in ways:
            own = [r for r in rows if r["experiment"] == experiment and r["way"] == way]
            value, time, error = (np.array([float(r[k]) for r in own])
                                  for k in ("value", "ns", "error"))
            fit = error > ROUNDING
            over_value = slope(value[fit], error[fit])
            over_time = slope(time[fit], error[fit])
            slopes.append([experiment, way, over_value, over_time])
            style = {"marker": "o", "ms": 4, "ls": "--" if "plain" in way else "-",
                     "color": f"C{sorted({w.split()[0] for w in ways}).index(way.split()[0])}"}
            for axes, x, fitted in zip(both, (time, value), (over_time, over_value)):
                axes.loglog(x, np.maximum(error, ROUNDING / 10),
                            label=f"{way}: {fitted}" if fitted else way, **style)
        unit = "pixel" if value_name == "samples" else "ray"
        for axes, name in zip(both, (f"processor time of a {unit} [ns]", value_name)):
            axes.set_xlabel(name)
            axes.grid(True, which="major", lw=0.3)
            axes.legend(fontsize=8, title="slope, fitted", title_fontsize=8)
        both[0].set_ylabel(error_name)
        figure.suptitle(experiment)
        save(figure, f"{folder}/picture/{experiment}.png")
    write_csv(f"{folder}/picture/slopes.csv", head,
              ["experiment", "way", "error_over_value", "error_over_time"], slopes)


main()
