# SPDX-License-Identifier: Apache-2.0
"""The still in tesserae and Cycles: table with its head, pictures beside each other, error against
time. usage: report.py HEAD RAW_FOLDER RESULTS_FOLDER"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from report_accuracy import save

SHOWN = {("tesserae", "trace", "alone"): "tesserae, the slice's bodies alone",
         ("tesserae", "trace", "among"): "tesserae, among bodies beside the slice",
         ("cycles", "progressive_multi_jitter", "alone"): "Cycles"}
COLORS = ("tab:blue", "tab:green", "tab:orange")


def srgb(linear):
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def main():
    head_path, raw, folder = sys.argv[1:]
    with open(f"{raw}/cycles.csv") as file:
        text = file.read()
    with open(head_path) as head, open(f"{folder}/cycles.csv", "w") as out:
        out.write(head.read() + text)

    figure = plt.figure(figsize=(9, 8.2), layout="constrained")
    grid = figure.add_gridspec(2, 3, height_ratios=(1, 2))
    lines = figure.add_subplot(grid[1, :])
    rows = list(csv.DictReader(text.splitlines()))
    for column, ((way, label), color) in enumerate(zip(SHOWN.items(), COLORS)):
        axes = figure.add_subplot(grid[0, column])
        axes.imshow(srgb(np.load(f"{raw}/reference_{way[0]}_{way[2]}.npy")), origin="lower")
        axes.set_title(label, fontsize=9)
        axes.axis("off")
        own = [r for r in rows if (r["renderer"], r["way"], r["still"]) == way]
        lines.loglog([float(r["seconds"]) for r in own], [float(r["relative_rmse"]) for r in own],
                     "o-", color=color, label=label)
        for r in own:
            lines.annotate(r["samples"], (float(r["seconds"]), float(r["relative_rmse"])),
                           fontsize=7, xytext=(4, 3), textcoords="offset points")
    lines.set_xlabel("render time: processor time on one thread [s]")
    lines.set_ylabel("RMS error against the own converged picture / its mean")
    lines.grid(True, which="major", lw=0.3)
    lines.legend(title="numbers: samples a pixel", title_fontsize=8, fontsize=8)
    save(figure, f"{folder}/cycles.png")


main()
