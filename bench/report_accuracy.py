# SPDX-License-Identifier: Apache-2.0
"""Error against run time: one CSV file and one plot an experiment, fitted orders, and which way of
spending a step is best.

usage: report_accuracy.py HEAD ACCURACY_CSV RESULTS_FOLDER
HEAD holds the comment lines (machine, build, commit) that begin every CSV file; ACCURACY_CSV is what
the program accuracy printed. A way is (integrator, sub-steps, iterations); its points are its
numbers of steps a second.
"""

import collections
import csv
import io
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from PIL import Image

# Errors below this are sums of rounded steps: they say nothing about an order, and no less is drawn.
ROUNDING = 1e-11
# Fewer points than this are not fitted.
POINTS_OF_FIT = 4
# A fit that misses by more than this factor, on average, is no power of the time step.
LARGEST_RESIDUAL = np.log(1.5)
# Of the reference, not of a way: drawn as a line.
DOUBT = "doubt about the converged run"
# Noise by construction: not ranked.
STATISTICS = ("components against Gauss", "speeds against Maxwell", DOUBT)
DEFAULT = ("midpoint", 1, 100)
DEFAULT_STEPS = 240

Point = collections.namedtuple("Point", "steps error time row")


def write_csv(path, head, header, rows):
    with open(path, "w", newline="") as file:
        file.write(head)
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


def save(figure, path):
    """As PNG with few colours: a third of the size."""
    buffer = io.BytesIO()
    figure.savefig(buffer, dpi=80)
    plt.close(figure)
    Image.open(buffer).convert("RGB").quantize(64, dither=Image.Dither.NONE).save(
        path, optimize=True)


def read(path):
    """{experiment: {(quantity, unit): {way: [Point]}}}, all in the order of the file."""
    tree = {}
    with open(path) as file:
        for row in csv.DictReader(file):
            way = (row["integrator"], int(row["substeps"]), int(row["iterations"]))
            point = Point(int(row["steps_per_second"]), float(row["error"]),
                          float(row["us_per_s"]), row)
            ways = tree.setdefault(row["experiment"], {}).setdefault(
                (row["quantity"], row["unit"]), {})
            ways.setdefault(way, []).append(point)
    return tree


def order_of(points):
    """What to say of p in error = C h^p, fitted by least squares on logarithms."""
    seen = [p for p in points if p.error > ROUNDING]
    if not seen:
        return "rounding"
    if len(seen) < POINTS_OF_FIT:
        return "no power"
    h = np.log([1 / p.steps for p in seen])
    error = np.log([p.error for p in seen])
    (order, constant) = np.polyfit(h, error, 1)
    residual = np.sqrt(np.mean((error - order * h - constant) ** 2))
    return f"{order:.2f}" if residual < LARGEST_RESIDUAL else "no power"


def label_of(way, of_integrators=False):
    integrator, substeps, iterations = way
    if of_integrators:
        return integrator
    return f"{substeps} x {iterations}"


def style_of(way):
    integrator, substeps, iterations = way
    palette = {1: "Blues", 2: "Reds", 4: "Purples", 8: "Greys"}
    depth = {5: 0.3, 10: 0.45, 30: 0.6, 100: 0.8, 300: 1.0}.get(iterations, 0.7)
    color = "tab:green" if integrator == "euler" else plt.get_cmap(palette[substeps])(depth)
    return {"color": color, "marker": "o^sDvP"[[1, 2, 4, 8].index(substeps)],
            "ms": 4.5, "lw": 1.2}


