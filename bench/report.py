"""Makes bench/results out of what the programs printed.

usage: report.py HEAD ACCURACY_CSV HOT_LOOPS_JSON CONTACTS_DOUBLE_JSON CONTACTS_FLOAT_JSON RESULTS_FOLDER
HEAD holds the comment lines (machine, build, commit) that begin every CSV file.
"""

import csv
import json
import re
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

# Errors below this are sums of rounded steps: they say nothing about an order.
ROUNDING = 1e-11
# Fewer points than this are not fitted.
POINTS_OF_FIT = 4
# A fit that misses by more than this factor, on average, is no power of the time step.
LARGEST_RESIDUAL = np.log(1.5)
DEFAULT_ITERATIONS = 10


def read_accuracy(path):
    """The rows of the program's CSV, numbers as float."""
    texts = ("motion", "quantity", "unit")
    with open(path) as file:
        return [
            {key: value if key in texts else float(value) for key, value in row.items()}
            for row in csv.DictReader(file)
        ]


def curves(rows):
    """Rows by (motion, quantity), in the order of their first appearance."""
    groups = {}
    for row in rows:
        groups.setdefault((row["motion"], row["quantity"]), []).append(row)
    return groups


def order_of(rows):
    """What to say of p in error = C h^p, fitted by least squares on logarithms."""
    seen = [row for row in rows if row["error"] > ROUNDING]
    if not seen:
        return "rounding"
    h = np.log([1 / row["steps_per_second"] for row in seen])
    error = np.log([row["error"] for row in seen])
    if len(seen) < POINTS_OF_FIT:
        return "no power"
    (order, constant) = np.polyfit(h, error, 1)
    residual = np.sqrt(np.mean((error - order * h - constant) ** 2))
    return f"{order:.2f}" if residual < LARGEST_RESIDUAL else "no power"


def write_csv(path, head, header, rows):
    with open(path, "w", newline="") as file:
        file.write(head)
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


def draw(axes, rows, label, style):
    time = [row["serial_us_per_s"] for row in rows]
    axes.loglog(time, [max(row["error"], 1e-17) for row in rows], style, ms=3, lw=1, label=label)


def plot_accuracy(by_step, by_iteration, orders, path):
    figure, (left, right) = plt.subplots(1, 2, figsize=(14, 7), sharey=True, layout="constrained")
    markers = "osv^D<>pP*Xh"
    for i, (key, rows) in enumerate(by_step.items()):
        label = f"{key[0]}: {key[1]} ({rows[0]['unit']}), order: {orders[key]}"
        draw(left, rows, label, "-" + markers[i % len(markers)])
    for key, rows in by_iteration.items():
        draw(right, rows, f"{key[0]}: {key[1]} ({rows[0]['unit']})", "-o")
        for row in rows:
            place = (row["serial_us_per_s"], max(row["error"], 1e-17))
            right.annotate(f"{row['iterations']:.0f}", place, fontsize=6, xytext=(2, 3),
                           textcoords="offset points")
    left.set_title("30 to 1920 steps per second, 10 iterations", fontsize=9)
    right.set_title("240 steps per second, 1 to 100 iterations", fontsize=9)
    left.set_ylabel("error")
    for axes in (left, right):
        axes.set_xlabel("run time of one simulated second [µs], serial")
        axes.grid(True, lw=0.3)
        axes.legend(fontsize=7, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncol=2)
    figure.savefig(path, dpi=90)


def report_accuracy(head, rows, results):
    by_step = curves(r for r in rows if r["iterations"] == DEFAULT_ITERATIONS)
    motions = {r["motion"] for r in rows if r["iterations"] != DEFAULT_ITERATIONS}
    by_iteration = curves(sorted(
        (r for r in rows if r["motion"] in motions and r["steps_per_second"] == 240),
        key=lambda r: r["iterations"]))
    orders = {key: order_of(group) for key, group in by_step.items()}
    plot_accuracy(by_step, by_iteration, orders, f"{results}/accuracy.png")

    write_csv(f"{results}/accuracy.csv", head, rows[0].keys(),
              [[f"{v:g}" if isinstance(v, float) else v for v in r.values()] for r in rows])
    table = []
    for key, group in by_step.items():
        at = {r["steps_per_second"]: r for r in group}
        table.append([*key, group[0]["unit"], orders[key], f"{at[60]['error']:.2g}",
                      f"{at[240]['error']:.2g}", f"{at[960]['error']:.2g}",
                      f"{at[240]['serial_us_per_s']:.3g}"])
    write_csv(f"{results}/accuracy_orders.csv", head,
              ["motion", "quantity", "unit", "order", "error_60", "error_240", "error_960",
               "serial_us_per_s_240"], table)


def read_benchmarks(path):
    """Every counter, and a wall time per iteration: (benchmark, quantity, median, spread)."""
    with open(path) as file:
        runs = json.load(file)["benchmarks"]
    found = {(run["run_name"], run["aggregate_name"]): run for run in runs}
    bookkeeping = {"family_index", "per_family_instance_index", "repetitions", "threads",
                   "iterations", "cpu_time", "real_time"}
    table = []
    runs.sort(key=lambda run: (run["family_index"], run["per_family_instance_index"]))
    for name in dict.fromkeys(run["run_name"] for run in runs):
        median, cv = found[name, "median"], found[name, "cv"]
        numbers = [k for k, v in median.items() if isinstance(v, float) and k not in bookkeeping]
        short = re.sub(r"(/iterations:\d+)?/(real|manual)_time$", "", name)
        for key in sorted(numbers):
            table.append((short, key, median[key], 100 * cv[key] if median[key] else 0))
        if name.endswith("/real_time"):
            table.append((short, f"{median['time_unit']}_per_run", median["real_time"],
                          100 * cv["real_time"]))
    return table


def write_benchmarks(path, head, table):
    write_csv(path, head, ["benchmark", "quantity", "median", "spread_percent"],
              [[name, key, f"{median:.4g}", f"{spread:.1f}"] for name, key, median, spread in table])


def ratios_to_bullet(table):
    """Ours over Bullet's, of the same run; spreads add up as for independent factors."""
    of = {(name, key): (median, spread) for name, key, median, spread in table}
    rows = []
    for (name, key), (median, spread) in of.items():
        (bullet, _, pair) = name.partition("/")
        if bullet.startswith("bullet") and not key.startswith("points") and median:
            ours = of[pair, key]
            rows.append((f"4D over {name}", f"ratio_{key}", ours[0] / median,
                         np.hypot(ours[1], spread)))
    return rows


def report_contacts(head, paths, results):
    """All of the first run; of the others what is Bullet's."""
    table = []
    for path in paths:
        run = read_benchmarks(path)
        is_first = not table
        table += [row for row in run if is_first or row[0].startswith("bullet")]
        table += ratios_to_bullet(run)
    write_benchmarks(f"{results}/contacts.csv", head, table)


def main():
    head_path, accuracy, hot_loops, *contacts, results = sys.argv[1:]
    with open(head_path) as file:
        head = file.read()
    report_accuracy(head, read_accuracy(accuracy), results)
    write_benchmarks(f"{results}/hot_loops.csv", head, read_benchmarks(hot_loops))
    report_contacts(head, contacts, results)


main()
