# SPDX-License-Identifier: Apache-2.0
"""What the checks of this folder share: small scenes, the jobs that are disturbed, a program that is
run with or without faults, and the comparison of what it leaves with an undisturbed run's files."""

import dataclasses
import errno
import filecmp
import hashlib
import os
import pathlib
import shutil
import subprocess
import threading
import time

SEED = 1
# Longer than any run of these scenes, also on a busy machine [s].
PATIENCE = 120

SCENE = """
[scene]
name = "s"
[physics]
duration = {duration}
steps_per_second = 120
[render]
size = {size}
samples = {samples}
frames_per_second = 20
channels = ["color", "depth", "id", "cryptomatte"]
tile = 16
[camera]
position = {camera}
[[light]]
type = "sun"
direction = [0.5, -1, 0.5, 0]
strength = 4
[[light]]
type = "sky"
strength = 0.3
[[body]]
name = "floor"
shape = "hyperplane"
normal = [0, 1, 0, 0]
offset = -1
[[body]]
name = "ball"
shape = "hypersphere"
radius = 0.5
position = [0, -0.4, 0, 0.2]
velocity = [0, 0, 0, -0.3]
restitution = 0.8
[[lattice]]
shape = "hyperbox"
size = [0.3, 0.3, 0.3, 0.3]
count = [2, 2, 1, 2]
spacing = 0.35
position = [1, 0, 0, 0]
jitter = 0.02
"""
NEAR, ASIDE = "[0, 1, -6, 0]", "[0.5, 1.5, -5, 0]"
# Of two runs of the same, these may differ: they hold times that were measured or an encoder's work.
UNSTEADY = (".json", ".mp4")


@dataclasses.dataclass(frozen=True)
class Scale:
    """How large the scenes are that are disturbed."""
    size: str = "[40, 24]"
    samples: int = 1
    duration: float = 0.1
    longer: float = 0.25
    speed: int = 1  # of the clock by which the program takes time

    def scene(self, is_longer=False, camera=NEAR):
        return SCENE.format(size=self.size, samples=self.samples, camera=camera,
                            duration=self.longer if is_longer else self.duration)


class Table:
    """Counts cases and failures by promise, and says each failure with how to see it again."""

    def __init__(self):
        self.rows, self.lock = {}, threading.Lock()

    def add(self, promise, complaint=None, again=""):
        with self.lock:
            row = self.rows.setdefault(promise, [0, 0])
            row[0] += 1
            if not complaint:
                return
            row[1] += 1
            print(f"FAILED  {promise}: {complaint}\n        {again}", flush=True)

    def tell(self, promise):
        """Says how far a promise is, in checks that take hours."""
        with self.lock:
            if promise in self.rows:
                tried, failed = self.rows[promise]
                print(f"{promise}: {tried} cases, {failed} failed", flush=True)

    def show(self):
        """@return whether nothing failed"""
        print(f"\n{'promise':<72} {'tried':>6} {'failed':>6}")
        for promise, (tried, failed) in self.rows.items():
            print(f"{promise:<72} {tried:>6} {failed:>6}")
        return bool(self.rows) and all(failed == 0 for _, failed in self.rows.values())


class Fault:
    """A system call that fails, as faults.c takes it."""

    def __init__(self, family="", at=0, how="0", last=1, program="tesserae"):
        self.family, self.at, self.how, self.last, self.program = family, at, how, last, program

    def number(self):
        return str(getattr(errno, self.how)) if hasattr(errno, self.how) else self.how

    def reason(self):
        """The system's words for it."""
        name = "ENOSPC" if self.how == "fill" else self.how
        return os.strerror(getattr(errno, name)) if hasattr(errno, name) else ""

    def __str__(self):
        return f"{self.family}:{self.at}:{self.how}:{self.last}:{self.program}"

    @staticmethod
    def parse(text):
        family, at, how, last, program = text.split(":")
        return Fault(family, int(at), how, int(last), program)


class Outcome:
    def __init__(self, status, out, err, hits, seconds, was_handled):
        self.status, self.out, self.err, self.hits = status, out, err, hits
        self.seconds = seconds  # from a signal that was sent, or from the start, to its end
        self.was_handled = was_handled  # whether the process had a handler for that signal by then

    def ended_by_signal(self):
        return self.status < 0