def plot(name, quantities, path):
    doubt = next((w[DEFAULT][0].error for (q, _), w in quantities.items() if q == DOUBT), None)
    shown = {key: ways for key, ways in quantities.items() if key[0] != DOUBT}
    columns = min(2, len(shown))
    rows = -(-len(shown) // columns)
    height = 1.4 + 3.9 * rows
    figure, grid = plt.subplots(rows, columns, figsize=(max(8, 1 + 5.5 * columns), height),
                                squeeze=False)
    for axes in grid.flat[len(shown):]:
        axes.axis("off")
    of_integrators = any(way[0] == "euler" for ways in shown.values() for way in ways)
    for axes, ((quantity, unit), ways) in zip(grid.flat, shown.items()):
        for way, points in ways.items():
            axes.loglog([p.time for p in points], [max(p.error, ROUNDING / 100) for p in points],
                        label=label_of(way, of_integrators), **style_of(way))
        if doubt:
            axes.axhline(doubt, color="k", lw=0.8, ls=":", label="doubt about the converged run")
        most = max(p.error for points in ways.values() for p in points)
        if most < ROUNDING:
            axes.set_ylim(ROUNDING / 200, ROUNDING)
        elif axes.get_ylim()[1] < 10 * axes.get_ylim()[0]:
            axes.set_ylim(most / 20, 3 * most)
        order = order_of(ways[DEFAULT])
        order = f"order {order} at the default" if order[-1].isdigit() else order
        axes.set_title(f"{quantity}; {order}", fontsize=10)
        axes.set_ylabel(f"error [{unit}]")
        axes.set_xlabel("processor time of one simulated second [µs]")
        axes.grid(True, which="major", lw=0.3)
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda t, _: f"{t:g}"))
        axes.xaxis.set_minor_formatter(NullFormatter())
    figure.suptitle(name.replace("_", " "))
    figure.tight_layout(rect=(0, 1 / height, 1, 1))
    handles, labels = grid.flat[0].get_legend_handles_labels()
    if len(labels) > 1:
        way = "integrator" if of_integrators else "sub-steps x iterations"
        figure.legend(handles, labels, loc="lower center", ncol=5, fontsize=8,
                      title=f"{way}; points: steps a second, rising to the right",
                      title_fontsize=8)
    save(figure, path)


def compared(tree):
    """(experiment, quantity, ways) of what the ways' ranks are about: several ways, an error that
    is more than rounding, and no noise."""
    for experiment, quantities in tree.items():
        for (quantity, _), ways in quantities.items():
            worst = max(p.error for points in ways.values() for p in points)
            if len(ways) > 2 and worst > ROUNDING and quantity not in STATISTICS:
                yield experiment, quantity, ways


def at_default(ways):
    return next(p for p in ways[DEFAULT] if p.steps == DEFAULT_STEPS)


def ranks_of(tree):
    """Per way and budget of time, in parts of the default's at 240 steps a second: the mean rank by
    the least error within the budget, and how often no other way does better by 5 %."""
    budgets = (0.25, 0.5, 1, 2)
    ranks = collections.defaultdict(lambda: collections.defaultdict(list))
    wins = collections.defaultdict(collections.Counter)
    for _, _, ways in compared(tree):
        for budget in budgets:
            limit = budget * at_default(ways).time
            best = {way: min((max(p.error, ROUNDING) for p in points if p.time <= 1.05 * limit),
                             default=np.inf) for way, points in ways.items()}
            least = min(best.values())
            for way, error in best.items():
                better = sum(other < error / 1.05 for other in best.values())
                alike = sum(error / 1.05 <= other <= error * 1.05 for other in best.values()) \
                    if np.isfinite(error) else sum(not np.isfinite(o) for o in best.values())
                ranks[way][budget].append(better + (alike + 1) / 2)
                wins[way][budget] += bool(np.isfinite(error) and error <= 1.05 * least)
    return [[*way, *(x for b in budgets for x in (f"{np.mean(ranks[way][b]):.2f}", wins[way][b]))]
            for way in ranks], budgets


