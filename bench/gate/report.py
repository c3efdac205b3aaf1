#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares two tables of the gate, row by row.

report.py BEFORE.csv AFTER.csv    prints the rows that changed and how many stayed; exits with 1 if any got worse.
report.py --all BEFORE.csv AFTER.csv    prints every row.

A row has changed where its value moved by more than twice the larger of both spreads and by more than a floor. The spread
is half of the range in which 95 of 100 values of the same program lie; values of two tables of the same program then differ
by more than twice of it in one of 200 rows. The floors are what nobody would see or use.
"""

import csv
import math
import sys

RELATIVE_FLOOR = 0.05  # the least part of a value that a change of it is worth

# By unit: changes below are nothing. Speeds: ten times the tolerance at which sweeps end, 1e-6 m/s. Lengths: a hundredth of
# a millimetre in scenes of metres; as parts of a size a twentieth of the overlap that is left alone, 0.0025 of it, and of
# thin bodies some times that. Energies: a ten-thousandth of what moves. Angular and linear momentum: a hundred times what
# rounding in double leaves of them.
FLOORS = {
    "mm/s": 0.01, "m/s": 1e-5, "mrad/s": 0.01, "mm": 0.01, "%": 0.01, "of its speed": 1e-3, "relative": 1e-5,
    "of the least size": 1e-4, "of the smallest": 1e-3, "of the thinnest": 0.01, "of the speed": 1e-3,
    "thousandths of the width": 0.1, "thousandths of the radius": 0.02, "% of the radius": 0.05,
    "of the sum of its parts": 1e-13, "of the sum of its parts a m": 1e-12,
}
# Times of a step repeat to some percent, even beside Bullet's in the same run. In ms they are told, not judged: they are
# those of one machine and of what else it did.
TIME_FLOOR = {"ratio": 0.08, "ms": 0}
# One scene that does otherwise may be chance; more are not, nor is a single one where none ever should.
COUNT_FLOOR, NEVER_FLOOR = 1.2, 0.4
NEVER = ("from nothing", "changed by", "passed through", "lost", "left the finite range")


class Row:
    def __init__(self, line):
        self.value, self.spread = float(line["value"]), float(line["spread"])
        self.unit, self.better = line["unit"], line["better"]
        self.is_never = any(words in line["quantity"] for words in NEVER)

    @property
    def is_time(self):
        return self.unit in TIME_FLOOR

    @property
    def floor(self):
        if self.is_time:
            return TIME_FLOOR[self.unit] * self.value
        if self.unit.startswith("runs") or (self.unit.startswith("of ") and self.unit[3:].isdigit()):
            return NEVER_FLOOR if self.is_never else COUNT_FLOOR
        return max(FLOORS[self.unit], RELATIVE_FLOOR * abs(self.value) if math.isfinite(self.value) else 0)


def read(path):
    with open(path, encoding="utf-8") as file:
        lines = csv.DictReader(line for line in file if not line.startswith("#"))
        return {(line["row"], line["quantity"]): Row(line) for line in lines}


def is_told(row, unit):
    """Of a scene that is timed, and run once, all but the time tells only what was timed."""
    return row.startswith("time: ") and unit not in TIME_FLOOR


def verdict(before, after):
    """'same', 'better' or 'WORSE'."""
    change = after.value - before.value
    if before.value == after.value or before.unit == "ms":
        return "same"
    if math.isfinite(change) and abs(change) <= max(2 * max(before.spread, after.spread), before.floor):
        return "same"
    if before.better == "equal":
        return "WORSE"
    return "better" if (change < 0) == (before.better == "less") else "WORSE"


def compare(before, after, print_all=False):
    """Prints the table; returns how many rows got worse."""
    counts = {"same": 0, "better": 0, "WORSE": 0}
    table = []
    for key, now in after.items():
        if key not in before:
            table.append((*key, now.unit, "", f"{now.value:.4g}", f"{now.spread:.2g}", "new"))
            continue
        was = before[key]
        says = "same" if is_told(key[0], was.unit) else verdict(was, now)
        counts[says] += 1
        if says != "same" or print_all:
            spread = max(was.spread, now.spread)
            table.append((*key, now.unit, f"{was.value:.4g}", f"{now.value:.4g}", f"{spread:.2g}", says))
    heads = ("row", "quantity", "unit", "before", "after", "spread", "verdict")
    if table:
        widths = [max(len(line[i]) for line in [heads, *table]) for i in range(len(heads))]
        for line in [heads, *table]:
            print("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip())
    gone = [key for key in before if key not in after]
    print(f"{counts['same']} rows the same, {counts['better']} better, {counts['WORSE']} worse"
          + (f", {len(gone)} not measured" if gone else ""))
    return counts["WORSE"]


def main(arguments):
    print_all = "--all" in arguments
    files = [argument for argument in arguments if argument != "--all"]
    if len(files) != 2:
        print("usage: report.py [--all] BEFORE.csv AFTER.csv", file=sys.stderr)
        return 2
    return 1 if compare(read(files[0]), read(files[1]), print_all) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