class Job:
    """One command, or several in order, with all that is read and written below one folder, at a path
    that stays the same: some results tell it.

    @param prepare(job)   makes what is there before; called once
    @param out            the file that standard output goes to
    """

    def __init__(self, setup, name, steps, prepare=None, out=None):
        self.setup, self.name, self.out = setup, name, out
        self.steps = steps if isinstance(steps[0], list) else [steps]
        self.folder = setup.place / name
        self.now, self.before, self.after = (self.folder / part for part in ("now", "before", "after"))
        self.prepare = prepare or (lambda job: None)
        self.ends = {}  # complaints of the command run again, by what was there

    def start(self):
        """Makes `before`, and `after` by a run that nothing disturbs."""
        shutil.rmtree(self.folder, ignore_errors=True)
        self.now.mkdir(parents=True)
        (self.now / "s.toml").write_text(self.setup.scale.scene())
        (self.now / "tmp").mkdir()
        self.prepare(self)
        shutil.copytree(self.now, self.before)
        outcome = self.run()
        if outcome.status != 0:
            raise SystemExit(f"{self.name} fails undisturbed: {outcome.status} {outcome.err}")
        shutil.copytree(self.now, self.after)
        return self

    def reset(self):
        shutil.rmtree(self.now, ignore_errors=True)
        shutil.copytree(self.before, self.now)

    def environment(self, fault):
        ours = pathlib.Path(self.setup.program).name
        return dict(os.environ, TMPDIR=str(self.now / "tmp"), LD_PRELOAD=str(self.setup.library),
                    FAULTS_FOLDER=str(self.now),
                    FAULTS_PROGRAM=ours if fault.program == "tesserae" else fault.program,
                    FAULTS_FAMILY=fault.family, FAULTS_AT=str(fault.at), FAULTS_LAST=str(fault.last),
                    FAULTS_HOW=fault.number(), FAULTS_LOG=str(self.folder / "log"),
                    FAULTS_SPEED=str(self.setup.scale.speed))

    def popen(self, words, fault=None, path=os.environ["PATH"], **more):
        """@return a process, whose standard output may go to a file"""
        output = open(self.now / self.out, "wb") if self.out else subprocess.PIPE
        try:
            return subprocess.Popen(
                [self.setup.program, *map(str, words)], cwd=self.now, stdin=subprocess.DEVNULL,
                env=dict(self.environment(fault or Fault()), PATH=path),
                **{"stdout": output, "stderr": subprocess.PIPE, **more})
        finally:
            if output is not subprocess.PIPE:
                output.close()

    def run(self, steps=None, fault=None, kill=None):
        """Runs the steps until one fails.
        @param kill   (signal, seconds after which it is sent)"""
        log = self.folder / "log"
        log.unlink(missing_ok=True)
        begin, was_handled = time.monotonic(), False
        for words in steps or self.steps:
            sent = begin
            with self.popen(words, fault) as process:
                try:
                    left = begin + kill[1] - time.monotonic() if kill else PATIENCE
                    out, err = process.communicate(timeout=max(0, left))
                except subprocess.TimeoutExpired:
                    was_handled = bool(kill) and handles(process, kill[0])
                    process.send_signal(kill[0] if kill else 9)
                    sent = time.monotonic()
                    out, err = process.communicate()
            if process.returncode != 0:
                break
        seconds = time.monotonic() - sent
        lines = log.read_text(errors="replace").splitlines() if log.exists() else []
        return Outcome(process.returncode, (out or b"").decode(errors="replace"),
                       (err or b"").decode(errors="replace"),
                       [tuple(line.split(" ", 1)) for line in lines], seconds, was_handled)

    def calls(self, families, program="tesserae"):
        """All calls of these families in an undisturbed run, as (family, path), in order."""
        self.reset()
        outcome = self.run(fault=Fault(",".join(families), 0, "0", program=program))
        if outcome.status != 0 or not outcome.hits:
            raise SystemExit(f"{self.name}: no calls are seen: {outcome.status} {outcome.err}")
        return outcome.hits

    # ---- what is there ---------------------------------------------------------------------------

    def is_same(self, name, folder):
        """Whether a file is what `folder` has under that name; of a trajectory, what it holds."""
        a, b = self.now / name, folder / name
        if not b.exists():
            return False
        if name.endswith(UNSTEADY) or filecmp.cmp(a, b, shallow=False):
            return True
        return name.endswith(".h5") and self.hash_of(a) == self.hash_of(b)

    def hash_of(self, file):
        def look():
            found = subprocess.run([self.setup.program, "hash", file], capture_output=True, text=True)
            return found.stdout.split()[0] if found.returncode == 0 and found.stdout else None
        return once_for_bytes("hash", file, look)

    def damaged(self):
        """Of the files that have their final names: those that are neither as before nor as after."""
        for name in files_below(self.now):
            if name.endswith((".partial", ".tiles")) or name.startswith("tmp/") or name == self.out:
                continue  # parts are judged by the frame that is joined of them
            if not self.is_same(name, self.after) and not self.is_same(name, self.before):
                yield name
            elif name.endswith(".mp4") and not is_movie(self.now / name):
                yield name

    def differences(self, counts_temporary=True, wanted=None):
        """How what is there differs from what an undisturbed run leaves, or from another folder.
        @param counts_temporary   false after a kill: nobody takes away what a killed one has in TMPDIR"""
        wanted = wanted or self.after
        here, there = set(files_below(self.now)), set(files_below(wanted))
        for name in sorted(here ^ there):
            if counts_temporary or not name.startswith("tmp/"):
                yield f"{name} is {'missing' if name in there else 'left over'}"
        for name in sorted(here & there):
            if not self.is_same(name, wanted):
                yield f"{name} has other bytes"
            elif name.endswith(".mp4") and not is_movie(self.now / name):
                yield f"{name} is no whole film"

    def complaint_of_end(self, counts_temporary=True):
        """The same command again, undisturbed, ends as if nothing had been.
        It is run once for all faults that leave the same files: what it does depends on these alone."""
        left = (counts_temporary, self.digest())
        if left not in self.ends:
            self.ends[left] = self.complaint_of_run(counts_temporary)
        return self.ends[left]

    def digest(self):
        """Of all names and bytes below `now`."""
        found = hashlib.sha256()
        for path in sorted(self.now.rglob("*")):
            content = path.read_bytes() if path.is_file() else b""
            found.update(f"{path.relative_to(self.now)} {path.is_file()} {len(content)}\n".encode())
            found.update(content)
        return found.digest()

    def complaint_of_run(self, counts_temporary):
        again = self.run()
        if again.status != 0:
            return f"the same command again ends with {again.status}: {again.err.strip()}"
        differences = list(self.differences(counts_temporary))
        return "after the same command again " + ", ".join(differences) if differences else None


