# SPDX-License-Identifier: Apache-2.0
"""Two processes that want the same file: one is told so, or both are right; nothing is damaged."""

import random
import subprocess

from work import SEED, in_parallel

TOLD = "is being written by another process"
# Pairs of one command, and pairs of different ones that work in one folder by intent.
ALIKE = ("simulate every step", "simulate longer", "render", "run", "run longer", "run otherwise", "join",
         "film", "view", "plot svg", "export ply", "submit")
COUNT = {"quick": 2, "usual": 25, "all": 200}


def run_both(job, first, second, delay):
    """@return their outcomes"""
    with job.popen(first) as a:
        try:
            a.wait(timeout=delay)
        except subprocess.TimeoutExpired:
            pass
        with job.popen(second) as b:
            err_b = b.communicate()[1].decode()
        err_a = a.communicate()[1].decode()
    return (a.returncode, err_a), (b.returncode, err_b)


def complaint_about(job, outcomes, may_be_told):
    for status, err in outcomes:
        if status not in (0, 1):
            return f"ended with {status}: {err.strip()}"
        if status == 1 and TOLD not in err:
            return f"ended with 1 for another reason: {err.strip()}"
        if status == 1 and not may_be_told:
            return f"was told: {err.strip()}"
    if all(status != 0 for status, _ in outcomes):
        return "both gave up"
    damaged = list(job.damaged())
    return f"damaged: {', '.join(damaged)}" if damaged else job.complaint_of_end()


def alike(job, table, effort):
    job.start()
    job.reset()
    seconds = job.run().seconds
    numbers = random.Random(f"{SEED} {job.name}")
    for _ in range(COUNT[effort]):
        at = numbers.choice((0, numbers.random()))
        job.reset()
        outcomes = run_both(job, job.steps[0], job.steps[0], at * seconds)
        table.add(f"two at once: {job.name}", complaint_about(job, outcomes, True),
                  f"the second after {at:.3f} of {seconds:.2f} s")


def side_by_side(setup, table, effort):
    """Processes that share a folder, each with frames or parts of its own."""
    part = setup.jobs()["parts"].start()
    render = setup.jobs()["render"].start()
    for _ in range(COUNT[effort]):
        part.reset()
        pair = [[*part.setup.render_part, f"{k}/3"] for k in (1, 2)]
        outcomes = run_both(part, *pair, 0)
        table.add("two at once: parts of the same frames", complaint_about(part, outcomes, False),
                  "render --tiles 1/3 beside 2/3")
        render.reset()
        outcomes = run_both(render, *([*render.steps[0], "--frames", k] for k in (0, 1)), 0)
        table.add("two at once: frames of one folder", complaint_about(render, outcomes, False),
                  "render --frames 0 beside 1")


def check(setup, table, effort, case=None):
    jobs = setup.of_scale(setup.scale, "two").jobs()
    in_parallel(lambda name: alike(jobs[name], table, effort), ALIKE)
    side_by_side(setup.of_scale(setup.scale, "beside"), table, effort)
