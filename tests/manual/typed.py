# SPDX-License-Identifier: Apache-2.0
"""Runs what README and the manual tell a reader to type: every block of a page in its order, in one
empty folder a page, which has the gallery's scenes.
    typed.py PROGRAM [--load] PAGE...    --load: only whether scenes load, in milliseconds

```toml NAME.toml   is that file, and loads;   ```toml   loads by itself
```bash, ```python  run and end with status 0;  ```text   is output or for other programs
```cpp, ```cmake    see cpp_blocks.py
```pycon            what Python answers is what stands there; all of a page are one session, run last
A block without a language is an error. Ends with 1 and the page's line where something fails."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import textwrap
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_SECONDS = 900  # of a block
LEFT_OUT = ("text", "cpp", "cmake")  # run by nobody, or by another program


def blocks(page):
    """(line, words after the fence, text) of every block."""
    start, words, lines = 0, [], []
    for number, line in enumerate(page.read_text().splitlines(), 1):
        stripped = line.strip()
        if not start and stripped.startswith("```"):
            start, words, lines = number, stripped[3:].split(), []
        elif start and stripped == "```":
            yield start, words, textwrap.dedent("\n".join(lines)) + "\n"
            start = 0
        elif start:
            lines.append(line)
    if start:
        yield start, [], ""


def python_for(text):
    """A Python that has what a block imports."""
    modules = "numpy" + ", h5py" * ("h5py" in text) + ", tesserae" * ("tesserae as ts" in text)
    for python in (sys.executable, "/usr/bin/python3"):
        if subprocess.run([python, "-c", f"import {modules}"], capture_output=True).returncode == 0:
            return python
    sys.exit(f"no Python with {modules}: install python3-h5py; PYTHONPATH tells where tesserae is")


def run_block(kind, words, text, folder, environment):
    """What is wrong with a block; empty: nothing."""
    if kind == "toml":
        name = words[1] if len(words) > 1 else "fragment.toml"
        (folder / name).write_text(text)
        command = ["tesserae", "info", name]
    elif kind == "bash":
        command = ["bash", "-euo", "pipefail", "-c", text]
    elif kind == "python":
        command = [python_for(text), "-c", text]
    elif kind == "pycon":
        (folder / "session.txt").write_text(text)
        command = [python_for(text), "-m", "doctest", "-o", "ELLIPSIS", "session.txt"]
    elif kind in LEFT_OUT:
        return ""
    else:
        return f"a block of {kind or 'no language'}: expected toml, bash, python, pycon, cpp, cmake or text"
    try:
        done = subprocess.run(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=MOST_SECONDS)
    except subprocess.TimeoutExpired:
        return f"took more than {MOST_SECONDS} s"
    return "" if done.returncode == 0 else f"status {done.returncode}:\n" + done.stdout.decode(errors="replace")


def session_of(page):
    """The page's ```pycon blocks, each in the lines where it stands."""
    lines = [""] * len(page.read_text().splitlines())
    for line, words, text in blocks(page):
        if words[:1] == ["pycon"]:
            lines[line:line + text.count("\n")] = text.splitlines()
    return "\n".join(lines) + "\n" if any(lines) else ""


def run_page(page, program, only_load):
    """How many of a page's blocks were run and how many failed."""
    run = failed = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for scene in (ROOT / "scenes/gallery").glob("*.toml"):
            shutil.copy(scene, folder)
        (folder / "bin").mkdir()
        (folder / "bin/tesserae").symlink_to(program)
        environment = dict(os.environ, PATH=f"{folder / 'bin'}:{os.environ['PATH']}")
        session = session_of(page)
        for line, words, text in [*blocks(page), *[(1, ["pycon", "session"], session)] * bool(session)]:
            kind = words[0] if words else ""
            if kind == "pycon" and len(words) == 1:
                continue  # a part of the session
            if only_load and kind not in ("toml", ""):
                continue
            begin = time.time()
            wrong = run_block(kind, words, text, folder, environment)
            run += kind not in LEFT_OUT
            if wrong:
                failed += 1
                print(f"{page}:{line}: {wrong}")
            elif time.time() - begin > 5:
                print(f"{page}:{line}: {time.time() - begin:.0f} s")
    return run, failed


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    pages = [pathlib.Path(name) for name in sys.argv[2:] if name != "--load"]
    only_load = "--load" in sys.argv
    count = wrong = 0
    for page in pages:
        run, failed = run_page(page, program, only_load)
        count, wrong = count + run, wrong + failed
    print(f"{count} blocks of {len(pages)} pages, {wrong} failed")
    return 1 if wrong or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
