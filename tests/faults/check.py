# SPDX-License-Identifier: Apache-2.0
"""Nothing is lost: what becomes of files when system calls fail, processes are killed, files are
damaged, two processes want one file, and a growing file is read.

    python3 check.py PROGRAM FOLDER [--quick | --all] [--only CHECK [--case JOB FAULT]]
"""

import argparse
import pathlib
import subprocess
import sys
import time

import damages
import failing_calls
import kills
import reader
import two_writers
from work import SEED, Setup, Table

CHECKS = {"failing_calls": failing_calls, "kills": kills, "damages": damages,
          "two_writers": two_writers, "reader": reader}


def compiled(folder):
    """The library that is loaded into the program."""
    library = folder / "faults.so"
    source = pathlib.Path(__file__).with_name("faults.c")
    subprocess.run(["cc", "-O1", "-Wall", "-Wextra", "-shared", "-fPIC", "-o", library, source, "-ldl"],
                   check=True)
    return library


def main():
    words = argparse.ArgumentParser()
    words.add_argument("program")
    words.add_argument("folder", type=pathlib.Path)
    words.add_argument("--quick", action="store_true")
    words.add_argument("--all", action="store_true")
    words.add_argument("--only", choices=CHECKS)
    words.add_argument("--case", nargs=2, metavar=("JOB", "FAULT"))
    given = words.parse_args()
    effort = "quick" if given.quick else "all" if given.all else "usual"
    given.folder.mkdir(parents=True, exist_ok=True)
    table, setup = Table(), Setup(given.program, compiled(given.folder), given.folder)
    begin = time.time()
    print(f"seed {SEED}", flush=True)
    for name, check in CHECKS.items():
        if given.only in (None, name):
            check.check(setup, table, effort, given.case)
            print(f"{name} done after {time.time() - begin:.0f} s", flush=True)
    return 0 if table.show() else 1


if __name__ == "__main__":
    sys.exit(main())
