# SPDX-License-Identifier: Apache-2.0
"""What is damaged, refused or cannot be said loses nothing else: files that are cut, emptied or have a
flipped bit, programs that die, streams that cannot be written."""

import os
import random
import re
import subprocess

from work import SEED, in_parallel, is_movie

COUNT = {"quick": 1, "usual": 6, "all": 60}


# ---- ways to damage a file -----------------------------------------------------------------------

def cut(content, numbers):
    return content[:numbers.randrange(1, len(content))]


def cut_end(content, _):
    return content[:-1]


def emptied(content, _):
    return b""


def flipped(content, numbers):
    at = numbers.randrange(len(content))
    return content[:at] + bytes([content[at] ^ 1 << numbers.randrange(8)]) + content[at + 1:]


def zeroed(content, numbers):
    """A block that was never written, as after a power cut."""
    at = numbers.randrange(len(content))
    return (content[:at] + bytes(4096) + content[at + 4096:])[:len(content)]


def longer(content, _):
    return content + bytes(100)


def garbage(content, numbers):
    return numbers.randbytes(len(content))


WAYS = (cut, cut_end, emptied, flipped, zeroed, longer, garbage)


def damage(file, way, numbers):
    content = file.read_bytes()
    file.write_bytes(way(content, numbers))
    return way.__name__, file.read_bytes() != content


def cases(name, effort, ways=WAYS):
    """(way, random numbers) of so many damages of each kind."""
    for way in ways:
        for i in range(COUNT[effort]):
            yield way, random.Random(f"{SEED} {name} {way.__name__} {i}"), f"{way.__name__} {i}"


def bad_end(outcome, answers=False):
    """What no damage may do.
    @param answers   1 is the command's answer, on standard output: what differs"""
    if outcome.ended_by_signal():
        return f"ended by signal {-outcome.status}: {outcome.err.strip()}"
    if outcome.status not in (0, 1, 2):
        return f"exit status {outcome.status}: {outcome.err.strip()}"
    words = outcome.out if answers and outcome.status == 1 else outcome.err
    if outcome.status != 0 and not words.strip():
        return f"exit status {outcome.status} without a word"
    return None


# ---- parts ---------------------------------------------------------------------------------------

def complaint_of_part(job, part, number):
    """Joins a damaged part; then does as one is told."""
    outcome = job.run()
    complaint = bad_end(outcome)
    damaged = list(job.damaged())
    if complaint or damaged:
        return complaint or f"join ends with {outcome.status} and damaged: {', '.join(damaged)}"
    if outcome.status == 0:
        differences = list(job.differences())
        return f"join ends with 0, but {', '.join(differences)}" if differences else None
    if part.name not in outcome.err:
        return f"join does not name {part.name}: {outcome.err.strip()}"
    part.unlink(missing_ok=True)
    render = job.run([[*job.setup.render_part, f"{number}/3"]])
    if render.status != 0:
        return f"the part cannot be rendered again: {render.err.strip()}"
    return job.complaint_of_end()


def complaint_of_kept_part(job, part, number):
    """Renders a damaged part again, where it is: it is replaced, or the user is told."""
    outcome = job.run([[*job.setup.render_part, f"{number}/3"]])
    complaint = bad_end(outcome)
    if complaint or outcome.status != 0:
        told = part.name in outcome.err
        return complaint or (None if told else f"{part.name} is not named: {outcome.err.strip()}")
    return job.complaint_of_end()


def parts(setup, table, effort):
    job = setup.jobs()["join"].start()
    for way, numbers, text in cases("parts", effort):
        number = numbers.randrange(1, 4)
        part = job.now / f"film/frames/s.{numbers.randrange(2):04}.{number}of3.tiles"
        for promise, complaint_of in (("join says so, all else is joined", complaint_of_part),
                                      ("render --tiles makes it again", complaint_of_kept_part)):
            # By its looks such a part is whole: join finds it.
            if complaint_of is complaint_of_kept_part and way in (flipped, zeroed):
                continue
            job.reset()
            if damage(part, way, random.Random(text))[1]:
                table.add(f"a damaged part: {promise}", complaint_of(job, part, number),
                          f"{text} of {part.name}")
    odd_names(job, table)


def odd_names(job, table):
    """What only looks like a part harms nobody."""
    for name in ("s.0000.1of0.tiles", "s.0000.000001of999999.tiles", "s.0000.0of3.tiles",
                 "s.0000.4of3.tiles", "s.99999999.1of1.tiles", "s.0001.exr.partial"):
        job.reset()
        (job.now / "film/frames" / name).touch()
        complaint = bad_end(job.run()) or ", ".join(job.damaged())
        table.add("files with names like parts' harm nothing", complaint, name)


# ---- frames and previews -------------------------------------------------------------------------