def ratios_of(tree):
    """(way, steps, time, error): geometric means of the ratios to the default at 240 steps a second
    over the experiments, of which each counts once, its quantities sharing. An error counts as a
    thousandth or a thousand of the default's at most, and as 1e-9 at least."""
    by_point = collections.defaultdict(lambda: collections.defaultdict(list))
    for experiment, _, ways in compared(tree):
        reference = at_default(ways)
        for way, points in ways.items():
            for p in points:
                ratio = max(p.error, 1e-9) / max(reference.error, 1e-9)
                by_point[way, p.steps][experiment].append(
                    (np.log(p.time / reference.time), np.log(np.clip(ratio, 1e-3, 1e3))))
    every = max(len(v) for v in by_point.values())
    rows = []
    for (way, steps), experiments in by_point.items():
        if len(experiments) == every:  # else the means are over other experiments
            time, error = np.exp(np.mean([np.mean(v, axis=0) for v in experiments.values()], axis=0))
            rows.append((way, steps, time, error))
    return rows, every


def report_ways(head, tree, folder):
    ratios, count = ratios_of(tree)
    front = [r for r in ratios
             if not any(o[2] <= r[2] and o[3] <= r[3] and o != r for o in ratios)]
    front.sort(key=lambda r: r[2])
    header = ["integrator", "substeps", "iterations"]
    write_csv(f"{folder}/pareto.csv", head,
              header + ["steps_per_second", "time_ratio", "error_ratio", "on_front"],
              [[*way, steps, f"{time:.3f}", f"{error:.3f}", int((way, steps, time, error) in front)]
               for way, steps, time, error in ratios])
    ranks, budgets = ranks_of(tree)
    write_csv(f"{folder}/ranks.csv", head,
              header + [f"{kind}_at_{b:g}" for b in budgets for kind in ("rank", "best")], ranks)

    figure, axes = plt.subplots(figsize=(9, 6.5), layout="constrained")
    for way in dict.fromkeys(r[0] for r in ratios):
        own = sorted((r for r in ratios if r[0] == way), key=lambda r: r[1])
        axes.loglog([r[2] for r in own], [r[3] for r in own], label=label_of(way), **style_of(way))
        axes.annotate(f"{own[-1][1]}", own[-1][2:], fontsize=7, xytext=(4, -3),
                      textcoords="offset points")
    axes.step([r[2] for r in front], [r[3] for r in front], where="post", color="gold", lw=6,
              alpha=0.5, zorder=0, label="Pareto front")
    axes.set_xlabel("run time over the default's (1 x 10 at most, 240 steps a second)")
    axes.set_ylabel("error over the default's")
    axes.set_title(f"Geometric means over {count} experiments; the number is the most steps a second",
                   fontsize=10)
    axes.grid(True, which="both", lw=0.2)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
        axis.set_minor_formatter(NullFormatter())
    axes.legend(fontsize=8, title="sub-steps x iterations", title_fontsize=8)
    save(figure, f"{folder}/pareto.png")


def report(head, path, folder):
    """Writes NAME.csv and NAME.png of every experiment, orders.csv, ranks.csv, pareto.csv and .png"""
    os.makedirs(folder, exist_ok=True)
    tree = read(path)
    orders = []
    for name, quantities in tree.items():
        rows = [p.row for ways in quantities.values() for points in ways.values() for p in points]
        header = [key for key in rows[0] if key != "experiment"]
        write_csv(f"{folder}/{name}.csv", head, header, [[r[k] for k in header] for r in rows])
        plot(name, quantities, f"{folder}/{name}.png")
        for (quantity, unit), ways in quantities.items():
            for way, points in ways.items():
                at = {p.steps: p for p in points}
                orders.append([name, quantity, unit, *way, order_of(points),
                               *(f"{at[s].error:.2g}" if s in at else "" for s in (60, 240, 960))])
    write_csv(f"{folder}/orders.csv", head,
              ["experiment", "quantity", "unit", "integrator", "substeps", "iterations",
               "order", "error_60", "error_240", "error_960"], orders)
    report_ways(head, tree, folder)


def main():
    head_path, accuracy, folder = sys.argv[1:]
    with open(head_path) as file:
        report(file.read(), accuracy, folder)


if __name__ == "__main__":
    main()
