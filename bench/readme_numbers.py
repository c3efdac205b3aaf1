#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the two tables of numbers in the root README from the CSV files in bench/results.

usage: readme_numbers.py                  prints both tables
       readme_numbers.py --write README   replaces both tables in the file
       readme_numbers.py --check README   prints the lines that differ, and then exits with 1

In the file a table stands between `<!-- NAME: bench/readme_numbers.py -->` and `<!-- end -->`, where
NAME is `fast` or `well`. Links lead from the root of the repository. results/COLUMNS.md says what the
columns of the CSV files mean.
"""

import csv
import sys
from decimal import Decimal
from pathlib import Path

RESULTS = Path(__file__).resolve().parent / "results"
LINK = "bench/results"
END = "<!-- end -->"
# The program's own settings, as the CSV files of accuracy/ name them.
DEFAULTS = {"integrator": "midpoint", "substeps": "1", "iterations": "100",
            "steps_per_second": "240"}


def rows_of(name, **wanted):
    """Returns the rows of a CSV file whose wanted columns have the wanted texts: at least one."""
    with open(RESULTS / name, newline="", encoding="utf-8") as file:
        table = csv.DictReader(line for line in file if not line.startswith("#"))
        rows = [row for row in table if all(row[key] == text for key, text in wanted.items())]
    if not rows:
        raise LookupError(f"{name}: no row with {wanted}")
    return rows


def value(name, column, **wanted):
    """Returns the number in one column of the only row that is wanted."""
    rows = rows_of(name, **wanted)
    if len(rows) != 1:
        raise LookupError(f"{name}: {len(rows)} rows with {wanted}")
    return float(rows[0][column])


def machine_of(name):
    """Returns the machine that the first lines of a CSV file name, without remarks in brackets."""
    with open(RESULTS / name, encoding="utf-8") as file:
        line = next(line for line in file if line.startswith("# machine: "))
    model, cores = line.removeprefix("# machine: ").rstrip("\n").split(",")[:2]
    return model.replace("(R)", "").replace(" Processor", "") + "," + cores


def two_digits(number):
    """Returns a number rounded to two digits, without an exponent: 0.00030, 4.1, 54, 2500."""
    return format(Decimal(f"{number:.1e}"), "f") if number else "0"


def link(name):
    return f"[{Path(name).name}]({LINK}/{name})"


def pile():
    pile_of = {"scene": "sphere_pile", "bodies": "10000"}
    return ("one step of a pile of 10,000 spheres",
            value("peers.csv", "ms_per_step", engine="tesserae_default", **pile_of),
            value("peers.csv", "ms_per_step", engine="bullet_double", iterations="10", **pile_of),
            "ms; Bullet, 3D")


def wall():
    wall_of = {"bodies": "1000", "state": "hit"}
    return ("one step of a wall of 1000 boxes that a heavy ball has hit",
            value("wall.csv", "ms_per_step", engine="tesserae_default", **wall_of),
            value("wall.csv", "ms_per_step", engine="bullet_double", **wall_of),
            "ms; Bullet, 3D")


def heap():
    heap_of = {"scene": "tumbled_boxes", "bodies": "10000", "state": "settled"}
    return ("one step of a heap of 10,000 boxes",
            value("heaps.csv", "ms_per_step", engine="tesserae_default", **heap_of),
            value("heaps.csv", "ms_per_step", engine="bullet_double", **heap_of),
            "ms; Bullet, 3D")


def still():
    """Returns the row of the still, both at the error of Cycles at 64 samples.

    Bodies lie beside our slice as densely as in it, so that paths are as long as in 3D.
    """
    cycles = {"renderer": "cycles", "way": "progressive_multi_jitter", "samples": "64"}
    seconds = value("cycles.csv", "seconds", **cycles)
    noise = 100 * value("cycles.csv", "relative_rmse", **cycles)
    return (f"a path-traced still of 300 balls with {two_digits(noise)} % noise",
            seconds / value("cycles.csv", "over_among", **cycles), seconds, "s; Blender Cycles, 3D")


def threads():
    step_of = {"scene": "boxes", "bodies": "100000", "quantity": "step_ms"}
    return ("one step of 100,000 falling boxes, 16 cores",
            value("scaling-16-cores/scaling.csv", "median", threads="16", **step_of),
            value("scaling-16-cores/scaling.csv", "median", threads="1", **step_of),
            "ms; on one core")


def fast():
    """Returns the table of speeds."""
    sources = {"peers.csv": pile, "heaps.csv": heap, "wall.csv": wall, "cycles.csv": still,
               "scaling-16-cores/scaling.csv": threads}
    lines = ["| what (times of one thread; less is better) | tesserae, 4D | beside it | unit; what "
             "is beside it | from |", "|---|---|---|---|---|"]
    for name, row in sources.items():
        what, ours, other, unit = row()
        lines.append(f"| {what} | {two_digits(ours)} | {two_digits(other)} | {unit} | "
                     f"{link(name)}, {machine_of(name)} |")
    return lines


def well():
    """Returns the table of errors at the defaults."""
    lost = rows_of("extremes.csv", quantity="lost", unit="of 500")
    tower = {"case": "tower of 40 boxes, 10 s", "quantity": "moved at the end"}
    side = 1  # of those boxes [m]
    rows = [
        ("accuracy/free_box.csv", "angular velocity of a box that turns freely for 2 s",
         100 * value("accuracy/free_box.csv", "error", quantity="angular velocity", **DEFAULTS),
         "% of it"),
        ("accuracy/critical_angle.csv", "slope on which a box begins to slide",
         100 * value("accuracy/critical_angle.csv", "error", **DEFAULTS), "% of the slope"),
        ("accuracy/bounces.csv", "instants of a ball's first six bounces, in 3 s",
         1e3 * value("accuracy/bounces.csv", "error", quantity="bounce time", **DEFAULTS),
         "ms, at most"),
        ("extremes.csv", "how far a tower of 40 boxes of 1 m has moved after 10 s",
         1e3 * side * value("extremes.csv", "value", **tower), "mm, at most"),
        ("extremes.csv", "bodies that pass through a thin wall at which they are thrown",
         sum(float(row["value"]) for row in lost), f"of {500 * len(lost)}"),
    ]
    rate, sweeps = DEFAULTS["steps_per_second"], DEFAULTS["iterations"]
    lines = [f"| what (at the defaults, {rate} steps a second and {sweeps} iterations) | error | unit "
             "| from |", "|---|---|---|---|"]
    lines += [f"| {what} | {two_digits(error)} | {unit} | {link(name)} |"
              for name, what, error, unit in rows]
    return lines


TABLES = {"fast": fast, "well": well}


def place_of(lines, name):
    """Returns the first line of a table and the line after its last, counted from 0."""
    start = f"<!-- {name}: bench/readme_numbers.py -->"
    if start not in lines:
        raise LookupError(f"no line {start}")
    first = lines.index(start) + 1
    if END not in lines[first:]:
        raise LookupError(f"no line {END} after {start}")
    return first, lines.index(END, first)


def write(path):
    lines = path.read_text(encoding="utf-8").split("\n")
    for name, table in TABLES.items():
        first, last = place_of(lines, name)
        lines[first:last] = table()
    path.write_text("\n".join(lines), encoding="utf-8")


def check(path):
    """Prints every line that differs. Returns whether there is none."""
    lines = path.read_text(encoding="utf-8").split("\n")
    same = True
    for name, table in TABLES.items():
        first, last = place_of(lines, name)
        there, made = lines[first:last], table()
        for i in range(max(len(there), len(made))):
            has = there[i] if i < len(there) else "(no line)"
            should = made[i] if i < len(made) else "(no line)"
            if has != should:
                print(f"{path}:{first + i + 1}: is\n    {has}\nthe CSV files give\n    {should}")
                same = False
    return same


def main(arguments):
    if not arguments:
        print("\n\n".join("\n".join(table()) for table in TABLES.values()))
        return 0
    if len(arguments) != 2 or arguments[0] not in ("--write", "--check"):
        print(__doc__.split("\n\n")[1], file=sys.stderr)
        return 2
    try:
        path = Path(arguments[1])
        if arguments[0] == "--write":
            write(path)
            return 0
        return 0 if check(path) else 1
    except (LookupError, OSError) as error:
        print(f"readme_numbers.py: {arguments[1]}: {error}", file=sys.stderr)
        return 1


sys.exit(main(sys.argv[1:]))
