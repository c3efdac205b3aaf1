# SPDX-License-Identifier: Apache-2.0
"""The C++ blocks of a page, which are one program: what a block declares, those after it use.
    cpp_blocks.py write PAGE SOURCE.cpp     makes the program's source; the build compiles it
    cpp_blocks.py run PROGRAM PAGE          runs it in a folder with the page's scenes, and compares
                                            what each block prints with the ```text block after it

Every public function of the library's classes is called in some block.
```cpp NAME, ```cmake NAME   is the file of that name in tests/library/ball, word for word
#include lines and "using namespace" may stand in any block; the program has them at its top."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

from typed import ROOT, blocks

END_OF_BLOCK = "\x1e"


def cpp_blocks(page):
    """(line, text, what it shall print or None) of every block that is a part of the program."""
    found = []
    for line, words, text in blocks(page):
        if words[:1] == ["cpp"] and len(words) == 1:
            found.append([line, text, ""])
        elif words[:1] == ["text"] and found and found[-1][2] == "" and is_next(page, found[-1], line):
            found[-1][2] = text
    return found


def is_next(page, block, line):
    """Whether nothing but empty lines is between a block and the one that begins at a line."""
    between = page.read_text().splitlines()[block[0] + block[1].count("\n") + 1:line - 1]
    return not any(text.strip() for text in between)


def public_functions():
    """The names of the functions of the library's classes, and of those that make threads."""
    listed = (ROOT / "scenes/library/public_headers.cmake").read_text()
    names = set()
    for header in re.findall(r"(?:world|threads|picture|scene|trajectory)=(\S+?)\)?$", listed, re.M):
        public = (ROOT / header).read_text().split("\n  private:")[0]
        code = re.sub(r"//[^\n]*", "", public)
        names.update(re.findall(r"\b([a-z][a-z_]*)\((?:[^;{}]|\{\})*\)(?: const)?(?:;| \{)",
                                code))
    return names - {"inside", "inside_"}  # the program's own


def write(page, source):
    top, body = [], []
    for line, text, _ in cpp_blocks(page):
        kept = []
        for text_line in text.splitlines():
            is_top = text_line.startswith(("#include", "using namespace"))
            if is_top and text_line not in top:
                top.append(text_line)
            kept.append("" if is_top else text_line)
        body += [f'#line {line + 1} "{page.name}"', *kept, f'std::printf("\\x1e"), std::fflush(stdout);']
    text = "\n".join(["#include <cstdio>", *top, "", "int main() {", *body, "}", ""])
    pathlib.Path(source).write_text(text)


def run(program, page):
    wrong = []
    for line, words, text in blocks(page):
        if words[:1] in (["cpp"], ["cmake"]) and len(words) > 1:
            licence, _, source = (ROOT / "tests/library/ball" / words[1]).read_text().partition("\n")
            if "SPDX" not in licence or text != source:
                wrong.append(f"{page}:{line}: is not tests/library/ball/{words[1]}")
    with tempfile.TemporaryDirectory() as folder:
        for _, words, text in blocks(page):
            if words[:1] == ["toml"] and len(words) > 1:
                (pathlib.Path(folder) / words[1]).write_text(text)
        done = subprocess.run([os.path.abspath(program)], cwd=folder, capture_output=True, text=True)
    printed = done.stdout.split(END_OF_BLOCK)
    found = cpp_blocks(page)
    for (line, _, expected), output in zip(found, printed):
        if output != expected:
            wrong.append(f"{page}:{line}: prints\n{output}instead of\n{expected}")
    shown = "".join(text for _, text, _ in found)
    for name in sorted(public_functions()):
        if not re.search(rf"\b{name}\(", shown):
            wrong.append(f"{page}: no block calls {name}()")
    if done.returncode != 0 or len(printed) != len(found) + 1:
        wrong.append(f"{page}: status {done.returncode} after {len(printed) - 1} of {len(found)} blocks: "
                     + done.stderr)
    print("\n".join(wrong + [f"{len(found)} blocks, {len(wrong)} wrong"]))
    return 1 if wrong or not found else 0


if __name__ == "__main__":
    if sys.argv[1] == "write":
        write(pathlib.Path(sys.argv[2]), sys.argv[3])
    else:
        sys.exit(run(sys.argv[2], pathlib.Path(sys.argv[3])))
