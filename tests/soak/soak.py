# SPDX-License-Identifier: Apache-2.0
"""Watches two long jobs: memory that grows, files that stay open, energy that comes from nowhere.

usage: soak.py PROGRAM SECONDS CSV

simulate: 10,000 boxes with sleeping, for SECONDS. render: 240,000 frames of 16x9 pixels in one
process, for a quarter of that at most. Rows of the table: job, time [s], resident memory [MB], open
files, processor time [s]. Ends with 1 if a promise is not kept.
"""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

# The two jobs are looked at so often, if they last as long as they may.
SIMULATE_SAMPLES = 120
RENDER_SAMPLES = 900  # which ends sooner
# Resident memory may differ by this between the middle and the end [MB]: pages of the allocator.
MOST_GROWTH = 4.0
# Of the energy that the boxes had at first, in what they lose by falling.
MOST_GAIN = 1e-3


def observed(process):
    """Resident memory [MB], open files, processor time [s]; None once it has ended."""
    try:
        status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
        files = len(os.listdir(f"/proc/{process.pid}/fd"))
        times = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    except (FileNotFoundError, ProcessLookupError):
        return None
    resident = [line for line in status.splitlines() if line.startswith("VmRSS:")]
    if not resident:
        return None
    ticks = os.sysconf("SC_CLK_TCK")
    return int(resident[0].split()[1]) / 1024, files, (int(times[11]) + int(times[12])) / ticks


def watch(job, command, seconds, samples, table):
    """Runs a command for so long, then stops it by SIGTERM. Returns its rows."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    begin = time.monotonic()
    rows = []
    while (now := time.monotonic() - begin) < seconds:
        seen = observed(process)
        if seen is None:
            break
        rows.append((now, *seen))
        table.write(f"{job},{now:.1f},{seen[0]:.2f},{seen[1]},{seen[2]:.1f}\n")
        table.flush()
        time.sleep(seconds / samples)
    process.send_signal(signal.SIGTERM)
    status = process.wait()
    if status not in (0, 143):
        raise SystemExit(f"{job}: ended with {status}")
    return rows


def failures_of(job, rows):
    """What a job's rows show: its second half is compared with its middle."""
    half = rows[len(rows) // 2:]
    growth = max(row[1] for row in half[-5:]) - max(row[1] for row in half[:5])
    # Files that are being written come and go; one that is never closed stays in all later rows.
    before, after = (min(row[2] for row in part)
                     for part in (half[: len(half) // 2], half[len(half) // 2 :]))
    print(f"{job}: {len(rows)} samples, {rows[-1][0]:.0f} s, {rows[-1][3]:.0f} s of processor time,"
          f" {half[-1][1]:.1f} MB, grew by {growth:+.2f} MB in the second half, {before} and {after} files")
    if growth > MOST_GROWTH:
        yield f"{job}: memory grew by {growth:.1f} MB"
    if after > before:
        yield f"{job}: open files went from {before} to {after}"


def simulate(program, folder, seconds, table):
    """Simulates boxes that come to rest and fall asleep. Yields what is wrong."""
    boxes, file = folder / "boxes.toml", folder / "boxes.h5"
    text = subprocess.run([program, "generate", "boxes", "--bodies", "10000"], check=True,
                          capture_output=True, text=True).stdout
    boxes.write_text(text)
    long = ["--set", "physics.sleeping=true", "--set", "physics.duration=1e5",
            "--set", "render.frames_per_second=0.1"]
    rows = watch("simulate", [program, "simulate", boxes, "-o", file, "--quiet", *long], seconds,
                 SIMULATE_SAMPLES, table)
    yield from failures_of("simulate", rows)
    info = json.loads(subprocess.run([program, "info", f"{file}.partial", "--json"], check=True,
                                     capture_output=True, text=True).stdout)
    first, last = (info[f"energy, {which} row"]["value"] for which in ("first", "last"))
    print(f"simulate: {info['last step']} steps, energy {first:.6g} J at first, {last:.6g} J at the"
          f" end, deepest penetration {info['deepest penetration']['value']:.3g} m")
    if last > first + MOST_GAIN * abs(first):
        yield f"simulate: energy rose from {first} to {last} J"


def render(program, folder, seconds, table):
    """Renders small frames of a ball that flies. Yields what is wrong."""
    scene, moved = folder / "frames.toml", folder / "frames.h5"
    scene.write_text("[physics]\nduration = 8000\nsteps_per_second = 30\n"
                     "[render]\nsize = [16, 9]\nsamples = 4\n"
                     "[[body]]\nshape = \"hypersphere\"\nradius = 0.5\nvelocity = [0.01, 10, 0, 0]\n")
    subprocess.run([program, "simulate", scene, "-o", moved, "--quiet"], check=True,
                   stdout=subprocess.DEVNULL)
    rows = watch("render", [program, "render", scene, "--trajectory", moved, "-o", folder / "out",
                            "--quiet"], seconds, RENDER_SAMPLES, table)
    yield from failures_of("render", rows)
    print(f"render: {len(list((folder / 'out/frames').glob('*.exr')))} frames")


def main():
    program, seconds, csv = sys.argv[1], float(sys.argv[2]), pathlib.Path(sys.argv[3])
    with tempfile.TemporaryDirectory() as name, csv.open("w") as table:
        table.write("job,seconds,resident_mb,open_files,processor_seconds\n")
        folder = pathlib.Path(name)
        failures = [*simulate(program, folder, seconds, table),
                    *render(program, folder, seconds / 4, table)]
    for failure in failures:
        print("failed:", failure)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
