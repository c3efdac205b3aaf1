# SPDX-License-Identifier: Apache-2.0
"""Every command survives system calls that fail: it says which file and why, damages nothing, and
the same command then makes all of it.

libfiu (Debian's fiu-utils) does not serve: it fails calls at random or by their stack, not the k-th
one, not those on the files of one folder, and cannot kill.
"""

import random
import re

from work import SEED, Fault, files_below, in_parallel

FOREVER = 1_000_000
# How calls of a family fail: what with, and how many in a row.
HOWS = {
    "write": [("ENOSPC", 1), ("ENOSPC", FOREVER), ("EIO", 1), ("EDQUOT", FOREVER), ("EINTR", 1),
              ("EINTR", 3), ("short", 1), ("fill", 1), ("short", FOREVER)],
    "sync": [("EIO", 1), ("ENOSPC", 1), ("EDQUOT", FOREVER), ("EINTR", 2)],
    "rename": [("EIO", 1), ("ENOSPC", 1), ("EDQUOT", FOREVER)],
    "open": [("EIO", 1), ("EMFILE", 1), ("EACCES", FOREVER), ("EINTR", 1)],
    "create": [("ENOSPC", 1), ("EDQUOT", FOREVER), ("EROFS", FOREVER)],
    "truncate": [("ENOSPC", 1), ("EIO", 1), ("EINTR", 1)],
    "map": [("ENOMEM", 1), ("EIO", 1)],
    "close": [("EIO", 1), ("ENOSPC", 1), ("EDQUOT", FOREVER), ("EINTR", 1), ("EINTR", FOREVER)],
    "read": [("EIO", 1), ("EIO", FOREVER), ("EINTR", 1), ("short", 1), ("short", FOREVER)],
    "list": [("EIO", 1)],
    "unlink": [("EIO", 1), ("EACCES", FOREVER)],
    "mkdir": [("ENOSPC", 1), ("EIO", FOREVER)],
    "stat": [("EIO", 1), ("EACCES", 1)],
    "lock": [("EINTR", 1), ("ENOLCK", 1)],
}
# What POSIX lets happen to any call, and is no failure.
HARMLESS = ("EINTR", "short")
# These may concern what the command was given, with which it then ends with 2.
READING = ("open", "map", "read", "list", "stat", "unlink", "mkdir", "lock")
# The commands that another program helps, and which calls of it fail.
HELPED = {"run": ["ffmpeg"], "film": ["ffmpeg"]}
# Cases of one family and one way to fail, of one command, beside those that are always taken.
USUAL, QUICK = 3, 0


def chosen(calls, count, random_numbers):
    """Which of a family's calls are hit: the first and the last on each kind of file, and `count`
    drawn ones; all if it is None. @return numbers from 1 on"""
    if count is None:
        return range(1, len(calls) + 2)
    kinds = {}
    for number, (_, path) in enumerate(calls, 1):
        kinds.setdefault(re.sub(r"\d+", "N", path), []).append(number)
    numbers = {n for kind in kinds.values() for n in (kind[0], kind[-1])}
    numbers.update(random_numbers.sample(range(1, len(calls) + 1), min(count, len(calls))))
    return sorted(numbers)


def says(err, fault, outcome):
    """Whether a message names the file that the call was about, or its folder, and the reason."""
    paths = {path for _, path in outcome.hits}
    names = {part for path in paths for part in (path, path.removesuffix(".partial"))}
    names |= {name.rsplit("/", 1)[1] for name in names}
    if fault.family == "sync":
        names.add("its folder")
    return any(name in err for name in names), fault.reason() in err


