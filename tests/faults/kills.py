# SPDX-License-Identifier: Apache-2.0
"""A command that is stopped at any moment, politely or not, loses nothing: the same command then ends
with the bytes of one that nothing stopped."""

import random
import shutil
import signal
import subprocess

from work import SEED, Fault, Scale, in_parallel

# A command that is asked to stop ends within this [s].
SOON = 2
# Jobs that are stopped at random moments, long enough that moments differ; what the program does
# every two seconds it does here every 40 ms.
LARGER = Scale(size="[96, 64]", samples=4, duration=0.5, longer=1, speed=50)
AT_MOMENTS = ("simulate every step", "render", "run", "parts", "simulate longer", "run longer",
              "run otherwise")
# Of each signal, over all of these jobs.
MOMENTS = {"quick": 4, "usual": 200, "all": 1400}
# Every row is flushed at once: twelve rows, each of them all that a flush writes.
EVERY_FLUSH = Scale(speed=100_000)
AT_CALLS = ("simulate every step", "simulate longer", "simulate trace", "render", "parts", "join", "run",
            "run draft", "run longer", "run otherwise", "film", "view", "plot svg", "export vtk",
            "export ply", "submit")
CHANGES = "write,create,truncate,rename,unlink,mkdir"
CALLS = {"quick": 4, "usual": 40, "all": None}


def unreadable(job):
    """Unfinished trajectories that cannot be read: by us or, where it is installed, by HDF5's own
    program."""
    for file in job.now.rglob("*.h5.partial"):
        listed = subprocess.run(["h5ls", "-r", file] if shutil.which("h5ls") else
                                [job.setup.program, "info", file], capture_output=True, text=True)
        if listed.returncode != 0 or "error" in listed.stderr or "bodies" not in listed.stdout:
            yield str(file.relative_to(job.now))


def kill_at_moment(job, number, at, table):
    """@param at   as part of what the job takes undisturbed"""
    promise = f"{signal.Signals(number).name} at a random moment: {job.name}"
    job.reset()
    outcome = job.run(kill=(number, at * job.seconds))
    complaint = None
    if number == signal.SIGKILL:
        if outcome.status not in (0, -number):
            complaint = f"ended with {outcome.status}: {outcome.err.strip()}"
    elif outcome.status not in (0, 128 + number) and outcome.was_handled:
        complaint = f"ended with {outcome.status}: {outcome.err.strip()}"
    elif outcome.status == 128 + number and outcome.seconds > SOON:
        complaint = f"ended after {outcome.seconds:.1f} s"
    elif outcome.status == 128 + number and list(unreadable(job)):
        complaint = f"cannot be read: {', '.join(unreadable(job))}"
    damaged = list(job.damaged())
    if damaged:
        complaint = complaint or f"damaged: {', '.join(damaged)}"
    complaint = complaint or job.complaint_of_end(counts_temporary=False)
    table.add(promise, complaint, f"at {at:.4f} of {job.seconds:.2f} s")
    table.longest_stop = max(getattr(table, "longest_stop", 0),
                             outcome.seconds if outcome.status == 128 + number else 0)


def at_moments(job, table, effort):
    job.start()
    job.reset()
    job.seconds = job.run().seconds
    for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT):
        random_numbers = random.Random(f"{SEED} {job.name} {number}")
        for _ in range(-(-MOMENTS[effort] // len(AT_MOMENTS))):
            kill_at_moment(job, number, random_numbers.uniform(0, 1), table)


def kill_at_call(job, at, how, table):
    """@return whether all unfinished trajectories that were left can be read; None if there are none"""
    job.reset()
    outcome = job.run(fault=Fault(CHANGES, at, how))
    if not outcome.hits:
        return None
    has_unfinished = any(job.now.rglob("*.h5.partial"))
    complaint = None if outcome.status == -signal.SIGKILL else f"ended with {outcome.status}"
    damaged = list(job.damaged())
    if damaged:
        complaint = complaint or f"damaged: {', '.join(damaged)}"
    lost = list(unreadable(job))
    complaint = complaint or job.complaint_of_end(counts_temporary=False)
    table.add(f"SIGKILL at a call that changes files: {job.name}", complaint,
              f"--only kills --case '{job.name}' {Fault(CHANGES, at, how)} ({outcome.hits[0]})")
    return not lost if has_unfinished else None


def at_calls(job, table, effort):
    job.start()
    calls = job.calls(CHANGES.split(","))
    numbers = range(1, len(calls) + 1)
    if CALLS[effort] is not None and CALLS[effort] < len(numbers):
        numbers = sorted(random.Random(f"{SEED} {job.name}").sample(numbers, CALLS[effort]))
    readable_at = None
    for at in numbers:
        for how in ("kill", "cut") if calls[at - 1][0] == "write" else ("kill",):
            readable = kill_at_call(job, at, how, table)
            # From the first flush on it always can.
            if readable_at is not None and readable is not None:
                table.add(f"an unfinished trajectory can be read: {job.name}",
                          None if readable else "it cannot",
                          f"killed by {how} at {at}, while it could at {readable_at}")
            if readable:
                readable_at = at
    table.tell(f"SIGKILL at a call that changes files: {job.name}")


def check(setup, table, effort, case=None):
    if case:
        job = setup.of_scale(EVERY_FLUSH, "calls").jobs()[case[0]].start()
        fault = Fault.parse(case[1])
        kill_at_call(job, fault.at, fault.how, table)
        return
    jobs = setup.of_scale(EVERY_FLUSH, "calls").jobs()
    in_parallel(lambda name: at_calls(jobs[name], table, effort), AT_CALLS)
    larger = setup.of_scale(LARGER, "moments").jobs()
    in_parallel(lambda name: at_moments(larger[name], table, effort), AT_MOMENTS)
    print(f"the slowest stop by SIGTERM or SIGINT: {getattr(table, 'longest_stop', 0):.2f} s")