def handles(process, number):
    """Whether a process has a handler for a signal: not before its own first line."""
    for line in pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines():
        if line.startswith("SigCgt:"):
            return bool(int(line.split()[1], 16) >> (number - 1) & 1)
    return False


def files_below(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


def is_movie(file):
    """Whether ffmpeg can decode all of it."""
    words = ["ffmpeg", "-v", "error", "-xerror", "-i", file, "-f", "null", "-"]
    silent = {name: subprocess.DEVNULL for name in ("stdin", "stdout", "stderr")}
    return once_for_bytes("movie", file, lambda: subprocess.run(words, **silent).returncode == 0)


found_of_bytes = {}


def once_for_bytes(what, file, look):
    """look(), called once for all files of the same bytes."""
    key = what, hashlib.sha256(file.read_bytes()).digest()
    if key not in found_of_bytes:
        found_of_bytes[key] = look()
    return found_of_bytes[key]


class Setup:
    """Program, library and a folder for all jobs."""

    def __init__(self, program, library, place, scale=Scale()):
        self.program, self.library = str(pathlib.Path(program).resolve()), pathlib.Path(library).resolve()
        self.place, self.scale = pathlib.Path(place).resolve(), scale

    def jobs(self):
        """By name: what is disturbed."""
        def simulated(job):
            self.need(job, ["simulate", "s.toml", "-o", "in.h5", "--threads", 1, "--quiet"])

        def filmed(job):
            self.need(job, ["run", "s.toml", "-o", "film", "--threads", 1, "--quiet"])

        def looked_at_otherwise(job):
            filmed(job)
            (job.now / "s.toml").write_text(self.scale.scene(camera=ASIDE))

        def made_longer(job):
            filmed(job)
            (job.now / "s.toml").write_text(self.scale.scene(is_longer=True))

        def longer_trajectory(job):
            simulated(job)
            (job.now / "s.toml").write_text(self.scale.scene(is_longer=True))

        def in_parts(job):
            simulated(job)
            for part in (1, 2, 3):
                self.need(job, [*tiles, f"{part}/3"])

        def rendered(job):
            self.need(job, ["render", "s.toml", "-o", "film", "--threads", 1, "--quiet"])

        one = ["--threads", 1, "--quiet"]
        trajectory = ["--trajectory", "in.h5"]
        tiles = self.render_part = ["render", "s.toml", *trajectory, "--frames", "0-1", "-o", "film",
                                    *one, "--tiles"]
        jobs = [
            Job(self, "simulate", ["simulate", "s.toml", "-o", "out.h5", *one]),
            Job(self, "simulate every step", ["simulate", "s.toml", "-o", "out.h5", "--store-every", 1,
                                              *one]),
            Job(self, "simulate longer", ["simulate", "s.toml", "-o", "in.h5", *one],
                longer_trajectory),
            Job(self, "simulate trace", ["simulate", "s.toml", "-o", "out.h5", "--trace", "t.json",
                                         "--store-every", 1, *one]),
            Job(self, "render", ["render", "s.toml", *trajectory, "-o", "film", *one], simulated),
            Job(self, "render parts", [*tiles, "2/3"], simulated),
            Job(self, "parts", [[*tiles, f"{part}/3"] for part in (1, 2, 3)] + [["join", "film", *one]],
                simulated),
            Job(self, "join", ["join", "film", *one], in_parts),
            Job(self, "run", ["run", "s.toml", "-o", "film", *one]),
            Job(self, "run draft", ["run", "s.toml", "-o", "film", "--draft", *one]),
            Job(self, "run longer", ["run", "s.toml", "-o", "film", *one], made_longer),
            Job(self, "run otherwise", ["run", "s.toml", "-o", "film", *one], looked_at_otherwise),
            Job(self, "film", ["film", "film", *one], rendered),
            Job(self, "view", ["view", "s.toml", "-o", "page.html", *one]),
            Job(self, "plot svg", ["plot", "in.h5", "-o", "plot.svg", *one], simulated),
            Job(self, "plot png", ["plot", "in.h5", "-o", "plot.png", *one], simulated),
            Job(self, "export vtk", ["export", "in.h5", "--format", "vtk", "-o", "meshes", *one],
                simulated),
            Job(self, "export ply", ["export", "in.h5", "--format", "ply", "-o", "meshes", *one],
                simulated),
            Job(self, "submit", ["submit", "s.toml", "-o", "film", "--for", "commands", *one]),
            Job(self, "plan", ["plan", "s.toml", *one]),
            Job(self, "generate", ["generate", "pile", "--bodies", 20], out="pile.toml"),
            Job(self, "status", ["status", "film"], filmed),
            Job(self, "info scene", ["info", "s.toml", *one]),
            Job(self, "info trajectory", ["info", "in.h5", *one], simulated),
            Job(self, "info frame", ["info", "film/frames/s.0000.exr", *one], rendered),
            Job(self, "hash", ["hash", "in.h5", "s.toml", "film", *one],
                lambda job: (simulated(job), rendered(job))),
            Job(self, "diff", ["diff", "in.h5", "in.h5", *one], simulated),
        ]
        return {job.name: job for job in jobs}

    def of_scale(self, scale, place):
        """The same with other scenes, elsewhere."""
        return Setup(self.program, self.library, self.place / place, scale)

    def need(self, job, words):
        outcome = job.run([words])
        if outcome.status != 0:
            raise SystemExit(f"{job.name}: {words} fails undisturbed: {outcome.err}")


def in_parallel(work, things):
    """Calls work(thing) for all, each on a thread of its own, as many at once as there are cores."""
    from concurrent.futures import ThreadPoolExecutor
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as threads:
        for _ in threads.map(work, things):
            pass