def complaint_of_frame(job, file):
    """One file is damaged, another frame is missing: the same command makes the other one, and mends
    the first or names it; --overwrite mends it."""
    other = job.now / "film/frames/s.0001.exr"
    other.unlink()
    status = job.run([["status", "film"]])
    if status.status != 1 or not re.search(r"invalid\s+1", status.out):
        return f"status ends with {status.status}: {status.out} {status.err}"
    outcome = job.run()
    if bad_end(outcome):
        return bad_end(outcome)
    if not other.exists():
        return f"another frame is not made: {outcome.err.strip()}"
    if outcome.status == 0:
        differences = list(job.differences())
        return f"ends with 0, but {', '.join(differences)}" if differences else None
    if file.name not in outcome.err:
        return f"{file.name} is not named: {outcome.err.strip()}"
    mended = job.run([[*job.steps[0], "--overwrite"]])
    if mended.status != 0:
        return f"--overwrite ends with {mended.status}: {mended.err.strip()}"
    return job.complaint_of_end()


def complaint_of_preview(job, file):
    """The film of a damaged preview is not made without a word: it is named, or made again."""
    outcome = job.run([["film", "film", "--quiet"]])
    if bad_end(outcome):
        return bad_end(outcome)
    if outcome.status != 0 and file.name not in outcome.err:
        return f"film does not name {file.name}: {outcome.err.strip()}"
    if outcome.status == 0 and not (job.is_same("film/preview/" + file.name, job.after)
                                    and is_movie(job.now / "film/s.mp4")):
        return "film ends with 0, but the preview is as it was or the film is damaged"
    again = job.run()
    if bad_end(again):
        return bad_end(again)
    (job.now / "film/s.mp4").unlink(missing_ok=True)
    differences = list(job.differences())
    if again.status == 0 and differences:
        return f"rendering again ends with 0, but {', '.join(differences)}"
    if again.status != 0 and file.name not in again.err:
        return f"{file.name} is not named: {again.err.strip()}"
    return None


def frames(setup, table, effort):
    for name in ("render", "run"):
        job = setup.jobs()[name].start()
        job.before = job.after  # everything is there before it is damaged
        # A flipped bit of a picture shows when it is read, which these commands do not do.
        for way, numbers, text in cases("frames", effort, (cut, cut_end, emptied, garbage)):
            job.reset()
            file = job.now / "film/frames/s.0000.exr"
            if damage(file, way, numbers)[1]:
                table.add(f"a damaged frame: {name} mends or names it, and makes the others",
                          complaint_of_frame(job, file), text)
    job = setup.jobs()["render"].start()
    job.before = job.after
    for way, numbers, text in cases("previews", effort, (cut, cut_end, emptied, garbage, flipped)):
        job.reset()
        file = job.now / "film/preview/s.0001.png"
        if damage(file, way, numbers)[1]:
            table.add("a damaged preview: film names it or makes it again, so does render",
                      complaint_of_preview(job, file), text)


# ---- trajectories --------------------------------------------------------------------------------

def trajectories(setup, table, effort):
    """Nothing crashes on a damaged one; of an unfinished one that was cut the end is right."""
    words = {"info": ["info", "in.h5"], "hash": ["hash", "in.h5"], "plot": ["plot", "in.h5", "-o", "p.svg"],
             "render": ["render", "s.toml", "--trajectory", "in.h5", "-o", "film", "--quiet"],
             "view": ["view", "in.h5", "-o", "p.html", "--quiet"],
             "export": ["export", "in.h5", "--format", "ply", "-o", "meshes", "--quiet"],
             "simulate": ["simulate", "s.toml", "-o", "in.h5", "--quiet"],
             "diff": ["diff", "in.h5", "whole.h5"]}
    job = setup.jobs()["info trajectory"].start()
    (job.before / "whole.h5").write_bytes((job.before / "in.h5").read_bytes())
    for way, numbers, text in cases("trajectories", effort):
        for name, steps in words.items():
            job.reset()
            damage(job.now / "in.h5", way, random.Random(text))
            outcome = job.run([steps])
            complaint = bad_end(outcome, answers=name == "diff")
            if not complaint and outcome.status != 0 and name != "diff" and "in.h5" not in outcome.err:
                complaint = f"in.h5 is not named: {outcome.err.strip()}"
            table.add(f"a damaged trajectory harms nothing: {name}", complaint, text)

    job = setup.jobs()["simulate every step"].start()
    for way, numbers, text in cases("unfinished", effort, (cut, cut_end, emptied, garbage, longer)):
        job.reset()
        file = job.now / "out.h5.partial"
        file.write_bytes((job.after / "out.h5").read_bytes())
        damage(file, way, numbers)
        table.add("a damaged unfinished trajectory: the same command makes a whole one",
                  job.complaint_of_end(), text)


# ---- streams and helpers -------------------------------------------------------------------------

