# SPDX-License-Identifier: Apache-2.0
"""How still piles stand and how deep they overlap, against the time of a step: rest.csv, rest.png.

usage: report_rest.py HEAD REST_CSV RESULTS_FOLDER
HEAD holds the comment lines (machine, build, commit) that begin every CSV file; REST_CSV is what the
program rest printed. Bodies that have moved farther than FALLEN have fallen: their points are open,
since what lies on the floor is still too.
"""

import csv
import io
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from PIL import Image

# Less is drawn as this [mm/s].
STILL = 1e-5
FALLEN = 250  # [mm]
STYLES = {
    "bullet": ("tab:blue", "o", "-"),
    "ode": ("tab:gray", "s", "-"),
    "tesserae": ("tab:red", "D", "-"),
    "tesserae, all sweeps": ("tab:orange", "v", ":"),
    "tesserae, by steps": ("tab:purple", "^", "--"),
    "tesserae, sub-steps of 1": ("tab:olive", "P", "--"),
    "tesserae, sub-steps of 2": ("tab:green", "X", "--"),
}
DEFAULT = ("tesserae", 240, 1, 100)
# What a point's number counts along its curve.
COUNTED = {"tesserae, by steps": "steps_per_second"}


def number_of(row):
    if "sub-steps" in row["curve"]:
        return row["substeps"]
    return row[COUNTED.get(row["curve"], "iterations")]


def key_of(row):
    return row["curve"], float(row["steps_per_second"]), int(row["substeps"]), int(row["iterations"])


def curves_of(rows):
    """{curve: rows}; the default belongs to the curve by steps too."""
    curves = {}
    for row in rows:
        curves.setdefault(row["curve"], []).append(row)
    by_steps = curves["tesserae, by steps"]
    by_steps += [dict(r, curve="tesserae, by steps") for r in rows if key_of(r) == DEFAULT]
    by_steps.sort(key=lambda r: float(r["steps_per_second"]))
    return curves


def plot(rows, path):
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    figure, grid = plt.subplots(2, len(scenes), figsize=(4.6 * len(scenes), 8.6), sharex="col",
                                squeeze=False)
    for column, scene in enumerate(scenes):
        own = [row for row in rows if row["scene"] == scene]
        for axes, (quantity, label, floor) in zip(grid[:, column], (
                ("rms_speed_mm_s", "speed [mm/s], root mean square", STILL),
                ("overlap_mm", "deepest overlap [mm]", 1e-2))):
            for curve, points in curves_of(own).items():
                color, marker, line = STYLES[curve]
                x = [float(p["ms_per_240th"]) for p in points]
                y = [max(float(p[quantity]), floor) for p in points]
                stands = [float(p["moved_mm"]) < FALLEN for p in points]
                axes.loglog(x, y, line, color=color, lw=1.1, label=curve)
                for at_x, at_y, good, p in zip(x, y, stands, points):
                    axes.plot(at_x, at_y, marker, color=color, ms=5,
                              mfc=color if good else "white")
                    axes.annotate(number_of(p), (at_x, at_y), fontsize=6, color=color,
                                  xytext=(3, 3), textcoords="offset points")
            default = next(p for p in own if key_of(p) == DEFAULT)
            axes.plot(float(default["ms_per_240th"]), max(float(default[quantity]), floor), "*",
                      color="gold", mec="black", ms=13, zorder=5, label="the default")
            axes.set_ylabel(label)
            axes.grid(True, which="major", lw=0.3)
            axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axes.xaxis.set_major_formatter(FuncFormatter(lambda t, _: f"{t:g}"))
            axes.xaxis.set_minor_formatter(NullFormatter())
        grid[0, column].set_title(f"{scene.replace('_', ' ')}, {own[0]['bodies']} bodies",
                                  fontsize=10)
        grid[1, column].set_xlabel("processor time of 1/240 s [ms]")
    figure.tight_layout(rect=(0, 0.09, 1, 1))
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=4, fontsize=8,
                  title="numbers: sweeps, sub-steps or steps a second; open: something fell",
                  title_fontsize=8)
    buffer = io.BytesIO()
    figure.savefig(buffer, dpi=80)
    plt.close(figure)
    Image.open(buffer).convert("RGB").quantize(64, dither=Image.Dither.NONE).save(
        path, optimize=True)


def main():
    head, path, folder = sys.argv[1:]
    with open(path) as file:
        text = file.read()
    with open(head) as file, open(f"{folder}/rest.csv", "w") as out:
        out.write(file.read() + text)
    plot(list(csv.DictReader(io.StringIO(text))), f"{folder}/rest.png")


if __name__ == "__main__":
    main()
