# SPDX-License-Identifier: Apache-2.0
"""Makes the tables of the inner loops out of what the programs printed.

usage: report.py HEAD HOT_LOOPS_JSON CONTACTS_DOUBLE_JSON CONTACTS_FLOAT_JSON RESULTS_FOLDER
HEAD holds the comment lines (machine, build, commit) that begin every CSV file.
"""

import json
import re
import sys

import numpy as np

from report_accuracy import write_csv


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
    head_path, hot_loops, *contacts, results = sys.argv[1:]
    with open(head_path) as file:
        head = file.read()
    write_benchmarks(f"{results}/hot_loops.csv", head, read_benchmarks(hot_loops))
    report_contacts(head, contacts, results)


main()