def unwritable_streams(setup, table, names):
    for name in names:
        job = setup.jobs()[name].start()
        for what in ("standard error on a full disk", "standard error closed",
                     "standard output on a full disk", "standard output closed"):
            job.reset()
            is_err, is_full = "error" in what, "full" in what
            with open("/dev/full" if is_full else "/dev/null", "wb") as stream:
                more = {"stderr" if is_err else "stdout": stream}
                if not is_full:
                    more["preexec_fn"] = lambda number=2 if is_err else 1: os.close(number)
                with job.popen([w for w in job.steps[0] if w != "--quiet"], **more) as process:
                    _, err = process.communicate()
            complaint = None
            if process.returncode < 0:
                complaint = f"ended by signal {-process.returncode}"
            elif is_err and process.returncode != 0:
                complaint = f"ends with {process.returncode}"
            elif not is_err and process.returncode not in (0, 1):
                complaint = f"ends with {process.returncode}"
            elif not is_err and is_full and process.returncode == 0:
                complaint = "ends with 0, but nothing was printed"
            elif process.returncode == 1 and b"standard output" not in (err or b""):
                complaint = f"standard output is not named: {err.decode()}"
            if job.out and not is_err:
                (job.now / job.out).unlink()
            table.add(f"{what} loses nothing", complaint or ", ".join(job.damaged())
                      or job.complaint_of_end(), name)


HELPERS = {
    "is killed": "kill -9 $$",
    "fails": "echo its own words >&2; exit 3",
    "ends at once, having done nothing": "exit 0",
    "is killed amid its output": "printf '<svg' ; printf half >&3 2>/dev/null; kill -9 $$",
}


def helpers(setup, table):
    """gnuplot and ffmpeg that do not do their work."""
    for name, helper, output in (("plot svg", "gnuplot", "plot.svg"), ("plot png", "gnuplot", "plot.png"),
                                 ("film", "ffmpeg", "s.mp4"), ("run", "ffmpeg", "s.mp4")):
        job = setup.jobs()[name].start()
        for what, script in HELPERS.items():
            job.reset()
            folder = job.folder / "helpers"
            folder.mkdir(exist_ok=True)
            (folder / helper).write_text(f"#!/bin/bash\n{script}\n")
            (folder / helper).chmod(0o755)
            with job.popen(job.steps[0], path=f"{folder}:{os.environ['PATH']}") as process:
                err = process.communicate()[1].decode()
            complaint = None
            if process.returncode != 1:
                complaint = f"ends with {process.returncode}: {err.strip()}"
            elif helper not in err or output not in err:
                complaint = f"{helper} or {output} is not named: {err.strip()}"
            elif "own words" in script and "its own words" not in err:
                complaint = f"its words are not passed on: {err.strip()}"
            elif "kill" in script and "ignal" not in err and "illed" not in err:
                complaint = f"that it was killed is not said: {err.strip()}"
            elif list(job.differences(wanted=job.before)) and name != "run":
                complaint = ", ".join(job.differences(wanted=job.before))
            table.add(f"{helper} that does not do its work is told: {name}",
                      complaint or job.complaint_of_end(), what)


def refusals(setup, table):
    """What is refused leaves nothing and takes nothing away."""
    for name in ("simulate every step", "render", "run", "view", "plot svg", "export ply", "submit"):
        job = setup.jobs()[name].start()
        job.before = job.after
        job.reset()
        others = {"plot svg": ("plot.svg", "<svg>another</svg>"), "view": ("page.html", "<p>another</p>")}
        if name in others:  # they replace what they have made themselves
            file, content = others[name]
            (job.now / file).write_text(content)
        else:
            text = (job.now / "s.toml").read_text()
            (job.now / "s.toml").write_text(text.replace("restitution = 0.8", "restitution = 0.7"))
        held = job.folder / "held"
        subprocess.run(["rm", "-rf", held], check=True)
        subprocess.run(["cp", "-a", job.now, held], check=True)
        more = ["--tolerance", 0.01] if name == "export ply" else []
        outcome = job.run([[*job.steps[0], *more]])
        complaint = None
        if outcome.status != 2 or "--overwrite" not in outcome.err and name != "render":
            complaint = f"ends with {outcome.status}: {outcome.err.strip()}"
        table.add("what is refused leaves everything as it was",
                  complaint or ", ".join(job.differences(wanted=held)), name)


def stale_film(setup, table):
    """A film of the old look whose time is in the future, as another machine's clock may have it."""
    job = setup.jobs()["run otherwise"].start()
    job.reset()
    movie = job.now / "film/s.mp4"
    os.utime(movie, (4e9, 4e9))
    outcome = job.run()
    is_old = movie.read_bytes() == (job.before / "film/s.mp4").read_bytes()
    table.add("a film of another look is made again whatever its time",
              bad_end(outcome) or ("it was kept" if is_old else None), "mtime in the future")


def check(setup, table, effort, case=None):
    streams = ("simulate", "run", "generate") if effort == "quick" else (
        "simulate", "render", "parts", "join", "run", "film", "view", "plot svg", "export ply", "submit",
        "plan", "generate", "status", "info scene", "hash", "diff")
    def of(name):
        return setup.of_scale(setup.scale, name)
    work = [lambda: parts(of("parts"), table, effort), lambda: frames(of("frames"), table, effort),
            lambda: trajectories(of("trajectories"), table, effort),
            lambda: unwritable_streams(of("streams"), table, streams),
            lambda: helpers(of("helpers"), table), lambda: refusals(of("refusals"), table),
            lambda: stale_film(of("stale"), table)]
    in_parallel(lambda one: one(), work)
