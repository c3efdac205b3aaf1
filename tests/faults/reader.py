# SPDX-License-Identifier: Apache-2.0
"""A growing trajectory can be read while it is written.

An open that meets a flush and fails works when tried again. What is read is right where the file's
time has not changed from before it was opened until all was read; else a flush came in between, and
rows may be zeros (scenes/trajectory/trajectory_driver.hpp says why): then it is to be read again.
HDF5 has a mode in which one process writes and others read (SWMR), but that needs a newer form of
file than many programs read.
"""

import re
import shutil
import subprocess

from work import Scale

# Of a second try, of the third, ... one at least has to work.
TRIES = 5
# Of the clock by which a writer flushes every 2 s.
SPEEDS = {"quick": (4,), "usual": (4, 40, 400), "all": (1, 4, 40, 400)}
DURATION = {"quick": 10, "usual": 40, "all": 200}
DUMPED = ("/particles/bodies/position/step", "/particles/bodies/position/time",
          "/particles/bodies/position/value", "/observables/kinetic_energy/value")


def run(words):
    found = subprocess.run(words, capture_output=True, text=True)
    is_good = found.returncode == 0 and "error" not in found.stderr and "unable" not in found.stderr
    return is_good, found.stdout, found.stderr


def values(text):
    """The numbers in what h5dump prints of a dataset."""
    data = text[text.find("DATA {"):].partition("}")[0]
    return re.findall(r"[-+0-9.einfa]+(?=[,\s])", re.sub(r"\([0-9,]+\):", "", data))


class Reader:
    """One way to read a file: how often it failed, and what it read."""

    def __init__(self, name, words):
        self.name, self.words, self.opens, self.failed, self.gave_up = name, words, 0, 0, []
        self.read, self.last_words = [], ""

    def look(self, file):
        for _ in range(TRIES):
            before = time_of(file)
            is_good, out, err = run([w if w != "FILE" else str(file) for w in self.words])
            after = time_of(file)
            if after is None:
                return  # it has its name by now
            self.opens += 1
            if is_good:
                self.read.append((out, before == after))
                return
            self.failed += 1
            self.last_words = err.strip()
        self.gave_up.append(err.strip())


def time_of(file):
    try:
        return file.stat().st_mtime_ns
    except FileNotFoundError:
        return None


def follow(setup, table, speed, duration):
    job = setup.of_scale(Scale(speed=speed, duration=duration), f"reader {speed}").jobs()[
        "simulate every step"]
    job.now.mkdir(parents=True)
    (job.now / "tmp").mkdir()
    (job.now / "s.toml").write_text(setup.of_scale(Scale(duration=duration), "").scale.scene())
    growing, whole = job.now / "out.h5.partial", job.now / "out.h5"
    readers = [Reader("tesserae info", [setup.program, "info", "FILE"])]
    if shutil.which("h5ls") and shutil.which("h5dump"):
        readers += [Reader("h5ls", ["h5ls", "-r", "FILE"])]
        readers += [Reader(f"h5dump {name}", ["h5dump", "-y", "-d", name, "FILE"]) for name in DUMPED]
    with job.popen(job.steps[0]) as writer:
        while writer.poll() is None:
            for reader in readers:
                # Before the first row there is nothing to be read.
                if growing.exists() and growing.stat().st_size > 4096:
                    reader.look(growing)
        err = writer.communicate()[1].decode()
    if writer.returncode != 0 or not whole.exists():
        table.add("a growing trajectory is finished beside readers", err.strip() or "it is not")
        return
    for reader in readers:
        print(f"        flushes every {2000 / speed:.0f} ms: {reader.name}: {reader.failed} of "
              f"{reader.opens} opens failed {reader.last_words[:200]!r}")
        table.add("a growing trajectory: what fails amid a flush works when tried again",
                  reader.gave_up[0] if reader.gave_up else None, reader.name)
        if "h5dump" not in reader.name:
            continue
        last = values(run([w if w != "FILE" else str(whole) for w in reader.words])[1])
        torn = 0
        for text, is_of_one_flush in reader.read:
            seen = values(text)
            wrong = next((i for i, (a, b) in enumerate(zip(seen, last)) if a != b), None)
            torn += wrong is not None
            if is_of_one_flush:
                table.add("a growing trajectory: what is read between two flushes is right",
                          None if wrong is None else f"value {wrong} of {len(seen)} is {seen[wrong]}, "
                          f"in the end {last[wrong]}", reader.name)
        print(f"            {len(reader.read)} read, {sum(one for _, one in reader.read)} of them between "
              f"two flushes; {torn} torn")


def check(setup, table, effort, case=None):
    for speed in SPEEDS[effort]:
        follow(setup, table, speed, DURATION[effort])