def complaint_about(job, fault):
    """Disturbs the job once. @return (what is wrong with what it did, whether it was disturbed)"""
    job.reset()
    outcome = job.run(fault=fault)
    if not outcome.hits:
        return None, False
    succeeded = outcome.status == 0
    if outcome.ended_by_signal():
        return f"ended by signal {-outcome.status}: {outcome.err.strip()}", True
    if outcome.status not in (0, 1, 2):
        return f"exit status {outcome.status}: {outcome.err.strip()}", True
    if fault.family not in READING and outcome.status == 2:
        return f"exit status 2 is for a wrong command line or file: {outcome.err.strip()}", True
    if fault.how in HARMLESS and fault.family != "open" and not succeeded:
        return f"nothing failed, but it ends with {outcome.status}: {outcome.err.strip()}", True
    if "starting anew" in outcome.err:
        return f"a failing call is taken for damage: {outcome.err.strip()}", True
    if job.name == "status" and outcome.status == 1:  # its answer: frames that cannot be read are invalid
        answers = re.search(r"^(missing|invalid) +[1-9]", outcome.out, re.M)
        return None if answers else f"what is not complete is not told: {outcome.out}", True
    if not succeeded:
        names_file, names_reason = says(outcome.err, fault, outcome)
        if not outcome.err.strip():
            return f"exit status {outcome.status} without a word", True
        if fault.program == "tesserae" and not names_file:
            return f"the message does not name {outcome.hits[0][1]}: {outcome.err.strip()}", True
        # A call that only asks whether a file is there has no words of its own in some libraries.
        if fault.program == "tesserae" and fault.family != "stat" and not names_reason:
            return f"the message does not say \"{fault.reason()}\": {outcome.err.strip()}", True
    damaged = list(job.damaged())
    if damaged:
        return f"exit status {outcome.status} and damaged: {', '.join(damaged)}", True
    if succeeded:
        differences = [text for text in job.differences()
                       if fault.family != "unlink" or "left over" not in text]
        if differences:
            return f"exit status 0, but {', '.join(differences)}", True
        wanted = job.undisturbed
        if wanted is not None and outcome.out != wanted:
            return f"exit status 0, but it prints {outcome.out!r} instead of {wanted!r}", True
    empty = [name for name in files_below(job.now)
             if name.endswith(".partial") and (job.now / name).stat().st_size == 0]
    if empty and fault.family not in ("unlink", "open", "stat", "lock"):
        return f"leaves empty: {', '.join(empty)}", True
    # What could not be removed among temporary files goes when it is a minute old.
    return job.complaint_of_end(counts_temporary=fault.how != "EACCES"), True


# What is printed by these depends on what is in files alone.
STEADY = ("status", "info scene", "info trajectory", "info frame", "hash", "diff")


def disturb(job, table, count):
    """All faults of one command."""
    random_numbers = random.Random(f"{SEED} {job.name}")
    job.start()
    job.reset()
    job.undisturbed = None
    if job.out:
        return  # its writes to standard output are none that can be reached from here: see damages.py
    job.undisturbed = job.run().out if job.name in STEADY else None
    programs = ["tesserae", *HELPED.get(job.name, [])]
    for program in programs:
        families = [f for f in HOWS if program == "tesserae" or f in ("write", "truncate", "close")]
        calls = job.calls(families, program)
        for family in families:
            of_family = [call for call in calls if call[0] == family]
            for how, last in HOWS[family] if of_family else ():
                if program != "tesserae" and how in HARMLESS:
                    continue  # another program may take it for a failure
                for number in chosen(of_family, count, random_numbers):
                    fault = Fault(family, number, how, last, program)
                    try_one(job, fault, table)
    table.tell(f"failing calls: {job.name}")


def try_one(job, fault, table):
    complaint, was_hit = complaint_about(job, fault)
    if was_hit:
        table.add(f"failing calls: {job.name}", complaint, f"--only '{job.name}' {fault}")


def check(setup, table, effort, only=None):
    """@param effort   "quick", "usual" or "all"
    @param only   (name of a job, a fault's text)"""
    jobs = setup.jobs()
    if only:
        job = jobs[only[0]].start()
        job.undisturbed = None
        try_one(job, Fault.parse(only[1]), table)
        return
    if effort == "quick":
        jobs = {name: jobs[name] for name in ("simulate", "join", "plot svg", "hash")}
    count = {"quick": QUICK, "usual": USUAL, "all": None}[effort]
    longest_first = sorted(jobs.values(), key=lambda job: not job.name.startswith("run "))
    in_parallel(lambda job: disturb(job, table, count), longest_first)
