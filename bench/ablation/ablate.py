#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Switches off each mechanism of the contact solver alone and compares the gate's rows.

usage: ablate.py GATE RAW_FOLDER HEAD RESULT.csv
GATE: the program, built from the tree with switches.patch; RAW_FOLDER: keeps a table a mechanism, and one that is there and
newer than the program is not measured again; HEAD: the comment lines that begin the result.
"""

import collections
import csv
import math
import os
import pathlib
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "gate"))
from report import read, verdict  # noqa: E402

# Number in the list of mechanisms, name of the switch; first what most rows may notice.
MECHANISMS = [
    (13, "conjugate directions"), (12, "hold still"), (5, "effort of a load"), (7, "push"), (26, "seams"),
    (25, "rims"), (30, "impacts"), (11, "first loads"), (16, "unequal masses"), (9, "recalled too much"),
    (9, "recalled stop"), (14, "led away"), (3, "jam test"), (10, "best of recalled"), (6, "parted weight"),
    (6, "pushed bias"), (15, "resting gap"), (24, "slip by turning"), (29, "margin if one stops"),
    (2, "restitution cut"), (4, "driven targets"), (20, "slender responses"), (16, "coloured from 20, but from 100"),
    (5, "effort of a blow"), (5, "effort of a push"), (34, "least inertia"), (5, "least sweeps"),
    (5, "further sweeps"), (5, "more sweeps of few"), (5, "odd number"), (18, "half of the slip"),
    (7, "push turns little"), (29, "drift"), (27, "kept manifolds"), (28, "clearances"), (25, "rises of rims"),
    (25, "slips of rims"), (25, "rim ahead"), (25, "company of rims"), (5, "effort of a large blow"),
    (5, "effort of a bounce"), (5, "effort of a patch"), (16, "coloured from 20, but from 1000"), (16, "colours"),
    (20, "specks"), (21, "blow patches"), (34, "no response"), (33, "what needs leave out"), (32, "sleeping"),
]
# Not mechanisms, but defects that show which rows can fail.
DEFECTS = ["defect: one sweep", "defect: nothing recalled", "defect: friction without a cone",
           "defect: friction of nine tenths", "defect: restitution of 101 %"]
TIMED = ["time: wall of 1000 boxes", "time: pile of 1000 spheres", "time: heap of 1000 tumbled boxes"]
# Rows that take long and say little more than others.
LEFT_OUT = ["extreme: wall of 20 rows of 20 boxes, 10 s", "extreme: restitution 1, 10^5 steps",
            "extreme: tower of 10 boxes, steps of 1/2000 s, 4 s", "extreme: rod thrown at a wall of 1 mm",
            "extreme: slab thrown at a wall of 2 cm", "extreme: slab thrown at a wall of 1 mm, restitution 1",
            "extreme: pyramid of 55 boxes, 10 s", "rest: pyramid of 105 boxes", "rest: wall of 140 boxes"]
# Behind the others, as fewer mechanisms do anything to them.
MORE = ["properties of drawn scenes", "plates that meet", "plates thrown at a wall", "rides over seams",
        "found: press that closes on two boxes"]
# Scenes of families that take long.
SCENES = {"towers": 10, "thin heaps": 4, "found: press that closes on two boxes": 6, "rides over seams": 16}
LEFT = ("all", "left the finite range")
CHANCE = "nothing, several runs"
SLOWER = 1.3  # times of a step repeat to a tenth, on a machine that does other work too to a quarter


def run_gate(gate, table, name, rows, options):
    """A table of some rows without a mechanism; '' is with all."""
    if table.exists() and table.stat().st_mtime > gate.stat().st_mtime:
        return table
    calls = {}
    for row in rows:
        calls.setdefault(SCENES.get(row, 1000), []).append(row)
    lines, left = [], 0
    for scenes, chosen in calls.items():
        call = [gate, "--quick", "--scenes", str(scenes), *options, "--rows", *chosen]
        printed = subprocess.run(call, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True, text=True,
                                 env={**os.environ, "TESSERAE_WITHOUT": name}).stdout.splitlines()
        lines += [line for line in printed[1:] if not line.startswith('"all",')]
        left += sum(int(line.split(",")[3]) for line in printed if line.startswith('"all",'))
    lines.append(f'"all","left the finite range",runs,{left},0,{len(rows)},less')
    part = table.with_suffix(".part")
    part.write_text("\n".join(["row,quantity,unit,value,spread,samples,better", *lines, ""]))
    part.rename(table)
    print(table.name, file=sys.stderr, flush=True)
    return table


def measure(gate, folder, names):
    """Of each name its rows, whose scenes run once, those as they are. More rows, slow ones and times come behind all others, and what
    was not measured yet when this is interrupted is left out. Also the rows of all runs with all mechanisms, which show
    what chance does."""
    known = subprocess.run([gate, "--list"], capture_output=True, text=True, check=True).stdout.splitlines()
    slow = ["thin heaps"]
    rows = [row for row in known if not row.startswith("time: ") and row not in LEFT_OUT + MORE + slow]
    parts = {"rows": rows, "more": MORE, "slow": slow, "times": TIMED}
    tables = {name: {} for name in [CHANCE, *names]}

    def measure_one(kind, name):
        if kind == "times" and name in [CHANCE, *DEFECTS]:
            return
        table = folder / f"{re.sub('[^a-z0-9]+', '_', name) or 'all'}.{kind}.csv"
        options = [] if name == CHANCE else ["--runs", "1"]
        found = read(run_gate(gate, table, name, parts[kind], options))
        if LEFT in found and LEFT in tables[name]:
            found[LEFT].value += tables[name][LEFT].value
        tables[name].update(found)
    with ThreadPoolExecutor(2) as pool:
        jobs = [pool.submit(measure_one, kind, name) for kind in parts for name in [CHANCE, *names]]
        try:
            for job in jobs:
                job.result()
        except KeyboardInterrupt:
            pool.shutdown(wait=False, cancel_futures=True)
    for name in names:
        for key, row in tables[name].items():
            if not row.is_time and key in tables[CHANCE]:
                row.spread = 1.5 * tables[CHANCE][key].spread  # chance does more to one run than to the mean of some
    return [tables[name] for name in names]


def growth(before, after):
    """By what factor a row grew; infinite where it was nothing."""
    if not math.isfinite(after.value):
        return math.inf
    return abs(after.value) / abs(before.value) if before.value else math.inf


def times_of(before, after):
    """Of each timed scene, the time of a step without over that with, beside Bullet's."""
    return {key: after[key].value / row.value for key, row in before.items() if row.unit == "ratio" and key in after}


def judge(worse, better, times):
    if worse - better >= 5:
        return "essential"
    if worse > better or max(times.values(), default=1) >= SLOWER:
        return "earns its place"
    return "trades one for another" if worse else "nothing notices"


def find_restless(verdicts):
    """Rows that change whatever is switched off: of more than a third of the mechanisms. They say nothing of any."""
    counts = collections.Counter(key for says in verdicts.values() for key, word in says.items() if word != "same")
    return {key for key, count in counts.items() if 3 * count > len(verdicts)}


def print_table(lines):
    widths = [max(len(str(line[i])) for line in lines) for i in range(len(lines[0]))]
    for line in lines:
        print("  ".join(str(cell).ljust(width) for cell, width in zip(line, widths)).rstrip())


def main(arguments):
    gate, folder, head, result = (pathlib.Path(argument) for argument in arguments)
    folder.mkdir(parents=True, exist_ok=True)
    switches = [("", name) for name in DEFECTS] + MECHANISMS
    before, *tables = measure(gate, folder, [""] + [name for _, name in switches])
    tables = {name: table for (_, name), table in zip(switches, tables) if table}
    verdicts = {name: {key: verdict(row, after[key]) for key, row in before.items() if key in after and not row.is_time}
                for name, after in tables.items()}
    restless = find_restless({name: says for name, says in verdicts.items() if name not in DEFECTS})
    summary = [["number", "without", "worse", "better", "least time", "most time", "verdict", "worst row"]]
    lines = []
    for number, name in switches:
        if name not in tables:
            continue
        after, says = tables[name], verdicts[name]
        worse = sorted((key for key, word in says.items() if word == "WORSE"),
                       key=lambda key: -growth(before[key], after[key]))
        for key in worse + [key for key, word in says.items() if word == "better"]:
            lines.append([number, name, *key, before[key].unit, f"{before[key].value:.4g}", f"{after[key].value:.4g}",
                          f"{before[key].spread:.2g}", "restless" if key in restless else says[key].lower()])
        times = times_of(before, after)
        for key, ratio in times.items():
            lines.append([number, name, *key, "without over with", 1, f"{ratio:.3g}", "", "time"])
        worse = [key for key in worse if key not in restless]
        better = [key for key, word in says.items() if word == "better" and key not in restless]
        worst = ""
        if worse:
            key = worse[0]
            worst = f"{key[0]}: {key[1]}: {before[key].value:.3g} -> {after[key].value:.3g} {before[key].unit}"
        least, most = (f"{f(times.values()):.2f}" if times else "" for f in (min, max))
        summary.append([number, name, len(worse), len(better), least, most, judge(len(worse), len(better), times), worst])
    with result.open("w", newline="") as file:
        file.write(head.read_text())
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["number", "without", "row", "quantity", "unit", "with_all", "without_it", "spread", "verdict"])
        out.writerows(lines)
    print_table(summary)
    moved = {key for says in verdicts.values() for key, word in says.items() if word != "same"}
    all_rows = [key for key, row in before.items() if not row.is_time]
    for title, rows in ("changed whatever is off, not counted", restless), ("moved in none of these", set(all_rows) - moved):
        print(f"{len(rows)} of {len(all_rows)} rows {title}:")
        for key in sorted(rows):
            print(f"  {key[0]}: {key[1]}")


if __name__ == "__main__":
    main(sys.argv[1:])
